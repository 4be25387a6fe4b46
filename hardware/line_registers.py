"""Numbers and states of a drive panel that answers lines of text: what is asked and what comes.

Every panel has a protocol of its own, so that all of it is data of ``rig.toml``: templates in which
``{value}`` stands for the number. To the device behind it each is a register, as a programmable
controller has them.
"""

import re
import struct
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Final, Literal

from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.modbus_registers import UNITS, Table, Unit

_VALUE: Final = re.compile(r"\{value(:[^}]*)?\}")
_NUMBER: Final = r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*"
_STATES: Final = ("remote", "ready", "alarm", "at_end")
_APART: Final = 100  # addresses: each line is asked by itself


@dataclass(frozen=True, kw_only=True)
class Addressed:
    """A line with a place among the others, as a register has its address."""

    address: int = field(default=0, init=False)

    def at(self, number: int) -> None:
        """Set the address from the line's number among the others."""
        object.__setattr__(self, "address", number * _APART)


def pattern_of(template: str) -> re.Pattern[str]:
    """Return what a reply has to look like for a template; a number stands for ``{value}``.

    Where the template has spaces, the reply has any number of them.
    """
    parts = (map(re.escape, part.split()) for part in _VALUE.split(template)[::2])
    return re.compile(_NUMBER.join(r"\s*".join(words) for words in parts))


@dataclass(frozen=True, kw_only=True)
class LineNumber(Addressed):
    """A number that is asked for, or set.

    Attributes
    ----------
    line
        What is sent: ``"RS"``, or ``"SP {value:.3f}"`` where the number is set.
    answer
        The reply: ``"V={value}"``, or ``"OK"`` where the number is set.
    scale
        Of 1 in the line, in ``unit``; negative where the panel counts the other way.
    """

    line: str
    answer: str
    unit: Unit
    scale: float = 1.0

    table: ClassVar[Table] = "holding"
    count: ClassVar[int] = 4  # words of a floating-point number

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        if self.scale == 0.0:
            raise ConfigurationError("scale = 0; it is what 1 in the line is worth, in the unit")
        if len(_VALUE.findall(self.line)) + len(_VALUE.findall(self.answer)) != 1:
            raise ConfigurationError(
                f"line = {self.line!r} and answer = {self.answer!r}: {{value}} stands once, in the "
                "line of what is set or in the answer to what is read"
            )
        try:
            self.line.format(value=0.0)
        except (ValueError, KeyError, IndexError) as error:
            raise ConfigurationError(
                f"line = {self.line!r} cannot be written ({error}); say {{value:.3f}} for three "
                "places"
            ) from error

    def value(self, words: Sequence[int]) -> float:
        """Return the number in SI units that its four words of 16 bits hold."""
        (raw,) = struct.unpack(">d", struct.pack(">4H", *words))
        return float(raw) * self.scale * UNITS[self.unit]

    def written(self, value: float) -> tuple[int, ...]:
        """Return the number as it stands in the line, in words."""
        return struct.unpack(">4H", struct.pack(">d", value / (self.scale * UNITS[self.unit])))

    def text(self, words: Sequence[int]) -> str:
        """Return the line that sets a number, or asks for it."""
        (raw,) = struct.unpack(">d", struct.pack(">4H", *words)) if words else (0.0,)
        return self.line.format(value=raw + 0.0)

    def words(self, said: str) -> tuple[int, ...] | None:
        """Return the number of a reply in words, none for what is set; ``None`` for no reply."""
        match = pattern_of(self.answer).fullmatch(said.strip())
        if match is None or not match.groups():
            return None if match is None else ()
        return struct.unpack(">4H", struct.pack(">d", float(match[1])))


@dataclass(frozen=True, kw_only=True)
class LineStatus(Addressed):
    """States that a reply names; those that the panel lacks are left out.

    Attributes
    ----------
    answer
        What each reply begins with.
    remote, ready, alarm, at_end
        A word that stands in the reply as long as it is so; see
        :class:`hardware.modbus_registers.StatusRegister`.
    """

    line: str
    answer: str = ""
    remote: str = ""
    ready: str = ""
    alarm: str = ""
    at_end: str = ""

    table: ClassVar[Table] = "holding"
    count: ClassVar[int] = 1

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def says(self, name: str, word: int | None) -> bool | None:
        """Return what the reply says of a state; ``None`` without its word, or before a reply."""
        if not getattr(self, name) or word is None:
            return None
        return bool(word >> _STATES.index(name) & 1)

    def text(self, _words: Sequence[int]) -> str:
        """Return the line of text that asks for the status."""
        return self.line

    def words(self, said: str) -> tuple[int, ...] | None:
        """Return the states of a reply, a bit each; ``None`` for no reply."""
        if not said.strip().startswith(self.answer):
            return None
        texts = (getattr(self, name) for name in _STATES)
        return (sum(1 << bit for bit, text in enumerate(texts) if text and text in said),)


@dataclass(frozen=True, kw_only=True)
class LineCommand(Addressed):
    """Lines that command the panel, and its reply to each.

    Attributes
    ----------
    on, off
        Power; what is not said again for as long as the panel waits is off.
    clear
        Clears an alarm; empty where the panel has none.
    """

    on: str
    off: str
    clear: str = ""
    answer: str = "OK"

    enable: ClassVar[int] = 0
    reset: ClassVar[int] = 1
    toggle: ClassVar[None] = None
    count: ClassVar[int] = 1

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def word(self, *, enable: bool, reset: bool, toggle: bool) -> int:
        """Return the command word: power in bit 0, clearing an alarm in bit 1."""
        return int(enable) | int(reset and bool(self.clear)) << self.reset

    def text(self, words: Sequence[int]) -> str:
        """Return the line of text that a command word stands for."""
        if words[0] >> self.reset & 1:
            return self.clear
        return self.on if words[0] & 1 else self.off

    def words(self, said: str) -> tuple[int, ...] | None:
        """Return nothing for the right reply, ``None`` for another."""
        return () if pattern_of(self.answer).fullmatch(said.strip()) else None


Line = LineNumber | LineStatus | LineCommand
Ending = Literal["\r", "\n", "\r\n"]
