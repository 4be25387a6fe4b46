"""Names in a row, in a sentence."""

from collections.abc import Sequence
from typing import Final

_NAMED: Final = 12  # in one line; JSON holds all


def joined(names: Sequence[str], most: int = _NAMED) -> str:
    """Return names in a row, of more than ``most`` the first and how many there are besides."""
    more = len(names) - most
    return ", ".join(names[:most]) + (f" and {more} more" if more > 0 else "")
