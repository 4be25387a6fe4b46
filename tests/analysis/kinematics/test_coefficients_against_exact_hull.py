"""What the kinematics is for: a hull's coefficients from few harmonics of exact gauges.

Each term's load is turned into what the gauges would read of it, at every instant, and the first
harmonics of that are fitted to the gauges' own: nothing is missed, at any angle.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.phasors import interleaved
from analysis.coefficients.terms import term_of, waves_of
from analysis.kinematics.cycle import harmonics
from analysis.kinematics.projection import readings
from analysis.kinematics.rigid_body import Buoyancy, inertia, weight
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.kinematics.exact import body_of, geometry_of, motion_of
from tests.exact.hull import polynomial
from tests.exact.rig import ExactRig
from tests.exact.rigs import ARRANGEMENTS, exact_rig
from tests.exact.run import cycle

ORDERS = 3
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


def campaign(plane: Plane, arrangement: Arrangement) -> list[ExactRig]:
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
    hull = polynomial(HULLS[plane])
    return [replace(one, hull=hull, body=replace(one.body, cg_across_m=0.0)) for one in rigs]


@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda a: "-".join(vars(a).values()))
def test_every_coefficient_comes_back(plane: Plane, arrangement: Arrangement) -> None:
    names = tuple(HULLS[plane])
    terms = [term_of(name, plane) for name in names]
    place = np.eye(3)[:, [term.row for term in terms]]
    design, target = [], []
    for rig in campaign(plane, arrangement):
        moved, geometry = motion_of(rig), geometry_of(rig)
        of_terms = waves_of(terms, moved.velocity[1:], moved.rate[1:])
        per_term = place.T[:, :, None] * of_terms[:, None, :]  # (terms, 3, instants)
        known = inertia(body_of(rig.body), moved, plane)
        if plane is Plane.VERTICAL:
            lift = Buoyancy(75.0, rig.body.buoyancy_x_m, rig.body.buoyancy_across_m)
            known = known + weight(body_of(rig.body), moved, lift)
        design.append(harmonics(-readings(geometry, moved.line_rad, per_term), ORDERS).T)
        own = harmonics(readings(geometry, moved.line_rad, known), ORDERS)
        target.append(interleaved(cycle(rig, ORDERS).ravel()) - own)
    found = np.linalg.lstsq(np.concatenate(design), np.concatenate(target))[0]
    for name, ours, theirs in zip(names, found, HULLS[plane].values(), strict=True):
        assert ours == pytest.approx(theirs, rel=1e-7, abs=1e-7), name
