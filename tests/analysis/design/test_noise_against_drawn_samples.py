"""The scatter that is expected of harmonics against least squares of drawn noise."""

import numpy as np
import pytest

from analysis.design.noise import Noise

RATE_HZ, FREQUENCY_HZ, PERIODS, RECORDS = 20.0, 0.4, 4, 1500


def _drawn(corner_hz: float) -> np.ndarray:
    """Records of noise whose density rises below the corner, of a span four times as long."""
    generator = np.random.default_rng(1963)
    count = int(RATE_HZ * PERIODS / FREQUENCY_HZ)
    white = generator.standard_normal((RECORDS, 4 * count))
    frequency = np.fft.rfftfreq(4 * count, 1.0 / RATE_HZ)
    gain = np.sqrt(1.0 + corner_hz / np.maximum(frequency, frequency[1]))
    return np.fft.irfft(np.fft.rfft(white) * gain, 4 * count)[:, :count]


@pytest.mark.parametrize("corner_hz", [0.0, 0.3])
def test_the_fitted_harmonics_scatter_so(corner_hz: float) -> None:
    records = _drawn(corner_hz)
    time = np.arange(records.shape[1]) / RATE_HZ
    angle = 2.0 * np.pi * FREQUENCY_HZ * time
    waves = [np.ones_like(time)]
    for n in (1, 2, 3):
        waves += [np.sin(n * angle), np.cos(n * angle)]
    fitted = np.linalg.lstsq(np.stack(waves, axis=1), records.T, rcond=None)[0].std(axis=1)
    source = Noise(1.0, RATE_HZ, corner_hz=corner_hz).scatter("a", FREQUENCY_HZ, PERIODS)
    spread = np.diag(source.parts).reshape(4, 4, 2)[:, 2]  # of the aft gauge, by order
    assert spread[1:].ravel() == pytest.approx(fitted[1:], rel=0.08)
    if not corner_hz:
        assert spread[0] == pytest.approx([fitted[0], 0.0], rel=0.08)
        assert source.degrees_of_freedom == PERIODS - 1
