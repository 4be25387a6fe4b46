"""Campaigns of exact rigs, and their cycles as a resolver without noise would read them."""

import math
from dataclasses import replace

import numpy as np

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle
from hardware.description.arrangement import Arrangement
from hardware.description.channels import DISPLACEMENTS, FORCE_X, FORCES
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint
from tests.analysis.kinematics.exact import body_of
from tests.exact.hull import polynomial
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig
from tests.exact.run import cycle as gauges

RUNS = (
    (0.0, 0.12, 0.25, 0.0),
    (0.4, 0.0, 0.2, 0.0),
    (0.3, 0.1, 0.3, 0.1),
    (0.4, 0.05, 0.15, -0.15),
)
HULLS = {
    Plane.HORIZONTAL: {
        "X_0": -8.0, "X_vr": 50.0, "X_vv": -12.0, "X_rr": 4.0,
        "Y_vdot": -110.0, "Y_v": -120.0, "Y_rdot": -3.0, "Y_r": 25.0,
        "Y_vvv": -600.0, "Y_vvr": 80.0, "Y_vrr": -60.0, "Y_rrr": 40.0,
        "N_vdot": -4.0, "N_v": -45.0, "N_rdot": -18.0, "N_r": -30.0,
        "N_vvv": -70.0, "N_vvr": -50.0, "N_vrr": 20.0, "N_rrr": -25.0,
    },
    Plane.VERTICAL: {
        "X_0": -8.0, "X_wq": -50.0, "X_ww": -12.0,
        "Z_wdot": -110.0, "Z_w": -220.0, "Z_qdot": 3.0, "Z_q": -25.0,
        "Z_www": -600.0, "Z_wwq": 80.0, "Z_wqq": 30.0, "Z_qqq": 40.0,
        "M_wdot": 4.0, "M_w": 45.0, "M_qdot": -18.0, "M_q": -30.0,
        "M_www": -70.0, "M_wwq": 10.0, "M_wqq": 20.0, "M_qqq": -25.0,
    },
}  # fmt: skip

RESTORING = {
    Plane.HORIZONTAL: np.zeros((2, 2)),
    Plane.VERTICAL: np.array([[5600.0, 300.0], [250.0, 1900.0]]),  # of a surface ship
}


def campaign(plane: Plane, arrangement: Arrangement, *, floats: bool = True) -> list[ExactRig]:
    """Return sway, yaw and both, with drift, to 23 degrees (15 with pitch)."""
    largest = math.radians(15.0 if plane is Plane.VERTICAL else 25.0)
    rigs = [
        exact_rig(
            plane,
            arrangement,
            rotation_rad=min(turn, largest),
            drift_rad=drift,
            sway_m=sway,
            frequency_hz=hertz,
        )
        for turn, sway, hertz, drift in RUNS
    ]
    return [(afloat if floats else under_water)(one) for one in rigs]


def afloat(rig: ExactRig) -> ExactRig:
    """Return a rig with the plane's hull, that floats."""
    hull, restoring = polynomial(HULLS[rig.plane]), RESTORING[rig.plane]
    return replace(rig, hull=hull, body=rig.body.afloat(), restoring=restoring)


def under_water(rig: ExactRig) -> ExactRig:
    """Return a rig with the plane's hull, heavier than the water that it displaces."""
    return replace(rig, hull=polynomial(HULLS[rig.plane]))


def struts_of(rig: ExactRig, name: str, orders: int) -> StrutCycle:
    """Return the harmonics of displacements and gauges, tared, with nothing uncertain."""
    moved = np.zeros((orders + 1, 2), dtype=complex)
    moved[: len(rig.coordinates)] = rig.coordinates
    whole = np.concatenate((moved, gauges(rig, orders, tared=True)), axis=1)
    channels = (*DISPLACEMENTS, *FORCES, FORCE_X.name)
    units = ("m", "m", "N", "N", "N") * (orders + 1)
    phasors = Phasors.of(labels(channels, orders), units, whole.ravel())
    of_plane = VERTICAL_1963 if rig.plane is Plane.VERTICAL else HORIZONTAL_1963
    oscillator = replace(of_plane, half_spacing_m=rig.half_spacing_m, **vars(rig.arrangement))
    point = SetPoint(rig.frequency_hz, 0.1, 0.0, rig.speed_m_s, drift_rad=rig.drift_rad)
    hertz = rig.frequency_hz
    return StrutCycle(name, oscillator, point, hertz, phasors, orders, mean_known=True)


def cycle_of(rig: ExactRig, name: str, orders: int) -> BodyCycle:
    """Return a rig's cycle with its body and restoring to be taken off."""
    return less_known(struts_of(rig, name, orders), rig)


def less_known(struts: StrutCycle, rig: ExactRig) -> BodyCycle:
    """Return the cycle in body axes, with what is known of the rig to be taken off."""
    return struts.model().without(body_of(rig.body), rig.restoring)
