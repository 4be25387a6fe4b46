"""Units a recording may come in, and what turns them into SI."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class Unit:
    """One unit: multiply a value by ``factor`` to have it in the SI unit ``si``."""

    si: str
    factor: float


STANDARD_GRAVITY_M_S2 = 9.80665

_UNITS: dict[str, Unit] = {
    "s": Unit("s", 1.0),
    "ms": Unit("s", 1e-3),
    "us": Unit("s", 1e-6),
    "ns": Unit("s", 1e-9),
    "min": Unit("s", 60.0),
    "m": Unit("m", 1.0),
    "cm": Unit("m", 1e-2),
    "mm": Unit("m", 1e-3),
    "N": Unit("N", 1.0),
    "kN": Unit("N", 1e3),
    "mN": Unit("N", 1e-3),
    "kgf": Unit("N", STANDARD_GRAVITY_M_S2),
    "lbf": Unit("N", 0.45359237 * STANDARD_GRAVITY_M_S2),
    "Nm": Unit("N m", 1.0),
    "N m": Unit("N m", 1.0),
    "N*m": Unit("N m", 1.0),
    "kNm": Unit("N m", 1e3),
    "rad": Unit("rad", 1.0),
    "deg": Unit("rad", math.pi / 180.0),
    "rev": Unit("rad", 2.0 * math.pi),
    "m/s": Unit("m/s", 1.0),
    "cm/s": Unit("m/s", 1e-2),
    "mm/s": Unit("m/s", 1e-3),
    "km/h": Unit("m/s", 1.0 / 3.6),
    "knot": Unit("m/s", 1852.0 / 3600.0),
    "rad/s": Unit("rad/s", 1.0),
    "deg/s": Unit("rad/s", math.pi / 180.0),
    "rpm": Unit("rad/s", 2.0 * math.pi / 60.0),
    "m/s2": Unit("m/s2", 1.0),
    "m/s^2": Unit("m/s2", 1.0),
    "g": Unit("m/s2", STANDARD_GRAVITY_M_S2),
    "Hz": Unit("Hz", 1.0),
    "V": Unit("V", 1.0),
    "mV": Unit("V", 1e-3),
    "degC": Unit("degC", 1.0),
    "-": Unit("1", 1.0),
    "1": Unit("1", 1.0),
}
# As spreadsheets and loggers write them.
_ALIASES = {
    "µs": "us", "μs": "us", "sec": "s", "°": "deg", "°/s": "deg/s", "N·m": "N m", "m/s²": "m/s2",
    "°C": "degC",
}  # fmt: skip


def unit(name: str) -> Unit:
    """Return the unit called ``name``, for example ``"mm"``, ``"kN"`` or ``"deg"``.

    Raises
    ------
    ConfigurationError
        If the name is not known; the message lists the known ones.
    """
    try:
        return _UNITS[_plain(name)]
    except KeyError:
        names = ", ".join(_UNITS)
        raise ConfigurationError(f"unknown unit {name!r}; known units: {names}") from None


def is_unit(name: str) -> bool:
    """Tell whether ``name`` is a unit that :func:`unit` knows."""
    return _plain(name) in _UNITS


def units_of(si: str) -> Mapping[str, float]:
    """Return the factors of all units of one quantity by name, for example those of ``"N"``."""
    return {name: unit.factor for name, unit in _UNITS.items() if unit.si == si}


def _plain(name: str) -> str:
    return _ALIASES.get(name.strip(), name.strip())
