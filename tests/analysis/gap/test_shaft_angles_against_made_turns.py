"""A shaft angle made beforehand: how far it goes on each period, and none of its jumps left."""

import math

import numpy as np
import pytest

from analysis.gap.observe.shaft_angle import turns_per_period, unwrapped
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCE_AFT, SHAFT_ANGLE

RATE_HZ, FREQUENCY_HZ = 50.0, 0.8
TURNED = 2.0 * math.pi * FREQUENCY_HZ * np.arange(600) / RATE_HZ
ANGLE = TURNED + 0.02 * np.sin(TURNED)


def recorded(angle: FloatArray) -> Recording:
    return Recording("one", (FORCE_AFT, SHAFT_ANGLE), np.stack((TURNED, angle)), RATE_HZ)


@pytest.mark.parametrize("factor", [1.0, 180.0 / math.pi, 0.5 / math.pi, -1.0])
@pytest.mark.parametrize("turn_rad", [math.inf, 2.0 * math.pi])
@pytest.mark.parametrize("steps", [0.0, 2.0 * math.pi / 60.0])
def test_how_far_it_goes_on(factor: float, turn_rad: float, steps: float) -> None:
    """Wrapped or not, finely read or in steps that are longer than a sample."""
    angle = ANGLE if steps == 0.0 else np.round(ANGLE / steps) * steps
    made = factor * (angle if turn_rad == math.inf else angle % turn_rad)
    assert turns_per_period(recorded(made), FREQUENCY_HZ) == pytest.approx(factor, rel=0.02)


def test_without_an_encoder_nothing_is_known() -> None:
    bare = recorded(ANGLE).select([FORCE_AFT.name])
    assert math.isnan(turns_per_period(bare, FREQUENCY_HZ))
    assert unwrapped(bare) is bare


def test_an_angle_that_begins_anew_goes_on() -> None:
    whole = recorded(ANGLE)
    assert unwrapped(whole) is whole
    found = unwrapped(recorded(ANGLE % (2.0 * math.pi)))
    np.testing.assert_allclose(found.values(SHAFT_ANGLE.name), ANGLE, atol=1e-9)
    np.testing.assert_array_equal(found.values(FORCE_AFT.name), TURNED)
