"""A TOML table whose keys are taken one by one, and what is wrong with it collected."""

import math
from collections.abc import Mapping
from difflib import get_close_matches
from typing import TypeGuard

from hardware.description.errors import ConfigurationError
from hardware.description.units import unit


class TomlTable:
    """Keys of one table, checked as they are taken.

    Every method returns ``None`` for an absent key and for a wrong value, and notes the latter in
    ``faults``, which the tables of a file share: so one message tells all errors of the file.
    """

    def __init__(self, table: Mapping[str, object], where: str, faults: list[str]) -> None:
        self.table, self.where, self.faults = table, where, faults
        self.known: list[str] = []

    def fault(self, key: str, message: str) -> None:
        """Note what is wrong with a key."""
        self.faults.append(f"{self.where}{key} {message}")

    def get(self, key: str) -> object:
        """Return whatever stands at a key."""
        self.known.append(key)
        return self.table.get(key)

    def text(self, key: str) -> str | None:
        """Return text that is not empty."""
        value = self.get(key)
        if value is None or (isinstance(value, str) and value):
            return value
        self.fault(key, f"= {value!r} should be text")
        return None

    def flag(self, key: str) -> bool | None:
        """Return true or false."""
        value = self.get(key)
        if value is None or isinstance(value, bool):
            return value
        self.fault(key, f"= {value!r} should be true or false")
        return None

    def number(self, key: str, *, positive: bool = False) -> float | None:
        """Return a finite number."""
        value = self.get(key)
        if value is None:
            return None
        if is_number(value) and (not positive or value > 0):
            return float(value)
        self.fault(key, f"= {value!r} should be a {'positive' if positive else 'finite'} number")
        return None

    def whole(self, key: str) -> int | None:
        """Return a whole number from 0 up."""
        value = self.get(key)
        if value is None or (isinstance(value, int) and value is not True and value >= 0):
            return value
        self.fault(key, f"= {value!r} should be a whole number, 0 or more")
        return None

    def unit(self, key: str) -> str | None:
        """Return the name of a known unit."""
        name = self.text(key)
        try:
            if name is not None:
                unit(name)
        except ConfigurationError as error:
            self.fault(key, f"= {error}")
        return name

    def one_of(self, key: str, choices: tuple[str, ...]) -> str | None:
        """Return one of some words."""
        value = self.get(key)
        if value is None or (isinstance(value, str) and value in choices):
            return value
        self.fault(key, f"= {value!r} should be one of {', '.join(map(repr, choices))}")
        return None

    def finish(self) -> None:
        """Note the keys that nobody took, each with the known key it resembles."""
        for key in self.table:
            if key not in self.known:
                near = get_close_matches(key, self.known, n=1, cutoff=0.5)
                hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(self.known)}"
                self.fault(key, f"is not a known key; {hint}")


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether a TOML value is a finite number; true and false are none."""
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
