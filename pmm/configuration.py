"""Configuration files: read, checked against a dataclass, and every error of a file at once."""

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final, NamedTuple, TypeVar

from hardware.description.errors import ConfigurationError
from hardware.description.toml import adapter, is_number, parse_toml
from pmm.places import Place as Place
from pmm.places import find

T = TypeVar("T")


# Classes of tables carry this as ``__pydantic_config__``, for the tables in them too: unknown keys,
# NaN and infinity are refused.
STRICT_TABLE: Final = {"extra": "forbid", "allow_inf_nan": False}


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
    return read_toml_and_bytes(path)[0]


def read_toml_and_bytes(path: Path) -> tuple[dict[str, Any], bytes]:
    """Read a TOML file once: what it says, and what it was, for its hash and its copy.

    Raises
    ------
    ConfigurationError
        If it cannot be read; the message gives the line.
    """
    try:
        content = path.read_bytes()
        return parse_toml(content.decode("utf-8-sig")), content
    except FileNotFoundError:
        raise ConfigurationError(f"{path}: no such file") from None
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(
            f"{path}: not a readable TOML file: {error}{_hint(path)}"
        ) from None
    except ConfigurationError as error:
        raise ConfigurationError(f"{path}: {error}{_hint(path)}") from None


def _hint(path: Path) -> str:
    """Return what to give in place of a recording."""
    if path.suffix.lower() in ("", ".toml") or path.is_dir():
        return ""
    return "; where this is a recording, give a TOML file that names it"


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
        instance: T = adapter(key).validate_json(json.dumps(table), strict=True)
    except ValidationError as error:
        for entry in error.errors(include_url=False):
            match = find(kind, entry["loc"], table)
            if match is None:
                continue
            place = match.place
            if entry["type"] == "unexpected_keyword_argument":
                table_name = next((key for key in place if isinstance(key, str)), "")
                extra = extra_keys.get(table_name, ()) if len(place) > 1 else ()
                faults.append(Fault(place, unknown(place, (*match.keys, *extra))))
            elif entry["type"] == "missing":
                faults.append(Fault(place, "is missing"))
            else:
                faults.append(Fault(place, f"= {_short(entry['input'])} {_problem(entry['msg'])}"))
        return None
    except ConfigurationError as error:  # a value that its own class refuses
        faults.append(Fault((), str(error)))
        return None
    return instance


def _problem(message: str) -> str:
    """Say what pydantic says in the words of a TOML file."""
    message = message.removeprefix("Input ")
    for word, ours in (("an object", "a table"), ("integer", "whole number"), ("string", "text")):
        message = message.replace(word, ours)
    return message


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def unknown(place: Place, keys: Sequence[str]) -> str:
    """Say that a key is not known, and which one may be meant."""
    keys = [key for key in keys if not key.startswith("_")]
    near = get_close_matches(str(place[-1]), keys, n=1, cutoff=0.5)
    hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(keys)}"
    return f"is not a known key; {hint}"


_MAY_BE_INFINITE: Final = "degrees_of_freedom"  # of what does not rest on repeats


class Bounds(NamedTuple):
    """What a number must be: above (or from) its low end, up to its high end."""

    low: float
    high: float
    from_low: bool = False
    hint: str = ""

    def fault(self, value: float) -> str | None:
        """Say what a value should be that is not within; ``None`` if it is."""
        if value < self.low or (value == self.low and not self.from_low):
            least = f"should be {self.low:g} or more" if self.from_low else "should be above 0"
            return least + self.hint
        return f"should be at most {self.high:g}{self.hint}" if value > self.high else None


