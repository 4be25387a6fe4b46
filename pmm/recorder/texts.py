"""Journals of text: one JSON value a line, whole when its line feed is there."""

import json
from pathlib import Path
from typing import Any

from pmm.recorder.line_shapes import is_line_of


def as_line(value: Any) -> bytes:
    """Return a value as a line."""
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
