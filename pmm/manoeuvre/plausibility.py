"""Numbers of a ship's file that cannot be those of a ship: units, factors, signs."""

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

import numpy as np

from analysis.bounds import Bound, doubts_of, named
from analysis.coefficients.terms import letter_of, term_of
from analysis.manoeuvring.depth import SubmergedBody
from analysis.manoeuvring.manoeuvres import TurningCircle
from analysis.manoeuvring.ship import Ship, U
from analysis.water import froude_number
from hardware.description.oscillator import Plane
from pmm.manoeuvre.ship_file import ShipFile, SubmergedFile

_SMALL_RAD: Final = 1e-3
_SIZES: Final = "are length_m, draught_m and mass_kg in m and kg, of what the file describes?"
_INERTIA: Final = "inertia_kg_m2 is in kg m2 about the point of the derivatives, not about a gauge"
_ADDED: Final = (
    "an added mass is minus the derivative, which is below 0; is it in the system that hull.system "
    "says, and without the ship's own mass?"
)
_DAMPING: Final = (
    "derivatives are those of the water's load on the hull, y and r to starboard positive, per "
    "radian and in the system that hull.system says: the water resists sway and yaw and turns the "
    "bow further into a drift (but for a barge with skegs)"
)
_PITCHING: Final = (
    "derivatives are those of the water's load on the body, z down and q bow up positive, per "
    "radian and in the prime system"
)
_MASS: Final = (
    "is it of the water alone? Tables that print Y_r - m U and N_r - m x_G U (of a submerged body "
    "Z_q + m U, M_q - m x_G U) hold the mass: take it out of both"
)
_HELM: Final = (
    "a positive rudder angle turns to starboard, the force on it to port and its moment to "
    "starboard: turn the signs of a rudder that is positive to port; are angles in radians, areas "
    "in m2, and is the rudder aft?"
)
_ITTC: Final = "ITTC 7.5-02-06-01: typically 0.25"

SHIP: Final = named(
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
    Bound("Y_v over Inoue's", 0.25, 8.0, "-(π k/2 + 0.7 m'): ships 0.7 to 1", _DAMPING),
    Bound("N_v over Inoue's", 0.0, 6.0, "-k: ships 0.6 to 1.2", _DAMPING),
    Bound("N_r over Inoue's", 0.15, 6.0, "-(0.54 k - k²): ships 0.9 to 1.1", _DAMPING),
    Bound("Y_r/m", -0.4, 1.0, "ships 0 to 0.4, with their mass in it -1 to -0.6", _MASS),
    Bound("-Y_d/(rho/2 L d U²)", 0.005, 0.3, "rudders of L d/80 to L d/30: 0.03 to 0.12",
          _HELM),
    Bound("rudder's lever N_d/(-Y_d L)", 0.3, 0.7, "at the stern", _HELM),
    Bound("rudder's lever_relative", -1.6, -0.3, "-0.7 to -1.1 of ships, aft of midships",
          "l_R' counts ahead from midships; some papers print it without its sign"),
    Bound("H_R/d", 0.2, 1.05, "rudders below the surface",
          "are rudder.height_m and draught_m in m, of one size?"),
)  # fmt: skip
"""What is believed of a ship, with k = 2 d/L and m' = m/(rho/2 L² d): the derivatives' sizes are
those of Inoue, Hirano and Kijima 1981, of deep water, and several times as large in shallow water.
A limit of half or twice its size lets as large a factor pass, or doubts tugs, barges and ships in
shallow water; a wrong system is off by L/d, degrees by 57, units by a thousand."""

_TURNED: Final = "are all terms there, and within the angles and rates at which they were measured?"
TURN: Final = named(
    Bound("steady diameter/L", 1.0, 30.0, "ships 2 to 5, with pods less", _TURNED),
    Bound("steady drift in °", 0.0, 35.0, "ships 5 to 25", _TURNED),
)  # fmt: skip
"""What is believed of a steady turn at 35 degrees of rudder."""

BODY: Final = named(
    Bound("m/(rho/2 L³)", 0.002, 0.1, "bodies 4 to 20 times as long as thick",
          "are length_m and mass_kg in m and kg?"),
    Bound("sqrt(I_y/m)/L", 0.18, 0.35, "slender bodies: some 0.25", _INERTIA),
    Bound("x_G/L", -0.15, 0.15, "near the middle", "cg_x_m is ahead of the derivatives' point"),
    Bound("-Z_wdot/m", 0.15, 4.0, "0.7 to 1 for slender bodies", _ADDED),
    Bound("-M_qdot/I_y", 0.1, 4.0, "0.5 to 1 for slender bodies", _ADDED),
    Bound("-Z_w/m", 0.1, 20.0, "bare bodies 0.3, with sail and planes to 4", _PITCHING),
    Bound("-M_q/m", 0.02, 5.0, "bodies 0.1 to 1", _PITCHING),
    Bound("lever M_w/(-Z_w L)", -0.3, 3.0, "bare bodies to 2, with planes 0.5", _PITCHING),
    Bound("-Z_q/m", -0.4, 2.5, "bodies 0.1 to 2, with their mass in it -0.9 to -0.5", _MASS),
)  # fmt: skip
"""The same of a body below the surface; DARPA's SUBOFF, bare and appended, lies within."""


