"""Beats that are counted in a record are those of the two oscillations that it was made of."""

import numpy as np
import pytest

from analysis.inertia.beats import count_beats

YAW_S, SWAY_S = 2.2, 2.0


@pytest.mark.parametrize("share", [0.7, 0.85, 1.0])
def test_how_unequal_they_are_widens_the_count(share: float) -> None:
    """By half of ``|a^2 - b^2|/(a^2 + b^2)`` of an oscillation a beat, beside half a one."""
    time_s = np.arange(0.0, 110.0, 0.01)
    record = np.cos(2.0 * np.pi * time_s / YAW_S) + share * np.cos(2.0 * np.pi * time_s / SWAY_S)
    found = count_beats(time_s, record)
    shallow = (1.0 - share**2) / (1.0 + share**2)
    assert found.beats == 4.0
    assert found.counting_error == pytest.approx(0.5 + 0.5 * shallow * found.beats, abs=0.25)
    per_beat = YAW_S * SWAY_S / (YAW_S - SWAY_S) / (0.5 * (YAW_S + SWAY_S))
    assert abs(found.oscillations / found.beats - per_beat) < found.counting_error / found.beats
