"""Structural effects against their describing functions, over frequency, amplitude and phase."""

import numpy as np
import pytest

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect
from sim.effects.s3_coulomb_friction import CoulombFriction
from sim.rig import vertical_rig
from tests.sim.effects.against_theory import mismatch

SET_POINTS = [
    SetPoint(frequency, amplitude, phase)
    for frequency in (0.4, 0.9)
    for amplitude in (0.01, 0.03)
    for phase in (0.0, np.pi / 2.0, np.pi)
]


@pytest.mark.parametrize(("effect", "tolerance"), [(CoulombFriction(), 1e-3)])
def test_signature(effect: Effect, tolerance: float) -> None:
    assert mismatch(effect, vertical_rig().ideal(), SET_POINTS) < tolerance
