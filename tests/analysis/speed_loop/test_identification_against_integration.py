"""A loop found from a record that another integrator made, rounded to an encoder's steps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.speed_loop.identification import SpeedRecord, identified
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Servo, SpeedLoop

_STEP_RAD = 2.0 * math.pi / 40000.0
_SLOW, _FAST, _RAMP = 2.0, 6.5, 6.0  # rad/s, rad/s2


def _integrated(
    inertia: float, gain: float, integral: float, bearing: float, late_s: float
) -> SpeedRecord:
    """Return a record of J w' = i - b w, i' = (k_p e' + k_i e - i) / T, from settled on."""
    changes = ((1.0, _FAST), (4.5, _SLOW))
    empty = SpeedRecord(np.arange(0.0, 8.0, 0.01), np.zeros(800), _SLOW, changes, _RAMP)
    ramp_s = (_FAST - _SLOW) / _RAMP
    corners = [1.0, 1.0 + ramp_s, 4.5, 4.5 + ramp_s]
    jumps = [_RAMP, -_RAMP, -_RAMP, _RAMP]
    rate = 2.0 * math.pi * 200.0

    def slope(t: float, y: np.ndarray) -> list[float]:
        since = [max(t - late_s - one, 0.0) for one in corners]
        told = _SLOW + sum(jump * one for jump, one in zip(jumps, since, strict=True))
        way = _SLOW * t + sum(jump * one**2 / 2.0 for jump, one in zip(jumps, since, strict=True))
        angle, speed, torque = y
        wanted = gain * (told - speed) + integral * (way - angle)
        return [speed, (torque - bearing * speed) / inertia, rate * (wanted - torque)]

    start = np.array([-bearing * _SLOW / integral, _SLOW, bearing * _SLOW])
    found = solve_ivp(
        slope, (0.0, 8.0), start, "LSODA", empty.time_s, rtol=1e-9, atol=1e-11, max_step=0.01
    )
    return replace(empty, angle_rad=np.round(found.y[0] / _STEP_RAD) * _STEP_RAD)


@pytest.mark.parametrize(
    ("inertia", "gain", "bearing", "late_s"),
    [(1.35, 28.8, 0.3, 0.013), (0.7, 32.0, 0.8, 0.004)],
)
def test_what_was_put_in_is_found(
    inertia: float, gain: float, bearing: float, late_s: float
) -> None:
    """Within four standard uncertainties, and these are small."""
    motor = Servo(loop=SpeedLoop(2.0, 10.0))  # 32 N m s/rad and 160 N m/rad at the shaft
    found = identified(_integrated(inertia, gain, 160.0, bearing, late_s), motor)
    assert found.proportional is not None
    for estimate, true, near in (
        (found.inertia, inertia, 0.01),
        (found.proportional, gain / 16.0, 0.01),
        (found.bearing, bearing, 0.05),
        (found.latency_s, late_s, 1e-3),
    ):
        assert abs(estimate.value - true) < 4.0 * estimate.uncertainty
        assert estimate.uncertainty < near
    assert found.noise_rad < _STEP_RAD


def test_records_that_tell_nothing_are_refused() -> None:
    """Too short, without a change, or with ramps that do not show."""
    record = _integrated(1.0, 32.0, 160.0, 0.0, 0.0)
    short = replace(record, time_s=record.time_s[:20], angle_rad=record.angle_rad[:20])
    for one in (short, replace(record, changes=())):
        with pytest.raises(ConfigurationError, match="50 samples with one change at least"):
            identified(one, Servo())
    noise = np.random.default_rng(1).normal(0.0, 0.05, 800)
    with pytest.raises(ConfigurationError, match="change the speed by more"):
        identified(replace(record, angle_rad=record.angle_rad + noise), Servo())
