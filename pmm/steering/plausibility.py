"""Parameters of propeller and rudder that cannot be those of a ship."""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from analysis.bounds import Bound, doubts_of, named
from analysis.steering.identification import SteeringParameters
from analysis.steering.observations import Particulars, SteeringRuns

_LOADS: Final = "are force_x (ahead), thrust (ahead) and normal force in N, with these signs?"
_LATERAL: Final = (
    "are the struts' forces (to starboard), rudder angle (to turn to starboard) and normal force "
    "(to port) in N and degrees or radians as stated, with these signs?"
)
_PLACES: Final = (
    "are rudder.x_m and the struts' half_spacing_m in m, and aft and fore not exchanged?"
)
_PROPELLER: Final = (
    "are revolutions in 1/s (not in rpm), thrust in N, and propeller.diameter_m and thrust (K_T) "
    "those of this model?"
)
_RUDDER: Final = (
    "are rudder.area_m2, height_m and slope (f_alpha) those of this model, in m and m2, and is "
    "the rudder angle positive to turn to starboard?"
)
_RATE: Final = (
    "are revolutions in 1/s? Give rpm / 60 as revolutions_hz, or the unit rpm of the channel "
    "revolutions; is propeller.diameter_m in m?"
)
_ANGLE: Final = "is rudder_angle_deg in degrees, and the channel rudder_angle in its unit?"
_INTERVAL: Final = 2.0  # standard uncertainties: what a few runs hardly tell is not doubted
BOUNDS: Final = named(
    Bound("1-t_P", 0.55, 1.05, "published: 0.78 and 0.79", _LOADS),
    Bound("w_P0", -0.1, 0.65, "published: 0.40 and 0.36", _PROPELLER),
    Bound("t_R", -0.1, 0.8, "published: 0.39 and 0.26", _LOADS),
    Bound("a_H", -0.1, 0.8, "published: 0.31 and 0.36", _LATERAL),
    Bound("x_H'", -0.6, 0.0, "within the afterbody; published: -0.46 and -0.44", _PLACES),
    Bound("epsilon", 0.5, 1.6, "published: 1.09 and 0.96", _RUDDER),
    Bound("kappa", 0.1, 1.2, "published: 0.50 and 0.63", _PROPELLER),
    Bound("gamma_R+", 0.1, 1.1, "published: 0.64 and 0.49", _LATERAL),
    Bound("gamma_R-", 0.1, 1.1, "published: 0.40 and 0.34", _LATERAL),
    Bound("l_R'", -1.6, -0.3, "published: -0.71 and -0.76", _PLACES),
    Bound("delta_0", -0.1, 0.1, "radians; rudders are set to a degree or two",
          "was the rudder amidships in the zero runs, and is its angle in degrees or radians?"),
)  # fmt: skip
"""What is believed of each parameter, around those published of KVLCC2 (Yasukawa and Yoshimura
2015) and KCS (Yoshimura, Ueno and Tsukada 2008). Limits half as far would doubt other ships'; twice
as far they let a rudder pass that is measured in the wrong unit of length."""


OF_RUNS: Final = named(
    Bound("U/(n D_P)", 0.05, 3.0, "advance without wake, bollard pull to windmilling", _RATE),
    Bound("largest rudder angle in °", 2.0, 60.0, "what rudders are laid to", _ANGLE),
)  # fmt: skip
"""The same of what the runs state, at the median rate; rpm and degrees are off by 60 and 57."""

OF_FIT: Final = named(
    Bound("misfit of the loads", 0.0, 20.0, "1 where the equations describe the runs", _LOADS),
    Bound("misfit of the inflow", 0.0, 20.0, "1 where the equations describe the runs",
          "are drift (bow to starboard), turn rate and rudder angle in their units, with these "
          "signs?"),
)  # fmt: skip
"""What the fits leave over, times scatter. A drift with the other sign left 293 and a thrust 5264
in made-up campaigns, which 10 and 40 would tell too; how much real runs leave is not known."""

_SIGNS: Final = {
    "force_x is not positive ahead": {"1-t_P", "1-t_R"},
    "propeller_thrust is not positive ahead": {"1-t_P"},
    "rudder_angle is not positive to turn to starboard": {"1-t_R", "epsilon"},
    "rudder_normal_force is not positive to port": {"1-t_R", "1+a_H", "epsilon", "gamma_R"},
    "rudder_angle and rudder_normal_force are those of a rudder that is positive to port": {
        "1+a_H",
        "gamma_R",
    },
    "the struts' forces are not positive to starboard": {"1+a_H"},
    "drift is not positive with the bow to starboard": {"gamma_R"},
}
"""Factors of the equations, above 0 on every ship, that are below 0 where one sign is turned."""


def doubts(
    parameters: SteeringParameters, runs: SteeringRuns, particulars: Particulars
) -> Iterator[str]:
    """Yield a sentence on each number of the runs and each parameter that is not believed.

    Where parameters are what one turned sign makes of a ship's, that sign is named alone: what is
    beyond its bounds follows from it.
    """
    pace = np.median(runs.speed_m_s / runs.rate_hz) / particulars.diameter_m
    largest = math.degrees(np.abs(runs.rudder_rad).max())
    yield from doubts_of(OF_RUNS, dict(zip(OF_RUNS, (float(pace), largest), strict=True)))
    if (sign := _turned_sign(parameters)) is not None:
        yield sign
        return
    half = _INTERVAL * parameters.standard_uncertainty
    for name, value, width in zip(
        parameters.names, parameters.values.tolist(), half.tolist(), strict=True
    ):
        if (doubt := BOUNDS[name].doubt(value, width)) is not None:
            yield doubt
    left = dict(zip(OF_FIT, parameters.misfit, strict=True))
    yield from doubts_of(OF_FIT, {name: one for name, one in left.items() if math.isfinite(one)})


def _turned_sign(parameters: SteeringParameters) -> str | None:
    """Return the sentence on the sign that turns just those factors that are below 0."""
    factors = {
        "1-t_P": parameters["1-t_P"],
        "1-t_R": 1.0 - parameters["t_R"],
        "1+a_H": 1.0 + parameters["a_H"],
    }
    factors |= {name: parameters[name] for name in parameters.names if name == "epsilon"}
    factors |= {
        name[:7]: parameters[name] for name in parameters.names if name.startswith("gamma_R")
    }
    below = {name for name, value in factors.items() if value < 0.0}
    likely = [sign for sign, turns in _SIGNS.items() if below and turns & factors.keys() == below]
    if not likely:
        return None
    return f"{', '.join(sorted(below))} below 0, as where {', or '.join(likely)}: turn that sign"
