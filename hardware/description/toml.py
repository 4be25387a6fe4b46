"""The text of a TOML file as tables of plain values, whatever stands in it."""

import datetime
import math
import tomllib
from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING, Any, Final, TypeGuard

from hardware.description.errors import ConfigurationError

if TYPE_CHECKING:
    from pydantic import TypeAdapter

# Tables in tables: the deepest of ours has 5. Without a limit 1,000 would end every walk over them.
DEEPEST: Final = 32
_INTEGERS: Final = range(-(2**63), 2**63)  # TOML's own: 64 bits

Place = tuple[str | int, ...]


def parse_toml(text: str) -> dict[str, Any]:
    """Return the tables of a TOML file; a date is handed on as text, as in ISO 8601.

    Raises
    ------
    ConfigurationError
        If it is no TOML (the message gives the line), a whole number does not fit 64 bits, or
        tables and lists lie more than 32 deep.
    """
    try:
        tables = tomllib.loads(text)
    except RecursionError:
        raise ConfigurationError(_too_deep(())) from None
    except ValueError as error:
        raise ConfigurationError(f"not a readable TOML file: {error}") from None
    for holder, key, value, place in _values(tables):
        if isinstance(value, datetime.date | datetime.time):
            holder[key] = value.isoformat()
        elif isinstance(value, int) and value not in _INTEGERS:
            raise ConfigurationError(f"{dotted(place)} is a whole number beyond 64 bits")
        elif len(place) > DEEPEST:
            raise ConfigurationError(_too_deep(place))
    return tables


def not_finite(tables: dict[str, Any]) -> Iterator[Place]:
    """Yield where a number is infinite or none at all."""
    for _, _, value, place in _values(tables):
        if isinstance(value, float) and not math.isfinite(value):
            yield place


def dotted(place: Place) -> str:
    """Return ``bus.nodes[2].name``; entries of lists are counted from 1."""
    text = ""
    for key in place:
        text += f"[{key + 1}]" if isinstance(key, int) else f".{key}" if text else key
    return text


def _too_deep(place: Place) -> str:
    where = f"{dotted(place[:3])}... lies" if place else "tables and lists lie"
    return f"not a readable TOML file: {where} more than {DEEPEST} deep"


def _values(tables: dict[str, Any]) -> Iterator[tuple[Any, Any, Any, Place]]:
    """Yield every value with its table or list, its key there, and its place in the file."""
    waiting: list[tuple[Any, Place]] = [(tables, ())]
    while waiting:
        holder, at = waiting.pop()
        if len(at) > DEEPEST:
            continue
        parts = holder.items() if isinstance(holder, dict) else enumerate(holder)
        for key, value in list(parts):
            yield holder, key, value, (*at, key)
            if isinstance(value, dict | list):
                waiting.append((value, (*at, key)))


def is_number(value: object) -> TypeGuard[int | float]:
    """Tell whether a TOML value is a number; true and false are none."""
    return isinstance(value, int | float) and not isinstance(value, bool)


@cache
def adapter(kind: Any) -> "TypeAdapter[Any]":
    """Return what builds a class from a table of its values, made once for each class."""
    from pydantic import TypeAdapter

    return TypeAdapter(kind)
