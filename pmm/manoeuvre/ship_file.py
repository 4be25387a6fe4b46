"""``ship.toml``: a free ship, with derivatives that were measured or are stated."""

from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from analysis.coefficients.normalisation import Normalisation, mmg, prime
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
    rudder
        ``None`` where the rudder's loads are terms of its angle among the derivatives.
    rudder_rate_deg_s
        How fast such a rudder is laid.
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
    rudder: Rudder | None = None
    rudder_rate_deg_s: float | None = None
    name: str = "ship"
    scale: float = 1.0
    coefficients: str | None = None
    coefficients_speed_m_s: float | None = None
    hull: StatedHull = field(default_factory=StatedHull)

    __pydantic_config__ = STRICT_TABLE

    def system_at(self, speed_m_s: float) -> Normalisation:
        """Return the system of the derivatives at a speed."""
        ship, density = self.ship, self.water.density_kg_m3
        if self.hull.system == "mmg":
            return mmg(ship.length_m, ship.draught_m, speed_m_s, density)
        return prime(ship.length_m, speed_m_s, density)


@dataclass(frozen=True)
class BodyTable:
    """A body below the surface, as heavy as its water: about the point of its derivatives.

    Attributes
    ----------
    inertia_kg_m2
        About the transverse axis through that point.
    centre_distance_m
        By which the centre of gravity lies below that of buoyancy.
    """

    length_m: float
    mass_kg: float
    inertia_kg_m2: float
    centre_distance_m: float
    cg_x_m: float = 0.0


@dataclass(frozen=True)
class PlaneTable:
    """A pair of planes: force down and moment, bow up, per radian, in the prime system."""

    force: float
    moment: float


@dataclass(frozen=True)
class SubmergedFile:
    """The whole file of a body below the surface; keys as in :class:`ShipFile`.

    Attributes
    ----------
    plane
        ``"vertical"``.
    planes
        By name: those whose speed of reversal is wanted.
    """

    plane: str
    speed_m_s: float
    water: Water
    body: BodyTable
    name: str = "body"
    scale: float = 1.0
    coefficients: str | None = None
    coefficients_speed_m_s: float | None = None
    hull: StatedHull = field(default_factory=lambda: StatedHull("prime"))
    planes: dict[str, PlaneTable] = field(default_factory=dict)

    __pydantic_config__ = STRICT_TABLE

    def system_at(self, speed_m_s: float) -> Normalisation:
        """Return the prime system at a speed."""
        return prime(self.body.length_m, speed_m_s, self.water.density_kg_m3)


def read_ship(path: Path) -> ShipFile | SubmergedFile:
    """Read a ship's file, or that of a body below the surface (``plane = "vertical"``).

    The file that it names lies beside it.

    Raises
    ------
    ConfigurationError
        For unknown keys, wrong types and impossible values: all errors of the file in one message.
    """
    table = read_toml(path)
    below = "plane" in table
    faults: list[Fault] = list(limit_faults(table))
    resolved_table = deepcopy(table)
    if isinstance(resolved_table.get("coefficients"), str):
        resolved_table["coefficients"] = str(path.parent / resolved_table["coefficients"])
    kind: type[ShipFile | SubmergedFile] = SubmergedFile if below else ShipFile
    ship = validate(kind, resolved_table, faults)
    if below and table["plane"] != Plane.VERTICAL:
        faults.append(Fault(("plane",), "should be vertical, or left out for a ship"))
    if isinstance(ship, ShipFile):
        faults += _rudder_faults(ship)
    plane = Plane.VERTICAL if below else Plane.HORIZONTAL
    faults += _hull_faults(table.get("hull"), plane, ("prime",) if below else SYSTEMS)
    if ship is None or faults:
        raise as_error(path, faults, table)
    return ship


def _rudder_faults(ship: ShipFile) -> list[Fault]:
    if (ship.rudder is None) != (ship.rudder_rate_deg_s is None):
        return []
    return [
        Fault(
            ("rudder",),
            "should be a table with the rudder's parameters, or rudder_rate_deg_s in its place "
            "where its loads are derivatives (Y_d, N_d, X_dd)",
        )
    ]


def _hull_faults(hull: Any, plane: Plane, systems: tuple[str, ...]) -> list[Fault]:
    if not isinstance(hull, dict):
        return []
    faults = []
    if hull.get("system", systems[0]) not in systems:
        faults.append(Fault(("hull", "system"), f"should be one of {', '.join(systems)}"))
    values = hull.get("values", {})
    for part in ("values", "uncertainty"):
        for name in hull.get(part, {}) if isinstance(hull.get(part), dict) else ():
            try:
                term_of(name, plane)
            except ConfigurationError as error:
                faults.append(Fault(("hull", part, name), f"is no derivative: {error}"))
            if part == "uncertainty" and name not in values:
                faults.append(Fault(("hull", part, name), "has no value in [hull.values]"))
    return faults
