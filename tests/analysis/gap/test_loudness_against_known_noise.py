"""What is read between the harmonics is the density of the noise that was put in."""

import numpy as np
import pytest
from scipy.signal import lfilter

from analysis.gap.observe.components import GapRun, Observation
from analysis.gap.observe.sensors import heard_rms
from analysis.gap.observe.spectrum import Lines, loudness, quiet_lines
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun

RATE_HZ, PERIODS = 150.0, 7
FREQUENCIES_HZ = (0.45, 0.45, 0.63, 0.63, 0.63, 0.89, 0.89, 0.89, 1.25, 1.25)
WHITE, COLOURED, KEEP = 0.2, 0.1, float(np.exp(-1.0 / (0.15 * RATE_HZ)))


def density(frequency_hz: float) -> float:
    """Return the closed form of white noise and of a first-order process, unit squared per Hz."""
    turn = np.exp(-2j * np.pi * frequency_hz / RATE_HZ)
    coloured = COLOURED**2 * (1.0 - KEEP**2) / abs(1.0 - KEEP * turn) ** 2
    return float((WHITE**2 + coloured) / RATE_HZ)


def noise(count: int, rng: np.random.Generator) -> FloatArray:
    steps = rng.standard_normal(count) * COLOURED * np.sqrt(1.0 - KEEP**2)
    steps[0] = COLOURED * rng.standard_normal()
    return np.asarray(lfilter([1.0], [1.0, -KEEP], steps)) + WHITE * rng.standard_normal(count)


def lines_of(frequency_hz: float, seed: int, hum: float = 0.0) -> Lines:
    time_s = np.arange(round(PERIODS / frequency_hz * RATE_HZ)) / RATE_HZ
    angle = 2.0 * np.pi * frequency_hz * time_s
    shown = 5.0 + 40.0 * np.sin(angle) + 3.0 * np.cos(3.0 * angle + 0.4)
    shown = shown + hum * np.sin(2.0 * np.pi * 2.41 * frequency_hz * time_s)
    values = shown + noise(len(time_s), np.random.default_rng(seed))
    return quiet_lines(time_s, values[None, :], frequency_hz, 6)[0]


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("hum", [0.0, 1.0])
def test_density_at_the_harmonics(seed: int, hum: float) -> None:
    """Three times the spread over 30 campaigns, whatever harmonics and line of an old wave."""
    found = loudness(
        lines_of(frequency, 100 * seed + number, hum)
        for number, frequency in enumerate(FREQUENCIES_HZ)
    )
    assert found is not None
    for frequency, spread in ((0.5, 0.22), (1.0, 0.12), (2.5, 0.09), (5.0, 0.12)):
        assert found.at(frequency) == pytest.approx(density(frequency), rel=3.0 * spread)


def test_no_bias_over_many_campaigns() -> None:
    """Nor at zero frequency, which no line reaches."""
    ratios = []
    for seed in range(20):
        found = loudness(
            lines_of(frequency, 1000 + 50 * seed + number)
            for number, frequency in enumerate(FREQUENCIES_HZ)
        )
        assert found is not None
        ratios.append([found.at(one) / density(one) for one in (0.0, 0.6, 3.0)])
    assert np.median(ratios, axis=0) == pytest.approx(np.ones(3), abs=0.12)


def test_too_few_lines_say_nothing() -> None:
    assert loudness([]) is None
    assert loudness([Lines(np.arange(1.0, 5.0), np.ones(4))]) is None
    assert loudness([Lines(np.arange(1.0, 50.0), np.zeros(49))]) is None


def test_a_run_too_short_for_lines_leaves_the_noise_as_it_is() -> None:
    """The sensor is as loud as what was put in: half of three times the density's spread above."""
    rng = np.random.default_rng(8)
    runs = []
    for number, frequency_hz in enumerate((*FREQUENCIES_HZ, 1.0)):
        count = 4 if number == len(FREQUENCIES_HZ) else round(PERIODS / frequency_hz * RATE_HZ)
        values = WHITE * rng.standard_normal((1, count))
        lines = quiet_lines(np.arange(count) / RATE_HZ, values, frequency_hz, 6)[0]
        seen = Observation((), np.zeros(0), np.zeros(0), {"force_aft": lines})
        point = SetPoint(frequency_hz, 0.02)
        runs.append(GapRun(str(number), point, CampaignRun(number), seen, PERIODS, RATE_HZ))
    assert runs[-1].observed.quiet["force_aft"].frequency_hz.size == 0
    assert heard_rms(runs, "force_aft") == pytest.approx(WHITE, rel=0.18)
