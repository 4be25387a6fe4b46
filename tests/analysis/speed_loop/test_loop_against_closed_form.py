"""Margins, gains and ripple of a speed loop against closed forms and a search of another kind."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.speed_loop.loop import ShaftLoop
from analysis.speed_loop.tuning import proposed
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Servo, ShuntMotor, SpeedLoop

_FAST = Servo(current_loop_hz=1e6)  # an inertia under a torque that comes at once
_TORQUE = _FAST.constant_n_m_a * _FAST.gear_ratio


@pytest.mark.sample(1)
@pytest.mark.parametrize(("gain", "delay_s"), [(0.1, 0.02), (3.0, 0.005), (20.0, 1e-3)])
def test_margins_of_an_inertia_behind_a_dead_time(gain: float, delay_s: float) -> None:
    """L = w_c exp(-s d) / s: crossover w_c, margins pi/2 - w_c d and pi / (2 w_c d)."""
    crossover = gain * _TORQUE / _FAST.shaft_inertia_kg_m2
    if crossover * delay_s > 1.2:
        gain, crossover = gain / 20.0, crossover / 20.0
    found = ShaftLoop(_FAST, SpeedLoop(gain), delay_s=delay_s).margins
    assert 2.0 * math.pi * found.crossover_hz == pytest.approx(crossover, rel=1e-4)
    assert found.phase_rad == pytest.approx(math.pi / 2.0 - crossover * delay_s, abs=1e-3)
    assert found.gain == pytest.approx(math.pi / (2.0 * crossover * delay_s), rel=1e-3)


@pytest.mark.parametrize(("gain", "integral"), [(0.5, 0.0), (2.0, 10.0), (20.0, 50.0)])
def test_bandwidth_of_two_poles(gain: float, integral: float) -> None:
    """(a s + b) / (s2 + a s + b) is down by 3 dB at w2 = u + sqrt(u2 + b2), u = a2 / 2 + b."""
    a, b = (one * _TORQUE / _FAST.shaft_inertia_kg_m2 for one in (gain, integral))
    u = a * a / 2.0 + b
    expected = math.sqrt(u + math.sqrt(u * u + b * b))
    found = ShaftLoop(_FAST, SpeedLoop(gain, integral)).bandwidth_hz
    assert 2.0 * math.pi * found == pytest.approx(expected, rel=3e-3)  # 3 dB are no 1 / sqrt 2


@pytest.mark.parametrize("motor", [Servo(), Servo(bearing_n_m_s=0.5), ShuntMotor()])
@pytest.mark.parametrize("delay_s", [0.0, 0.002])
def test_proposed_gains_are_the_boldest_that_keep_clear(
    motor: Servo | ShuntMotor, delay_s: float
) -> None:
    """No pair of a coarse grid has more integral action within the same circles."""
    most, omega = 1.4, np.logspace(-1.0, 4.5, 4000)
    best = proposed(motor, (0.0, 0.3), delay_s, most)

    def largest(gains: SpeedLoop) -> float:
        worst = 0.0
        for added in (0.0, 0.3):
            loop = ShaftLoop(motor, gains, added, delay_s)
            if not loop.stable:
                return math.inf
            response = loop.open_response(omega)
            worst = max(
                worst, *np.abs([1.0 / (1.0 + response), response / (1.0 + response)]).max(axis=1)
            )
        return worst

    assert largest(best) <= most * 1.001
    assert largest(SpeedLoop(best.proportional, 1.05 * best.integral)) > most
    for share in (0.25, 0.5, 0.8, 1.25, 2.0):
        bolder = SpeedLoop(share * best.proportional, 1.1 * best.integral)
        assert largest(bolder) > most


def test_gains_that_cannot_be_are_refused() -> None:
    """One sentence each."""
    with pytest.raises(ConfigurationError, match=r"has to be above 1; 1\.4 is usual"):
        proposed(Servo(), most=1.0)
    with pytest.raises(ConfigurationError, match=r"no gains keep a largest sensitivity of 1\.4"):
        proposed(Servo(bearing_n_m_s=-1.0))


def test_ripple_of_a_load_twice_a_turn_against_integration() -> None:
    """A shaft under T sin 2 theta, integrated with its loop and its current's lag."""
    motor, torque, omega = Servo(), 2.0, 2.0 * math.pi * 0.8
    inertia, rate = motor.shaft_inertia_kg_m2, 2.0 * math.pi * motor.current_loop_hz
    scale = motor.constant_n_m_a * motor.gear_ratio

    def slope(t: float, y: np.ndarray) -> list[float]:
        angle, speed, current = y
        wanted = -motor.loop.proportional * speed - motor.loop.integral * angle
        load = torque * math.sin(2.0 * (omega * t + angle))
        return [speed, (scale * current - load) / inertia, rate * (wanted - current)]

    turn = 2.0 * math.pi / omega
    times = 12.0 * turn + turn * np.arange(256) / 256.0
    found = solve_ivp(slope, (0.0, times[-1]), np.zeros(3), "LSODA", times, rtol=1e-9, atol=1e-12)
    second = 2.0 * np.fft.rfft(found.y[1])[2] / 256.0 / omega
    told = ShaftLoop(motor, motor.loop).ripple(np.array([0.0, -1j * torque]), omega)[1]
    assert abs(second - told) < 0.02 * abs(second)  # the deviation turns the load's own phase
    assert 0.001 < abs(second) < 0.05
