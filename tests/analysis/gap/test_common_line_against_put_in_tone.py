"""A tone that is put in beside the harmonics is found at its frequency; noise alone has none."""

from collections.abc import Sequence

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.spectrum import Lines, common_line, quiet_lines

RATE_HZ = 50.0
FREQUENCIES_HZ = (0.4, 0.55, 0.7, 0.9, 1.1)
RMS = 0.1


def lines(tone: float, tone_hz: float, seed: int, periods: int = 10) -> list[Lines]:
    """Return the lines of a record of each frequency, a tone of random phase in all of them."""
    generator, found = np.random.default_rng(seed), []
    for frequency_hz in FREQUENCIES_HZ:
        time_s = np.arange(round(periods / frequency_hz * RATE_HZ)) / RATE_HZ
        phase_rad = generator.uniform(0.0, 2.0 * np.pi)
        values = np.sin(2.0 * np.pi * frequency_hz * time_s)
        values += tone * np.sin(2.0 * np.pi * tone_hz * time_s + phase_rad)
        values += RMS * generator.standard_normal(len(time_s))
        found += quiet_lines(time_s, values[None, :], frequency_hz, 6)
    return found


@given(st.floats(0.25, 2.0), st.integers(0, 1000))
def test_a_tone_is_found_within_a_bin(tone_hz: float, seed: int) -> None:
    found = common_line(lines(0.3, tone_hz, seed))
    assert found == pytest.approx(tone_hz, abs=0.07)  # that of the middle one of the records


@pytest.mark.parametrize("seed", range(20))
def test_noise_alone_has_none(seed: int) -> None:
    assert common_line(lines(0.0, 1.0, seed)) is None


@pytest.mark.parametrize("records", [[], [Lines(np.arange(3.0), np.ones(3))]])
def test_records_without_lines_tell_nothing(records: Sequence[Lines]) -> None:
    assert common_line(records) is None
