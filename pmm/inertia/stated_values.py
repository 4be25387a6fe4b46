"""Values of a file with their standard uncertainties: ``mass_kg`` and ``u_mass_kg`` beside it."""

import math
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from typing import Any

from analysis.inertia.corrections import gravity_in_air
from analysis.uncertainty.estimate import Estimate, within
from hardware.description.flags import Flag, Severity
from hardware.description.units import STANDARD_GRAVITY_M_S2

# Endings of keys, longest first: the unit of the estimate, and the factor to it.
_ENDINGS = {
    "_kg_m3": ("kg/m3", 1.0),
    "_kg_m2": ("kg m2", 1.0),
    "_kg_m": ("kg m", 1.0),
    "_n_m_rad": ("N m/rad", 1.0),
    "_m_s2": ("m/s2", 1.0),
    "_deg": ("rad", math.pi / 180.0),
    "_rad": ("rad", 1.0),
    "_kg": ("kg", 1.0),
    "_m": ("m", 1.0),
    "_s": ("s", 1.0),
}
# Gravity at sea level runs from 9.780 to 9.832 m/s2; half of that, evenly.
_GRAVITY_ANYWHERE = within(STANDARD_GRAVITY_M_S2, 0.026, "m/s2")


def unit_of(key: str) -> tuple[str, float]:
    """Return the SI unit that a key's ending names, and the factor to it."""
    return next((unit for ending, unit in _ENDINGS.items() if key.endswith(ending)), ("1", 1.0))


def stated_value(table: object, key: str, place: str | None = None) -> Estimate:
    """Return the value of a key with the standard uncertainty beside it, in SI units.

    Parameters
    ----------
    place
        Of the table in its file, where the value is read more than once: it is then the same input.
    """
    unit, factor = unit_of(key)
    value, spread = getattr(table, key), getattr(table, f"u_{key}")
    label = None if place is None else f"{place}.{key}"
    return Estimate.of(factor * value, factor * spread, unit, label=label)


def given_or_none(table: object, key: str, place: str | None = None) -> Estimate | None:
    """Return the value of a key that may be left out."""
    return None if getattr(table, key) is None else stated_value(table, key, place)


def plain_gravity_of(table: Any) -> Estimate:
    """Return gravity; that of anywhere at sea level where none is given."""
    is_stated = table.gravity_m_s2 is not None
    return stated_value(table, "gravity_m_s2", "file") if is_stated else _GRAVITY_ANYWHERE


def gravity_of(table: Any) -> Estimate:
    """Return gravity less buoyancy."""
    plain = plain_gravity_of(table)
    if not getattr(table, "body_density_kg_m3", None):
        return plain
    value = gravity_in_air(plain.value, table.air_density_kg_m3, table.body_density_kg_m3)
    return plain.following(value, value / plain.value)


def flags_of(table: Any) -> tuple[Flag, ...]:
    """Return flags for a gravity that was not given, and values without uncertainty."""
    flags = []
    if table.gravity_m_s2 is None:
        message = (
            f"no gravity_m_s2 is given; {_GRAVITY_ANYWHERE.value:g} +- "
            f"{_GRAVITY_ANYWHERE.uncertainty:.2g} m/s2 (anywhere at sea level) is used: look up "
            "your place's"
        )
        flags.append(Flag("gravity_not_given", Severity.NOTE, message))
    bare = sorted(set(without_uncertainty(table)))
    if bare:
        message = f"taken to be exact, as no uncertainty stands beside: {', '.join(bare)}"
        flags.append(Flag("no_uncertainty", Severity.NOTE, message))
    return tuple(flags)


def without_uncertainty(table: Any, place: str = "") -> Iterator[str]:
    """Yield the keys whose values have an uncertainty of 0, at any depth.

    Not those that are 0 where they are left out: a part in the centre plane, no gyradius.
    """
    defaults = {field.name: field.default for field in fields(table)}
    for name in sorted(defaults):
        value = getattr(table, name)
        left_out = value == 0.0 == defaults[name]
        if isinstance(value, float) and getattr(table, f"u_{name}", None) == 0.0 and not left_out:
            yield f"{place}{name}"
        for number, item in enumerate(value if isinstance(value, tuple) else (value,), 1):
            if is_dataclass(item):
                label = getattr(item, "name", None) or number
                inner = f"{name}[{label}]" if isinstance(value, tuple) else name
                yield from without_uncertainty(item, f"{place}{inner}.")
