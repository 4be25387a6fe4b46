"""Exact rigs to ask: every arrangement, with hulls that have a term of each kind."""

from itertools import product

import numpy as np

from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.oscillator import Plane
from tests.exact.hull import polynomial
from tests.exact.rig import ExactBody, ExactRig

ARRANGEMENTS = tuple(
    Arrangement(*one)
    for one in product(Joint, Pivot, Gauges, DriftBy)
    if not (one[0] is Joint.YAW_TABLE and one[1] is Pivot.FORE)
)
_HULLS = {
    Plane.HORIZONTAL: {
        "X_udot": -6.0, "X_uu": -5.5, "X_vr": 50.0, "X_vv": -12.0, "X_rr": 4.0,
        "Y_vdot": -110.0, "Y_v": -120.0, "Y_rdot": -3.0, "Y_r": 25.0,
        "Y_vvv": -600.0, "Y_vvr": 80.0, "Y_vrr": -60.0, "Y_rrr": 40.0,
        "N_vdot": -4.0, "N_v": -45.0, "N_rdot": -18.0, "N_r": -30.0,
        "N_vvv": -70.0, "N_vvr": -50.0, "N_vrr": 20.0, "N_rrr": -25.0,
    },
    Plane.VERTICAL: {
        "X_udot": -6.0, "X_uu": -5.5, "X_wq": -50.0, "X_ww": -12.0,
        "Z_wdot": -110.0, "Z_w": -220.0, "Z_qdot": 3.0, "Z_q": -25.0, "Z_w|w|": -400.0,
        "Z_www": -600.0, "Z_wwq": 80.0, "Z_qqq": 40.0,
        "M_wdot": 4.0, "M_w": 45.0, "M_qdot": -18.0, "M_q": -30.0, "M_q|q|": -9.0,
        "M_www": -70.0, "M_wqq": 20.0, "M_qqq": -25.0,
    },
}  # fmt: skip
BODIES = {
    Plane.HORIZONTAL: ExactBody(78.0, 14.0, 0.03, 0.01),
    Plane.VERTICAL: ExactBody(78.0, 14.0, 0.03, 0.02, 75.0, 0.01, -0.015),
}
HULLS = {plane: polynomial(terms) for plane, terms in _HULLS.items()}


def exact_rig(
    plane: Plane,
    arrangement: Arrangement,
    *,
    rotation_rad: float,
    drift_rad: float = 0.0,
    speed_m_s: float = 1.2,
    frequency_hz: float = 0.3,
    sway_m: float = 0.08,
) -> ExactRig:
    """Return a rig that sways (heaves) and turns to some angle, with a little second harmonic."""
    half, turn = 0.5, -1.0 if plane is Plane.VERTICAL else 1.0
    sway, angle = sway_m * np.exp(0.4j), rotation_rad * np.exp(1.7j)
    reach = np.sin if arrangement.joint is Joint.SLIDES_ON_RIG else np.tan
    lever = half * reach(rotation_rad) * np.exp(1.7j) * turn
    struts = arrangement.joint is not Joint.YAW_TABLE
    first = (sway - lever, sway + lever) if struts else (sway, angle)
    coordinates = np.array([[0.0, 0.0], first, [0.004j, 0.002 + 0.001j]])
    return ExactRig(
        coordinates,
        frequency_hz,
        speed_m_s,
        drift_rad,
        plane,
        half,
        arrangement,
        BODIES[plane],
        HULLS[plane],
    )
