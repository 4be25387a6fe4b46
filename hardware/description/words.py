"""Names in a row and numbers beside each other, in a sentence."""

import math
from collections.abc import Sequence
from typing import Final

_NAMED: Final = 12  # in one line; JSON holds all
_ROUNDING: Final = 1e-12


def joined(names: Sequence[str], most: int = _NAMED) -> str:
    """Return names in a row, of more than ``most`` the first and how many there are besides."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")


def told_apart(value: float, other: float) -> str:
    """Return a value and the one that it replaces, in digits that show what they differ by."""
    change, size = abs(value - other), max(abs(value), abs(other))
    if not change > _ROUNDING * size:
        return f"{value:.5g}, as before"
    digits = max(5, 2 + math.floor(math.log10(size)) - math.floor(math.log10(change)))
    value_text, other_text = (f"{each:#.{digits}g}".rstrip(".") for each in (value, other))
    return f"{value_text} in place of {other_text}"
