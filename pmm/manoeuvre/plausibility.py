"""Numbers of a ship's file that cannot be those of a ship: units, factors, signs."""

import math
from collections.abc import Iterator, Mapping
from typing import Final

from analysis.bounds import Bound
from analysis.manoeuvring.depth import SubmergedBody
from analysis.manoeuvring.ship import Ship
from analysis.water import froude_number
from pmm.manoeuvre.ship_file import ShipFile, SubmergedFile

_ABOVE: Final = 1e-9  # a sign is wanted, no size
_SIZES: Final = "are length_m, draught_m and mass_kg in m and kg, of what the file describes?"
_INERTIA: Final = "inertia_kg_m2 is in kg m2 about the point of the derivatives, not about a gauge"
_ADDED: Final = (
    "an added mass is minus the derivative, which is below 0; is it in the system that hull.system "
    "says, and without the ship's own mass?"
)
_DAMPING: Final = (
    "the water resists sway and yaw: derivatives are those of the load on the hull, y to starboard "
    "and r to starboard positive"
)
_ITTC: Final = "ITTC 7.5-02-06-01: typically 0.25"

SHIP: Final = {
    one.name: one
    for one in (
        Bound("Fn", 0.02, 0.6, "ships that displace their weight",
              "are speed_m_s and length_m both the model's or both the ship's, in m/s and m?"),
        Bound("L/d", 4.0, 80.0, "tugs to barges", _SIZES),
        Bound("m/(rho/2 L² d)", 0.05, 0.6, "2 C_b B/L: slender ships to tugs", _SIZES),
        Bound("sqrt(I_z/m)/L", 0.18, 0.35, _ITTC, _INERTIA),
        Bound("x_G/L", -0.15, 0.15, "near midships", "cg_x_m is ahead of the derivatives' point"),
        Bound("D_P/d", 0.15, 1.2, "propellers below the surface",
              "are propeller.diameter_m and draught_m in m?"),
        Bound("rudder's rate at full scale in °/s", 1.5, 15.0, "SOLAS II-1/29: 2.3 or faster",
              "the rate is that of what the file describes: of a model sqrt(scale) times the "
              "ship's"),
        Bound("-X_udot/m", 0.0, 0.35, "slender bodies: 0.02 to 0.15", _ADDED),
        Bound("-Y_vdot/m", 0.15, 4.0, "0.7 to 1 in deep water, up to 4 in shallow", _ADDED),
        Bound("-N_rdot/I_z", 0.1, 4.0, "0.5 to 1 in deep water, up to 4 in shallow", _ADDED),
        Bound("-Y_v", _ABOVE, math.inf, "damping", _DAMPING),
        Bound("-N_r", _ABOVE, math.inf, "damping", _DAMPING),
    )
}  # fmt: skip
"""What is believed of a ship. A limit of half or twice its size lets as large a factor pass, or
doubts tugs, barges and ships in shallow water; units are off by a thousand."""

BODY: Final = {
    one.name: one
    for one in (
        Bound("m/(rho/2 L³)", 0.002, 0.1, "bodies 4 to 20 times as long as thick",
              "are length_m and mass_kg in m and kg?"),
        Bound("sqrt(I_y/m)/L", 0.18, 0.35, _ITTC, _INERTIA),
        Bound("x_G/L", -0.15, 0.15, "near the middle", "cg_x_m is ahead of the derivatives' point"),
        Bound("-Z_wdot/m", 0.15, 4.0, "0.7 to 1 for slender bodies", _ADDED),
        Bound("-M_qdot/I_y", 0.1, 4.0, "0.5 to 1 for slender bodies", _ADDED),
        Bound("-Z_w", _ABOVE, math.inf, "damping", _DAMPING),
        Bound("-M_q", _ABOVE, math.inf, "damping", _DAMPING),
    )
}  # fmt: skip


def doubts_of_ship(file: ShipFile, ship: Ship) -> tuple[str, ...]:
    """Return a sentence on each number of a ship that is not believed."""
    own, hull = file.ship, ship.hull
    ideal = 0.5 * hull.density_kg_m3 * own.length_m**2 * own.draught_m

    def added(name: str) -> float:
        return -float(hull.added(name)[0])

    values = {
        "Fn": froude_number(file.speed_m_s, own.length_m),
        "L/d": own.length_m / own.draught_m,
        "m/(rho/2 L² d)": own.mass_kg / ideal,
        "sqrt(I_z/m)/L": math.sqrt(own.inertia_kg_m2 / own.mass_kg) / own.length_m,
        "x_G/L": own.cg_x_m / own.length_m,
        "D_P/d": file.propeller.diameter_m / own.draught_m,
        "rudder's rate at full scale in °/s": ship.rudder_rate_deg_s / math.sqrt(file.scale),
        "-X_udot/m": added("X_udot") / own.mass_kg,
        "-Y_vdot/m": added("Y_vdot") / own.mass_kg,
        "-N_rdot/I_z": added("N_rdot") / own.inertia_kg_m2,
        "-Y_v": -float(hull.values["Y_v"][0]),
        "-N_r": -float(hull.values["N_r"][0]),
    }
    return tuple(_doubts(SHIP, values))


def doubts_of_body(file: SubmergedFile, body: SubmergedBody) -> tuple[str, ...]:
    """Return a sentence on each number of a body below the surface that is not believed."""
    own = file.body
    unit = 0.5 * body.density_kg_m3 * own.length_m**3
    first = {name: float(values[0]) for name, values in body.values.items()}
    values = {
        "m/(rho/2 L³)": own.mass_kg / unit,
        "sqrt(I_y/m)/L": math.sqrt(own.inertia_kg_m2 / own.mass_kg) / own.length_m,
        "x_G/L": own.cg_x_m / own.length_m,
        "-Z_wdot/m": -first["Z_wdot"] * unit / own.mass_kg,
        "-M_qdot/I_y": -first["M_qdot"] * unit * own.length_m**2 / own.inertia_kg_m2,
        "-Z_w": -first["Z_w"],
        "-M_q": -first["M_q"],
    }
    return tuple(_doubts(BODY, values))


def _doubts(bounds: Mapping[str, Bound], values: Mapping[str, float]) -> Iterator[str]:
    for name, bound in bounds.items():
        if (doubt := bound.doubt(values[name])) is not None:
            yield doubt
