"""Configuration files: read, checked against a dataclass, and every error of a file at once."""

import json
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from types import MappingProxyType
from typing import (
    TYPE_CHECKING,
    Any,
    NamedTuple,
    TypeVar,
)

from hardware.description.errors import ConfigurationError
from pmm.places import Place as Place
from pmm.places import find

if TYPE_CHECKING:
    from pydantic import TypeAdapter

T = TypeVar("T")


class Fault(NamedTuple):
    """One error of a file: where, and what."""

    place: Place
    message: str


def read_toml(path: Path) -> dict[str, Any]:
    """Read a TOML file.

    Raises
    ------
    ConfigurationError
        If it cannot be read; the message gives the line.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except FileNotFoundError:
        raise ConfigurationError(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise ConfigurationError(f"{path}: not a readable TOML file: {error}") from None


def validate(
    kind: type[T],
    table: Mapping[str, Any],
    faults: list[Fault],
    extra_keys: Mapping[str, Sequence[str]] = MappingProxyType({}),
) -> T | None:
    """Build a dataclass from a table; on errors note all of them and return ``None``.

    Numbers have to be numbers: text and booleans are not taken for any.

    Parameters
    ----------
    extra_keys
        Keys that the caller has taken out of the tables already, by the table's name: known ones,
        for suggestions.
    """
    from pydantic import ValidationError

    key: Any = kind
    try:
        # By way of JSON: there pydantic is strict about numbers and yet takes arrays for tuples.
        found: T = _adapter(key).validate_json(json.dumps(table, default=str), strict=True)
    except ValidationError as error:
        for one in error.errors(include_url=False):
            where = find(kind, one["loc"], table)
            if where is None:
                continue
            place = where.place
            if one["type"] == "unexpected_keyword_argument":
                table_name = next((key for key in place if isinstance(key, str)), "")
                extra = extra_keys.get(table_name, ()) if len(place) > 1 else ()
                faults.append(Fault(place, unknown(place, (*where.known, *extra))))
            elif one["type"] == "missing":
                faults.append(Fault(place, "is missing"))
            else:
                faults.append(Fault(place, f"= {_short(one['input'])} {_problem(one['msg'])}"))
        return None
    except ConfigurationError as error:  # a value that its own class refuses
        faults.append(Fault((), str(error)))
        return None
    return found


@cache
def _adapter(kind: Any) -> "TypeAdapter[Any]":
    from pydantic import TypeAdapter

    return TypeAdapter(kind)


def _problem(message: str) -> str:
    """Say what pydantic says in the words of a TOML file."""
    message = message.removeprefix("Input ")
    for word, ours in (("an object", "a table"), ("integer", "whole number"), ("string", "text")):
        message = message.replace(word, ours)
    return message


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def unknown(place: Place, known: Sequence[str]) -> str:
    """Say that a key is not known, and which one may be meant."""
    known = [one for one in known if not one.startswith("_")]
    near = get_close_matches(str(place[-1]), known, n=1, cutoff=0.5)
    hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(known)}"
    return f"is not a known key; {hint}"


# What a number of that name must be, in whichever table it stands.
_ABOVE_0 = (
    "frequency_hz",
    "force_per_strut_n",
    "full_scale",
    "full_scale_n",
    "half_spacing_m",
    "inertia_kg_m2",
    "mass_kg",
    "periods",
    "rod_length_m",
    "sample_rate_hz",
    "steady_tolerance",
)
_NOT_BELOW_0 = (
    "eccentricity_m",
    "eccentricity_mm",
    "jitter_rms_s",
    "noise_rms",
    "resolution",
    "seed",
    "settling_periods",
    "start_ramp_s",
    "waiting_s",
)


def limit_faults(table: Any, place: Place = ()) -> Iterator[Fault]:
    """Yield what is below zero and should not be, at any depth of a table."""
    parts = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in parts:
        here: Place = (*place, key)
        if isinstance(value, dict | list):
            yield from limit_faults(value, here)
        elif isinstance(value, int | float) and not isinstance(value, bool):
            if key in _ABOVE_0 and value <= 0:
                yield Fault(here, f"= {value:g} should be above 0")
            elif key in _NOT_BELOW_0 and value < 0:
                yield Fault(here, f"= {value:g} should be 0 or more")


def as_error(path: Path, faults: Sequence[Fault], table: Mapping[str, Any]) -> ConfigurationError:
    """Return all faults of a file as one error: for each its path in the file and the message."""
    lines = list(dict.fromkeys(f"{_path(fault.place, table)}{fault.message}" for fault in faults))
    if len(lines) == 1:
        return ConfigurationError(f"{path}: {lines[0]}")
    return ConfigurationError(f"{path}: {len(lines)} errors\n  " + "\n  ".join(lines))


def _path(place: Place, table: Any) -> str:
    """Return ``runs["heave"].frequency_hz``: entries by name, or else counted from 1."""
    text = ""
    for key in place:
        table = table[key] if _holds(table, key) else None
        if isinstance(key, str):
            text += f".{key}" if text else key
        else:
            name = table.get("name") if isinstance(table, dict) else None
            text += f'["{name}"]' if isinstance(name, str) and name else f"[{key + 1}]"
    return f"{text} " if text else ""


def _holds(table: Any, key: str | int) -> bool:
    if isinstance(table, dict):
        return key in table
    return isinstance(table, list) and isinstance(key, int) and key < len(table)
