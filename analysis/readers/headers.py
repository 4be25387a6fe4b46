"""What a column's header says: its name and its unit."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches

from analysis.readers.clock import DATE
from hardware.description.errors import ConfigurationError
from hardware.description.units import is_unit, unit

# What the clocks of small loggers count.
_LOGGERS = {"millis": "ms", "milliseconds": "ms", "msec": "ms", "micros": "us"}
TIME_NAMES = (
    "time", "times", "t", "timestamp", "zeit", "temps", "tid", "tijd", "seconds", "sec", "epoch",
    *_LOGGERS,
)  # fmt: skip
_TIME_WORDS = {"time", "zeit", "temps", "tijd"}

_BRACKETS = re.compile(r"^(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]$")
_SEPARATORS = re.compile(r"\s+in\s+|\s*[,/]\s*|_|\s+")
# "WP_1" and "x_-" are names, not dimensionless columns.
_NO_SUFFIX = ("1", "-")


@dataclass(frozen=True)
class Header:
    """A column's header: ``number`` counts from 1, ``unit`` is ``None`` where it says none."""

    number: int
    text: str
    name: str
    unit: str | None
    unit_is_suffix: bool = False

    @property
    def generic(self) -> str:
        """The name by which any column can be asked for: ``column_3`` is the third."""
        return f"column_{self.number}"

    @property
    def is_time(self) -> bool:
        """Whether the name is one that time stamps go by, or has such a word and a time's unit."""
        called = self.name.casefold()
        if called in TIME_NAMES:
            return self.unit != DATE
        in_time = self.unit is not None and is_unit(self.unit) and unit(self.unit).si == "s"
        return in_time and not _TIME_WORDS.isdisjoint(re.split(r"[\W_]+", called))


def parse_header(number: int, text: str) -> Header:
    """Split a column's header into name and unit.

    ``Name [unit]`` and ``Name (unit)`` state any unit. ``Name_unit``, ``Name unit``, ``Name/unit``,
    ``Name, unit`` and ``Name in unit`` do where the unit is a known one.
    """
    text = text.strip()
    match = _BRACKETS.match(text)
    if match:
        name, stated = match["name"].strip(), match["unit"].strip()
        return Header(number, text, name or f"column_{number}", stated or None)
    for separator in _SEPARATORS.finditer(text):
        name, suffix = text[: separator.start()], text[separator.end() :]
        if name and suffix not in _NO_SUFFIX and is_unit(suffix):
            return Header(number, text, name, suffix, unit_is_suffix=True)
    return Header(number, text, text or f"column_{number}", _LOGGERS.get(text.casefold()))


def stated_unit(header: Header, selector: str) -> str | None:
    """Return the unit that a header states; where it has none, what its selector asks for.

    ``F1 [kN]`` states the unit of a column ``F1``.
    """
    if header.unit or selector in (header.text, header.name):
        return header.unit
    return parse_header(0, selector).unit


def unit_hint(name: str) -> str:
    """Return ``"; did you mean 'kN'?"`` for ``kNN`` or ``KN``, ``'kgf'`` for ``kg``, or nothing."""
    shorter = [name[:k] + name[k + 1 :] for k in range(len(name))]
    cased = [name.lower(), name.upper(), name[:1].lower() + name[1:].upper(), name.capitalize()]
    words = (*cased, f"{name}f", *shorter)  # the force of kg and lb before what is shorter
    match = next((word for word in words if len(word) > 0 and is_unit(word)), None)
    return f"; did you mean {match!r}?" if match else ""


def find_header(headers: Sequence[Header], selector: str, where: str) -> Header:
    """Return the column that ``selector`` names.

    It may be the whole header, the name without the unit, the name with the unit where the header
    has none, or ``column_3``.

    Raises
    ------
    ConfigurationError
        If no column is called so (the message suggests the nearest), or several are.
    """
    wanted = parse_header(0, selector)
    rules: tuple[Callable[[Header], bool], ...] = (
        lambda h: h.text == selector,
        lambda h: h.generic == selector,
        lambda h: h.name == selector,
        lambda h: h.name == wanted.name and h.unit in (None, wanted.unit),
    )
    for rule in rules:
        matching = [header for header in headers if rule(header)]
        if len(matching) == 1:
            return matching[0]
        if matching:
            numbers = " or ".join(header.generic for header in matching)
            raise ConfigurationError(
                f"{where}: {len(matching)} columns are {selector!r}; ask for {numbers}"
            )
    texts = {header.name: header.text or header.generic for header in headers}
    matches = [texts[name] for name in get_close_matches(wanted.name, texts, n=3, cutoff=0.5)]
    hint = f"; did you mean {' or '.join(map(repr, matches))}?" if matches else ""
    names = ", ".join(texts.values())
    raise ConfigurationError(f"{where}: no column {selector!r}{hint} (columns: {names})")
