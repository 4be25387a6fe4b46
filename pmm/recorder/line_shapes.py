"""What a line of each journal of text and a marker hold: JSON of another shape is damage."""

import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

from hardware.description.flags import Flag
from hardware.description.toml import is_number
from pmm.recorder.files import CYCLES, EVENTS, HARMONICS, LINES, MARKER, PULSES, RECOVERED

Shape = Callable[[Any], bool]


def is_line_of(name: str, value: Any) -> bool:
    """Tell whether a value can be a line of the journal of that name; any can of another file."""
    shape = _SHAPES.get(name)
    return shape is None or shape(value)


def is_marker(value: Mapping[str, Any]) -> bool:
    """Tell whether a table can be a completion marker; older ones have fewer keys."""
    return _MARKER(value) and all(
        shape(value[key]) for key, shape in _MARKER_MORE.items() if key in value
    )


def is_recovered(value: Mapping[str, Any]) -> bool:
    """Tell whether a table can be what a recovery wrote; older ones name no files."""
    return _FLAGGED(value) and _files(value.get("files", {}))


def _row(*shapes: Shape) -> Shape:
    """Return the shape of a list with so many entries, each of its own shape."""

    def fits(value: Any) -> bool:
        return (
            isinstance(value, list)
            and len(value) == len(shapes)
            and all(shape(item) for shape, item in zip(shapes, value, strict=True))
        )

    return fits


def _table(**shapes: Shape) -> Shape:
    """Return the shape of a table with at least these keys."""

    def fits(value: Any) -> bool:
        return isinstance(value, dict) and all(
            key in value and shape(value[key]) for key, shape in shapes.items()
        )

    return fits


def _list_of(shape: Shape) -> Shape:
    return lambda value: isinstance(value, list) and all(map(shape, value))


def _finite(value: Any) -> bool:
    return is_number(value) and abs(value) < 1e300 and math.isfinite(value)


def is_integer(value: Any) -> bool:
    """Tell whether a value is a whole number that any program reads exactly."""
    return isinstance(value, int) and not isinstance(value, bool) and abs(value) < 2**53


def is_text(value: Any) -> bool:
    """Tell whether a value is text."""
    return isinstance(value, str)


def _bytes(value: Any) -> bool:
    return isinstance(value, str) and all(ord(character) < 256 for character in value)


def _finite_or_none(value: Any) -> bool:
    return value is None or _finite(value)


def _reading(value: Any) -> bool:
    return _READING(value) and [len(row) for row in value["coefficients"]] == len(
        value["channels"]
    ) * [len(value["coefficients"][0]) if value["coefficients"] else 0]


def _table_of(shape: Shape) -> Shape:
    return lambda value: isinstance(value, dict) and all(map(shape, value.values()))


_files: Final = _table_of(_table(bytes=is_integer, sha256=is_text))
_flags: Final = _list_of(_table(code=is_text, severity=is_text, message=is_text))
_FLAGGED: Final = _table(flags=_flags)
_MARKER: Final = _table(outcome=is_text, files=_files, flags=_flags)
_MARKER_MORE: Final[Mapping[str, Shape]] = {
    "first_sync": is_integer,
    "last_sync": is_integer,
    "noise_rms": _table_of(_finite),
}
_READING: Final = _table(
    opened_s=_finite,
    closed_s=_finite,
    periods=is_integer,
    channels=_list_of(is_text),
    coefficients=_list_of(_list_of(is_number)),
)
_SHAPES: Final[Mapping[str, Shape]] = {
    PULSES: _row(is_integer, _finite, _finite_or_none),
    EVENTS: _table(cycle=is_integer, time_s=_finite, kind=is_text, text=is_text),
    HARMONICS: _reading,
    LINES: _row(is_integer, is_text, _bytes),
    CYCLES: _row(is_integer, _finite, _finite, _finite, is_integer),
}


def as_line(value: Any) -> bytes:
    """Return a value as compact JSON, a line with its end."""
    return json.dumps(value, separators=(",", ":")).encode() + b"\n"


def read_lines(path: Path) -> tuple[list[Any], int]:
    """Return the whole values of a journal, and how many bytes behind them are not whole.

    A journal that is not there is an empty one.
    """
    if not path.exists():
        return [], 0
    data = path.read_bytes()
    values: list[Any] = []
    at = 0
    while (end := data.find(b"\n", at)) >= 0:
        try:
            value = json.loads(data[at:end])
        except (ValueError, RecursionError):
            break
        if not is_line_of(path.name, value):
            break
        values.append(value)
        at = end + 1
    return values, len(data) - at


def read_marker(folder: Path) -> dict[str, Any] | None:
    """Return what a run's marker says; ``None`` where there is none, or it cannot be one."""
    marker = _read(folder / MARKER)
    return (
        marker if marker is not None and is_marker(marker) and _are_flags(marker["flags"]) else None
    )


def read_recovered(folder: Path) -> dict[str, Any]:
    """Return what an earlier recovery wrote; nothing where there was none, or it is damaged."""
    recovered = _read(folder / RECOVERED)
    is_whole = recovered is not None and is_recovered(recovered) and _are_flags(recovered["flags"])
    return recovered if recovered is not None and is_whole else {}


def _read(path: Path) -> dict[str, Any] | None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError):
        return None
    return content if isinstance(content, dict) else None


def _are_flags(flags: list[Mapping[str, Any]]) -> bool:
    try:
        tuple(map(Flag.read, flags))
    except (ValueError, TypeError, KeyError):
        return False
    return True