def doubts_of_ship(file: ShipFile, ship: Ship) -> tuple[str, ...]:
    """Return a sentence on each number of a ship that is not believed."""
    particulars, hull = file.ship, ship.hull
    ideal = 0.5 * hull.density_kg_m3 * particulars.length_m**2 * particulars.draught_m
    mass, k = particulars.mass_kg / ideal, 2.0 * particulars.draught_m / particulars.length_m
    force, moment = _by_rudder(ship)

    def first(name: str) -> float:
        """Return a derivative over rho/2 L d U²."""
        return (
            float(hull.values[name][0])
            * hull.area_m2
            / (particulars.length_m * particulars.draught_m)
        )

    def added(name: str) -> float:
        return -float(hull.added(name)[0])

    values = {
        "Fn": froude_number(file.speed_m_s, particulars.length_m),
        "L/d": particulars.length_m / particulars.draught_m,
        "m/(rho/2 L² d)": mass,
        "sqrt(I_z/m)/L": math.sqrt(particulars.inertia_kg_m2 / particulars.mass_kg)
        / particulars.length_m,
        "x_G/L": particulars.cg_x_m / particulars.length_m,
        "D_P/d": file.propeller.diameter_m / particulars.draught_m,
        "rudder's rate at full scale in °/s": ship.rudder_rate_deg_s / math.sqrt(file.scale),
        "-X_udot/m": added("X_udot") / particulars.mass_kg,
        "-Y_vdot/m": added("Y_vdot") / particulars.mass_kg,
        "-N_rdot/I_z": added("N_rdot") / particulars.inertia_kg_m2,
        "Y_v over Inoue's": -first("Y_v") / (0.5 * math.pi * k + 0.7 * mass),
        "N_v over Inoue's": -first("N_v") / k,
        "N_r over Inoue's": -first("N_r") / (0.54 * k - k**2),
        "Y_r/m": first("Y_r") / mass,
        "-Y_d/(rho/2 L d U²)": -force / (ideal / particulars.length_m * file.speed_m_s**2),
        "rudder's lever N_d/(-Y_d L)": _ratio(moment, -force) / particulars.length_m,
    }
    if file.rudder is not None:
        values["H_R/d"] = file.rudder.height_m / particulars.draught_m
        values["rudder's lever_relative"] = file.rudder.lever_relative
    return (*doubts_of(SHIP, values), *_one_sided_terms(hull.values))


def doubts_of_turns(turns: Mapping[str, TurningCircle]) -> tuple[str, ...]:
    """Return a sentence on each steady turn that no ship makes; of none where it does not turn."""
    return tuple(
        f"turning circle to {side}: {doubt}"
        for side, turn in turns.items()
        if math.isfinite(turn.steady_diameter[0])
        for doubt in doubts_of(
            TURN,
            {
                "steady diameter/L": float(turn.steady_diameter[0]),
                "steady drift in °": math.degrees(abs(float(turn.steady_drift_rad[0]))),
            },
        )
    )


def _one_sided_terms(names: Iterable[str]) -> Iterator[str]:
    """Yield a sentence on a load that is curved in the drift and in nothing that turns."""
    terms = {name: term_of(name, Plane.HORIZONTAL) for name in names}
    for row, load in enumerate("YN"):
        curved = {
            name: {letter_of(factor) for factor in term.factors}
            for name, term in terms.items()
            if term.row == row and term.degree > 1 and not term.rates
        }
        of_drift = [name for name, letters in curved.items() if letters == {"v"}]
        if of_drift and not any("r" in of and of <= {"v", "r"} for of in curved.values()):
            yield (
                f"{load} has {', '.join(of_drift)} and no term that is curved in r ({load}_vvr, "
                f"{load}_vrr, {load}_rrr, or with |r|): they are taken as 0, and a turn comes out "
                "too tight; run yaw at larger amplitudes and with drift, or state them in "
                "[hull.values]"
            )


def doubts_of_body(file: SubmergedFile, body: SubmergedBody) -> tuple[str, ...]:
    """Return a sentence on each number of a body below the surface that is not believed."""
    particulars = file.body
    unit = 0.5 * body.density_kg_m3 * particulars.length_m**3
    mass = particulars.mass_kg / unit
    first = {name: float(values[0]) for name, values in body.values.items()}
    values = {
        "m/(rho/2 L³)": mass,
        "sqrt(I_y/m)/L": math.sqrt(particulars.inertia_kg_m2 / particulars.mass_kg)
        / particulars.length_m,
        "x_G/L": particulars.cg_x_m / particulars.length_m,
        "-Z_wdot/m": -first["Z_wdot"] / mass,
        "-M_qdot/I_y": -first["M_qdot"]
        * unit
        * particulars.length_m**2
        / particulars.inertia_kg_m2,
        "-Z_w/m": -first["Z_w"] / mass,
        "-M_q/m": -first["M_q"] / mass,
        "lever M_w/(-Z_w L)": _ratio(first["M_w"], -first["Z_w"]),
        "-Z_q/m": -first["Z_q"] / mass,
    }
    return tuple(doubts_of(BODY, values))


def _ratio(numerator: float, denominator: float) -> float:
    return numerator / denominator if denominator else math.nan


def _by_rudder(ship: Ship) -> tuple[float, float]:
    """Return side force (N) and moment (N m) per radian of rudder on straight course."""
    state = np.zeros((6, ship.count))
    state[U] = ship.approach_m_s
    ends = [ship.loads(state, np.full(ship.count, sign * _SMALL_RAD)) for sign in (1.0, -1.0)]
    _, force, moment = ((ends[0] - ends[1])[:, 0] / (2.0 * _SMALL_RAD)).tolist()
    return force, moment