_MOST: Final = 1e12  # of whatever unit, as of a sample: no tank has more
_COUNT: Final = 100_000  # of periods: more than two weeks at 0.1 Hz
_SECONDS: Final = 1e6  # eleven days
_DEGREES: Final = "; in degrees? Then the key ends in _deg"
_ANY_WAY: Final = Bounds(-math.pi, math.pi, from_low=True, hint=_DEGREES)
_A_QUARTER: Final = Bounds(-0.5 * math.pi, 0.5 * math.pi, from_low=True, hint=_DEGREES)
# What a number of that name must be, in whichever table it stands. Ten times more would ask for
# what no tank does and no memory holds; ten times less would refuse long swings and fast gauges.
_ABOVE_0: Final = (
    "acceleration_m_s2 amplitude_m apart_m beam_m beats body_density_kg_m3 "
    "carriage_acceleration_m_s2 coefficient density_kg_m3 depth_m diameter_m draught_m flush_s "
    "force_per_strut_n full_scale full_scale_n gravity_m_s2 half_spacing_m highest_speed_m_s "
    "inertia_kg_m2 known_inertia_kg_m2 known_scatter_s length_m lever_m line_m mass_kg moment_kg_m "
    "moment_relative oscillations period_s period_scatter_relative pivot_distance_m reaction_s "
    "rod_length_m safe_load_n square_half_side_m steady_tolerance stiffness_n_m_rad stroke_m "
    "tolerance tolerance_kg tolerance_m velocity_m_s volume_m3 weight_kg width_m"
)
_FROM_0: Final = (
    "air_density_kg_m3 counting_error displaced_kg eccentricity_m eccentricity_mm k_pitch_m "
    "k_roll_m k_yaw_m noise_rms resolution speed_m_s sway_coefficient"
)
_BOUNDS: Final[Mapping[str, Bounds]] = {
    "drift_rad": _ANY_WAY,
    "heel_rad": _A_QUARTER,
    "release_rad": _A_QUARTER,
    "rudder_angle_rad": _A_QUARTER,
    **dict.fromkeys(_ABOVE_0.split(), Bounds(0.0, _MOST)),
    **dict.fromkeys(_FROM_0.split(), Bounds(0.0, _MOST, from_low=True)),
    "duration_s": Bounds(0.0, _SECONDS),
    "every": Bounds(0.0, _COUNT),
    "frequency_hz": Bounds(0.0, 1e4),
    "gate_periods": Bounds(0.0, _COUNT),
    "harmonics": Bounds(0.0, 1000.0),
    "jitter_rms_s": Bounds(0.0, _SECONDS, from_low=True),
    "known_scatter_degrees_of_freedom": Bounds(0.0, math.inf),
    "max_periods": Bounds(0.0, _COUNT),
    "pause_s": Bounds(0.0, _SECONDS, from_low=True),
    "period_degrees_of_freedom": Bounds(0.0, math.inf),
    "periods": Bounds(0.0, _COUNT),
    "repeats": Bounds(0.0, 1000.0),
    "sample_rate_hz": Bounds(0.0, 1e6),
    "seed": Bounds(0.0, 2.0**63, from_low=True),
    "settling_periods": Bounds(0.0, _COUNT, from_low=True),
    "start_ramp_s": Bounds(0.0, _SECONDS, from_low=True),
    "waiting_s": Bounds(0.0, _SECONDS, from_low=True),
}
_UNCERTAINTY: Final = Bounds(0.0, math.inf, from_low=True)  # of a key that begins with u_


def _number_fault(key: str, value: float) -> str | None:
    """Say what a number should be that is none, or not within the bounds of its name."""
    if not math.isfinite(value) and (math.isnan(value) or not key.endswith(_MAY_BE_INFINITE)):
        return "should be a finite number"
    bounds = _UNCERTAINTY if key.startswith("u_") else _BOUNDS.get(key)
    return bounds.fault(value) if bounds else None


def limit_faults(table: Any, place: Place = ()) -> Iterator[Fault]:
    """Yield what is no finite number or not within the bounds of its name, at any depth."""
    parts = table.items() if isinstance(table, dict) else enumerate(table)
    for key, value in parts:
        value_place: Place = (*place, key)
        if isinstance(value, dict | list):
            yield from limit_faults(value, value_place)
        elif is_number(value):
            fault = _number_fault(str(key), value)
            if fault is not None:
                yield Fault(value_place, f"= {value:g} {fault}")


def as_error(path: Path, faults: Sequence[Fault], table: Mapping[str, Any]) -> ConfigurationError:
    """Return all faults of a file as one error: for each its path in the file and the message."""
    texts = (f"{place_text(fault.place, table)}{fault.message}" for fault in faults)
    lines = list({line.lower(): line for line in texts}.values())  # nan and NaN are one fault
    if len(lines) == 1:
        return ConfigurationError(f"{path}: {lines[0]}")
    return ConfigurationError(f"{path}: {len(lines)} errors\n  " + "\n  ".join(lines))


def place_text(place: Place, table: Any) -> str:
    """Return a place in words and a blank, as ``runs["heave"].frequency_hz``.

    Entries go by their name, those without one are counted from 1.
    """
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
