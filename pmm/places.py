"""Where an error of a configuration file lies, and what the table there was meant to be."""

import types
from dataclasses import MISSING, fields, is_dataclass
from difflib import SequenceMatcher
from typing import Any, NamedTuple, Union, get_args, get_origin, get_type_hints

Place = tuple[str | int, ...]


class PlaceMatch(NamedTuple):
    """A place in the words of the file, and the keys that the table around it may have."""

    place: Place
    keys: tuple[str, ...]


def find(kind: Any, place: Place, table: Any) -> PlaceMatch | None:
    """Follow a place of pydantic's through the classes.

    Where a table may be one of several classes, told apart by their keys, pydantic names a class in
    the place and tries them all.

    It is ``None`` for what is wrong with a table taken for a class that it is not meant to be.
    """
    cleaned: list[str | int] = []
    keys: tuple[str, ...] = ()
    for key in place:
        members = _members(kind)
        if len(members) > 1:
            kind = likeliest_class(members, table)
            if key != kind.__name__:
                return None
            continue
        kind = members[0]
        keys = _keys(kind)
        cleaned.append(key)
        kind, table = _part(kind, key), _value(table, key)
    return PlaceMatch(tuple(cleaned), keys)


def likeliest_class(members: list[Any], table: Any) -> Any:
    """Return the class whose keys are most like those of a table; the first of equals."""
    return max(
        members, key=lambda member: _likeness(member, table if isinstance(table, dict) else {})
    )


def _likeness(kind: Any, table: dict[str, Any]) -> float:
    names = _keys(kind)
    like = sum(
        max((SequenceMatcher(None, key, name).ratio() for name in names), default=0.0)
        for key in table
    )
    missing = sum(
        field.name not in table and field.default is MISSING and field.default_factory is MISSING
        for field in fields(kind)
    )
    return like - 0.1 * missing


def _members(kind: Any) -> list[Any]:
    """Return what a union is of, without ``None`` and bases that no file can give."""
    if get_origin(kind) not in (Union, types.UnionType):
        return [kind]
    parts = [part for part in get_args(kind) if part is not type(None)]
    return [part for part in parts if is_dataclass(part)] or parts[:1]


def _keys(kind: Any) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind)) if is_dataclass(kind) else ()


def _part(kind: Any, key: str | int) -> Any:
    """Return the type of a part; ``None`` below an unknown key."""
    if is_dataclass(kind):
        return get_type_hints(kind).get(str(key))
    arguments = get_args(kind)
    return arguments[0 if isinstance(key, int) else -1] if arguments else None


def _value(table: Any, key: str | int) -> Any:
    try:
        return table[key]
    except (KeyError, IndexError, TypeError):
        return None
