"""Weight less buoyancy of a model below the surface, in pitch, against the exact rig.

The exact rig balances weight at the centre of gravity and buoyancy at its own centre.
"""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.campaign_checks import restoring_pairs
from analysis.coefficients.restoring import restoring_of
from analysis.ideal_rig import weight_matrix
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from tests.analysis.coefficients.exact_campaigns import cycle_of
from tests.analysis.kinematics.exact import body_of
from tests.exact.hull import polynomial
from tests.exact.rig import ExactBody, ExactRig
from tests.exact.run import cycle

PITCH_RAD, HALF_M = 1e-3, 0.5
SUBMERGED = ExactBody(78.0, 14.0, 0.03, 0.02, 75.0, 0.01, -0.05)
NONE = np.zeros((2, 2))


def pitched(body: ExactBody, frequency_hz: float) -> ExactRig:
    """A rig that pitches about the midpoint, in water that asks for nothing but its buoyancy."""
    lift = HALF_M * PITCH_RAD
    coordinates = np.array([[0.0, 0.0], [lift, -lift]], dtype=np.complex128)
    return ExactRig(
        coordinates, frequency_hz, 0.0, 0.0, Plane.VERTICAL, HALF_M, Arrangement(), body,
        polynomial({}),
    )  # fmt: skip


@pytest.mark.parametrize("medium", Medium)
def test_slow_pitch_feels_the_weight_matrix(medium: Medium) -> None:
    body = SUBMERGED if medium is Medium.WATER else replace(SUBMERGED, displaced_kg=0.0)
    aft, fore = cycle(pitched(body, 1e-5), 1)[1, :2]
    moment = HALF_M * (aft - fore)
    held = weight_matrix(body_of(SUBMERGED), Plane.VERTICAL, medium)
    assert held[1, 1] == pytest.approx(float(moment.real) / PITCH_RAD, rel=1e-5)


def test_a_restoring_run_agrees_with_what_its_body_says() -> None:
    slow = cycle_of(pitched(SUBMERGED, 1e-5), "slow", 3)
    one = restoring_of(slow, body_of(SUBMERGED), NONE, NONE)
    assert one.hydrostatic_moment == pytest.approx(one.moment, rel=1e-5)
    assert slow.load_magnitudes[1, 1] == pytest.approx(abs(slow.loads[1]), rel=1e-5)


def test_nothing_is_left_of_the_load_in_phase() -> None:
    """Weight and buoyancy taken off, no restoring remains: hydrostatics are given as none."""
    cycles = [cycle_of(pitched(SUBMERGED, hertz), str(hertz), 3) for hertz in (0.1, 0.15, 0.2, 0.3)]
    pairs = {pair.name: pair.estimates.values for pair in restoring_pairs(cycles)}
    weight = abs(weight_matrix(body_of(SUBMERGED), Plane.VERTICAL, Medium.WATER)[1, 1])
    assert pairs["C55"] == pytest.approx([0.0, 0.0], abs=1e-4 * weight)
