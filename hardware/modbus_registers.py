"""Values in the registers of a Modbus device: where each lies, and how it is written there.

Every programmable controller has a map of its own, so that all of it is data of ``rig.toml``.
"""

import math
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, Literal

from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED

_CODES: Final = {"int16": "h", "uint16": "H", "int32": "i", "uint32": "I", "float32": "f"}
UNITS: Final = {
    "m/s": 1.0, "mm/s": 1e-3, "m/min": 1.0 / 60.0, "m": 1.0, "mm": 1e-3,
    "rad": 1.0, "deg": math.pi / 180.0, "1": 1.0,
    "rad/s": 1.0, "deg/s": math.pi / 180.0, "rpm": math.pi / 30.0,
}  # fmt: skip
_LAST: Final = 0xFFFF
Table = Literal["holding", "input"]
Unit = Literal[
    "m/s", "mm/s", "m/min", "m", "mm", "rad", "deg", "1", "rad/s", "deg/s", "rpm"
]  # fmt: skip


@dataclass(frozen=True)
class Register:
    """A number in one or two registers of 16 bits.

    Attributes
    ----------
    address
        Of the first register, counted from 0 as on the wire: 40001 of a manual is 0.
    table
        Where it is read; what is written lies among the holding registers.
    words
        Which half of a number of 32 bits lies in the first register.
    scale
        Of one count, in ``unit``; negative where the device counts the other way.
    """

    address: int
    unit: Unit
    type: Literal["int16", "uint16", "int32", "uint32", "float32"] = "int16"
    table: Table = "holding"
    words: Literal["high-first", "low-first"] = "high-first"
    scale: float = 1.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        check_address(self.address)
        if self.scale == 0.0:
            raise ConfigurationError("scale = 0; it is what one count is worth, in the unit")

    @property
    def count(self) -> int:
        """How many registers it takes."""
        return struct.calcsize(_CODES[self.type]) // 2

    def value(self, words: Sequence[int]) -> float:
        """Return the number in SI units that stands in its registers."""
        data = struct.pack(f">{self.count}H", *self._ordered(words))
        (raw,) = struct.unpack(f">{_CODES[self.type]}", data)
        return float(raw) * self.scale * UNITS[self.unit]

    def written(self, value: float) -> tuple[int, ...]:
        """Return what its registers have to hold for a number in SI units.

        Raises
        ------
        ConfigurationError
            If its type does not hold the number.
        """
        counts = value / (self.scale * UNITS[self.unit])
        try:
            raw = counts if self.type == "float32" else round(counts)
            data = struct.pack(f">{_CODES[self.type]}", raw)
        except (struct.error, OverflowError, ValueError) as error:
            raise ConfigurationError(
                f"register {self.address} of type {self.type} does not hold {counts:.6g} counts "
                f"({value:g}); correct its type, scale or unit"
            ) from error
        return tuple(self._ordered(struct.unpack(f">{self.count}H", data)))

    def _ordered(self, words: Sequence[int]) -> Sequence[int]:
        return words if self.words == "high-first" else words[::-1]


@dataclass(frozen=True)
class StatusRegister:
    """A word in which bits (0 to 15) say how the device stands; those it lacks are left out.

    Attributes
    ----------
    remote
        The program may command it; without it, a person at its panel does.
    ready
        It is under power and takes commands.
    alarm
        It has stopped by itself.
    at_end
        The switch at the end of its way.
    inverted
        Names of bits that say it by 0.
    """

    address: int
    table: Table = "holding"
    remote: int | None = None
    ready: int | None = None
    alarm: int | None = None
    at_end: int | None = None
    inverted: tuple[Literal["remote", "ready", "alarm", "at_end"], ...] = ()

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        check_address(self.address)
        check_bits(self.remote, self.ready, self.alarm, self.at_end)

    def says(self, name: str, word: int | None) -> bool | None:
        """Return what a bit says; ``None`` without the bit, or before the word is known."""
        bit: int | None = getattr(self, name)
        if bit is None or word is None:
            return None
        return bool(word >> bit & 1) != (name in self.inverted)


@dataclass(frozen=True)
class CommandRegister:
    """A word in which bits (0 to 15) command the device; those it lacks are left out.

    Attributes
    ----------
    enable
        Power; without it the device stops as fast as is safe.
    reset
        Clears an alarm, as it comes on.
    toggle
        Turned over with every write, so that the device notices when nobody writes any more.
    """

    address: int
    enable: int | None = None
    reset: int | None = None
    toggle: int | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        check_address(self.address)
        check_bits(self.enable, self.reset, self.toggle)

    def word(self, *, enable: bool, reset: bool, toggle: bool) -> int:
        """Return the word with its bits of power, reset and life sign set."""
        bits = ((self.enable, enable), (self.reset, reset), (self.toggle, toggle))
        return sum(1 << bit for bit, on in bits if bit is not None and on)


def check_address(address: int) -> None:
    """Refuse an address outside 0 to 65535; raises ConfigurationError."""
    if not 0 <= address <= _LAST:
        raise ConfigurationError(f"address = {address}; addresses are 0 to {_LAST}, from 0")


def check_bits(*bits: int | None) -> None:
    """Refuse bits outside 0 to 15, and one given twice; raises ConfigurationError."""
    numbers = [bit for bit in bits if bit is not None]
    if any(not 0 <= bit <= 15 for bit in numbers) or len(set(numbers)) < len(numbers):
        raise ConfigurationError(f"bits {numbers}; each is 0 to 15 and stands once")
