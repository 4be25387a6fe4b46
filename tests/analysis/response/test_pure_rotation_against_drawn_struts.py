"""Pure yaw and pitch: the model is drawn between its struts, and its velocity is the points' own.

The oracle is ``tests/exact/drawn_struts.py``: points and distances alone.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.response.pure_rotation import pure_rotation
from hardware.description.arrangement import Joint, Pivot
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line, struts_over_turn
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from tests.exact.drawn_struts import drawn

# Of the speed of the bow, the largest velocity across the model that is left: what the product's
# LEAST_SHARE of each harmonic leaves out. Ten times less would fail for want of harmonics.
IMPURE = 1e-6
# As simple sines with tan(phi / 2) = omega l / U they would leave at 20 degrees: far more.
SINES = 1e-3
FREQUENCY_HZ, POINTS = 0.2, 2048


def struts(lines: tuple[Line, ...], amplitude: float) -> np.ndarray:
    return amplitude * struts_over_turn(lines, least=POINTS)


@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("pivot", list(Pivot))
@pytest.mark.parametrize("plane", [HORIZONTAL_1963, VERTICAL_1963])
@pytest.mark.parametrize(("speed", "amplitude"), [(0.0, 0.2), (0.5, 0.28), (1.2, 0.3), (1.2, 0.01)])
def test_no_drift_and_a_sine_of_the_heading(
    plane: Oscillator, joint: Joint, pivot: Pivot, speed: float, amplitude: float
) -> None:
    oscillator = replace(plane, joint=joint, pivot=pivot)
    moved = struts(pure_rotation(oscillator, FREQUENCY_HZ, speed, amplitude), amplitude)
    assert np.abs(moved).max() == pytest.approx(amplitude, rel=1e-4)
    heading, turning, across = drawn(oscillator, speed, moved, FREQUENCY_HZ)
    bow = oscillator.half_spacing_m * np.abs(turning).max()
    assert np.abs(across).max() < IMPURE * max(bow, speed)
    spectrum = np.abs(np.fft.rfft(turning))
    assert np.delete(spectrum, 1).max() < IMPURE * spectrum[1]
    assert np.abs(heading).max() > 0.2 * amplitude


def test_two_sines_do_drift() -> None:
    amplitude, speed = 0.28, 0.5
    phase = 2.0 * math.atan2(2.0 * math.pi * FREQUENCY_HZ * HORIZONTAL_1963.half_spacing_m, speed)
    moved = struts((Line(1, strut_phase_rad=phase),), amplitude)
    _, turning, across = drawn(HORIZONTAL_1963, speed, moved, FREQUENCY_HZ)
    assert np.abs(across).max() > SINES * HORIZONTAL_1963.half_spacing_m * np.abs(turning).max()


def test_a_small_one_is_two_sines() -> None:
    lines = pure_rotation(HORIZONTAL_1963, FREQUENCY_HZ, 1.2, 1e-4)
    told = 2.0 * math.atan2(2.0 * math.pi * FREQUENCY_HZ * HORIZONTAL_1963.half_spacing_m, 1.2)
    assert lines[0].strut_phase_rad == pytest.approx(told, abs=1e-6)
    assert [line.correction for line in lines] == [False] + [True] * (len(lines) - 1)


def test_more_than_it_can_turn_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="above 57 deg"):
        pure_rotation(HORIZONTAL_1963, 1.0, 0.0, 1.5)
    with pytest.raises(ConfigurationError, match="turntable"):
        pure_rotation(replace(HORIZONTAL_1963, joint=Joint.YAW_TABLE), 1.0, 0.0, 0.1)
