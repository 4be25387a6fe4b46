"""``ship.toml``: a free ship, with derivatives that were measured or are stated."""

from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from analysis.coefficients.terms import term_of
from analysis.manoeuvring.steering import Propeller, Rudder
from analysis.water import Water
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from pmm.configuration import STRICT_TABLE, Fault, as_error, limit_faults, read_toml, validate

SYSTEMS: Final = ("mmg", "prime")


@dataclass(frozen=True)
class ShipBody:
    """The model or ship: all about the point of its derivatives.

    Attributes
    ----------
    inertia_kg_m2
        About the vertical axis through that point.
    """

    length_m: float
    draught_m: float
    mass_kg: float
    inertia_kg_m2: float
    cg_x_m: float = 0.0


@dataclass(frozen=True)
class StatedHull:
    """Derivatives that are stated, without dimensions.

    Attributes
    ----------
    system
        ``"mmg"`` (rho/2 L d U^2) or ``"prime"`` (rho/2 L^2 U^2).
    values, uncertainty
        By name; standard uncertainties of some of them.
    """

    system: str = "mmg"
    values: dict[str, float] = field(default_factory=dict)
    uncertainty: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class ShipFile:
    """The whole file.

    Attributes
    ----------
    speed_m_s
        Of the approach.
    scale
        Ship over what the file describes; 1 where it is the ship itself.
    coefficients
        What ``pmm coefficients --json`` printed in SI units, its path from this file.
    coefficients_speed_m_s
        Which carriage speed's values, where there are several.
    """

    speed_m_s: float
    water: Water
    ship: ShipBody
    propeller: Propeller
    rudder: Rudder
    name: str = "ship"
    scale: float = 1.0
    coefficients: str | None = None
    coefficients_speed_m_s: float | None = None
    hull: StatedHull = field(default_factory=StatedHull)

    __pydantic_config__ = STRICT_TABLE


def read_ship(path: Path) -> ShipFile:
    """Read a ship's file; the file that it names lies beside it.

    Raises
    ------
    ConfigurationError
        For unknown keys, wrong types and impossible values: all errors of the file in one message.
    """
    table = read_toml(path)
    faults: list[Fault] = list(limit_faults(table))
    seen = deepcopy(table)
    if isinstance(seen.get("coefficients"), str):
        seen["coefficients"] = str(path.parent / seen["coefficients"])
    found = validate(ShipFile, seen, faults)
    faults += _hull_faults(table.get("hull"))
    if found is None or faults:
        raise as_error(path, faults, table)
    return found


def _hull_faults(hull: Any) -> list[Fault]:
    if not isinstance(hull, dict):
        return []
    faults = []
    if hull.get("system", "mmg") not in SYSTEMS:
        faults.append(Fault(("hull", "system"), f"should be one of {', '.join(SYSTEMS)}"))
    values = hull.get("values", {})
    for part in ("values", "uncertainty"):
        for name in hull.get(part, {}) if isinstance(hull.get(part), dict) else ():
            try:
                term_of(name, Plane.HORIZONTAL)
            except ConfigurationError as error:
                faults.append(Fault(("hull", part, name), f"is no derivative: {error}"))
            if part == "uncertainty" and name not in values:
                faults.append(Fault(("hull", part, name), "has no value in [hull.values]"))
    return faults
