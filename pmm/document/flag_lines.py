"""Flags as lines for people: equal ones stand once, with the runs and channels that they are of."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from hardware.description.flags import Flag, Severity
from hardware.description.words import joined
from pmm.document.content import Note

_NUMBER = re.compile(r"[-+−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
NONE: Mapping[str, str] = MappingProxyType({})
_ORDER = (Severity.VOID, Severity.WARNING, Severity.NOTE)


@dataclass(frozen=True)
class FlagLine:
    """Flags that say the same, but for their numbers.

    Attributes
    ----------
    where
        Names of the runs, then of the channels; empty where the flag is of neither.
    message
        Of the first of them.
    count
        How many there are.
    varied
        Whether their numbers are not all the same.
    """

    severity: Severity
    code: str
    where: str
    message: str
    count: int
    varied: bool = False

    @property
    def text(self) -> str:
        """The whole line but for severity and code."""
        where = f"{self.where}: " if self.where else ""
        numbers = "; the numbers are those of the first" if self.varied else ""
        alike = f" ({self.count} times{numbers})" if self.count > 1 else ""
        return f"{where}{self.message}{alike}"


def flag_lines(flags: Iterable[Flag]) -> tuple[FlagLine, ...]:
    """Return a line for each kind of flag, the gravest first."""
    groups: dict[tuple[int, str, str], list[Flag]] = {}
    for flag in dict.fromkeys(flags):
        key = (_ORDER.index(flag.severity), flag.code, _words(flag))
        groups.setdefault(key, []).append(flag)
    return tuple(_line(groups[key]) for key in sorted(groups, key=lambda key: key[0]))


def flag_notes(flags: Iterable[Flag], options: Mapping[str, str] = NONE) -> list[Note]:
    """Return a note for each kind of flag, the gravest first.

    Parameters
    ----------
    options
        By code, what a reader can do about it.
    """
    return [
        Note(
            str(line.severity),
            f"{line.text} ({options[line.code]})" if line.code in options else line.text,
            line.code,
        )
        for line in flag_lines(flags)
    ]


def _line(flags: Sequence[Flag]) -> FlagLine:
    first = flags[0]
    runs = dict.fromkeys(run for flag in flags for run in flag.runs)
    channels = dict.fromkeys(flag.channel for flag in flags if flag.channel)
    where = "; ".join(joined(names) for names in (list(runs), list(channels)) if names)
    varied = len({_without_names(flag) for flag in flags}) > 1
    return FlagLine(first.severity, first.code, where, _message(first), len(flags), varied)


def _message(flag: Flag) -> str:
    """Return the message without the name that the line begins with."""
    return flag.message.removeprefix(f"{flag.channel}: ") if flag.channel else flag.message


def _words(flag: Flag) -> str:
    """Return what the message says, without names and numbers."""
    return _NUMBER.sub("#", _without_names(flag))


def _without_names(flag: Flag) -> str:
    text = _message(flag)
    names = [*flag.runs, *([flag.channel] if flag.channel else [])]
    for name in sorted(names, key=len, reverse=True):
        text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", "", text)
    return text
