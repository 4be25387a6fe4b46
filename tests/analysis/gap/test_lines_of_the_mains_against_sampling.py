"""Oracle: where samples show a line of the mains, and in which band of which run that lies."""

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from analysis.gap.observe.bands import (
    MAINS_HZ,
    TAKEN_OUT,
    between_harmonics,
    folded_hz,
    of_the_mains,
)
from analysis.gap.observe.components import Component, Part
from analysis.gap.observe.observation import BANDS


@given(st.sampled_from(MAINS_HZ), st.floats(3.0, 2000.0))
def test_a_line_is_seen_where_its_samples_are_alike(mains_hz: int, rate_hz: float) -> None:
    number = np.arange(64)
    seen = np.cos(2.0 * np.pi * folded_hz(mains_hz, rate_hz) / rate_hz * number)
    assert seen == pytest.approx(np.cos(2.0 * np.pi * mains_hz / rate_hz * number), abs=1e-6)


@given(st.floats(0.1, 2.0), st.floats(20.0, 500.0), st.integers(4, 40), st.integers(0, 2**32 - 1))
def test_each_line_of_the_mains_is_one_number_of_a_channel(
    frequency_hz: float, rate_hz: float, periods: int, seed: int
) -> None:
    """Whatever the rate, and whichever band it folds into."""
    values = np.random.default_rng(seed).standard_normal(int(periods / frequency_hz * rate_hz))
    found = [
        part for part, _, _ in between_harmonics("force_aft", values, rate_hz, frequency_hz, BANDS)
    ]
    assert len(set(found)) == len(found)
    assert {part.order for part in found if part.part is Part.MAINS} <= {*MAINS_HZ}


@pytest.mark.parametrize(
    ("line_hz", "seen"),
    [
        (50.0, (Part.MAINS, 50)),
        (100.0, (Part.MAINS, 50)),
        (150.0, (Part.MAINS, 50)),
        (60.0, (Part.MAINS, 60)),
        (43.0, (Part.LINE, 2)),
        (207.0, (Part.LINE, 2)),
        (3.7, (Part.LINE, 1)),
    ],
)
def test_only_a_line_of_the_mains_counts_as_one(line_hz: float, seen: tuple[Part, int]) -> None:
    """With its double and triple: a transformer hums at those."""
    rng, rate_hz, count = np.random.default_rng(4), 500.0, 5000
    time_s = np.arange(count) / rate_hz
    values = rng.standard_normal(count) + 0.5 * np.sin(2.0 * np.pi * line_hz * time_s)
    told = {
        (part.part, part.order): value / uncertainty
        for part, value, uncertainty in between_harmonics("force_aft", values, rate_hz, 0.83, BANDS)
        if part.part is not Part.BETWEEN
    }
    assert max(told, key=lambda key: told[key]) == seen
    assert told.pop(seen) > 4.0
    assert max(told.values()) < 2.5


@given(st.sampled_from([22.0, 55.0, 110.0, 110.3]) | st.floats(20.0, 500.0))
@example(110.0)
def test_no_line_is_told_twice(rate_hz: float) -> None:
    """At 110 samples a second 50 and 60 Hz are the same samples."""
    count = int(40.0 * rate_hz)
    lines_hz = np.arange(count // 2 + 1) * rate_hz / count
    near = of_the_mains(lines_hz, rate_hz, rate_hz / count)
    assert np.sum([np.zeros(len(lines_hz), int), *near.values()], axis=0).max() <= 1
    seen_hz = [folded_hz(mains_hz, rate_hz) for mains_hz in MAINS_HZ]
    reached_hz = lines_hz[np.any([np.zeros(len(lines_hz), bool), *near.values()], axis=0)]
    for at_hz in (hz for hz in seen_hz if 0.0 < hz < lines_hz[-1]):
        assert np.abs(reached_hz - at_hz).min() <= 0.5001 * rate_hz / count


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("high_for", [0.47, 0.5])  # of a period: with half of it, odd orders alone
@pytest.mark.parametrize(
    ("hum", "square"), [(0.0, 0.0), (0.0, 1.0), (0.0, 12.0), (0.5, 0.0), (0.5, 1.0)]
)
def test_hum_is_told_from_the_harmonic_that_it_falls_on(
    hum: float, square: float, high_for: float, seed: int
) -> None:
    """At 1 Hz, 50 Hz is the 50th harmonic, at 1.02 Hz beside the 49th; a square wave has some."""
    rate_hz, count, frequency_hz = 200.0, 2000, 1.0 if seed % 2 else 1.02
    time_s, rng = np.arange(count) / rate_hz, np.random.default_rng(seed)
    turns = frequency_hz * time_s
    wave = square * np.where((turns + 0.1) % 1.0 < high_for, 1.0, -1.0)
    angle = 2.0 * np.pi * np.outer(turns, np.arange(1, TAKEN_OUT + 1))
    known = np.hstack((np.ones((count, 1)), np.cos(angle), np.sin(angle)))
    wave = wave - known @ np.linalg.lstsq(known, wave, rcond=None)[0]
    values = rng.standard_normal(count) + wave + hum * np.sin(2.0 * np.pi * 50.0 * time_s + 0.4)
    entries = between_harmonics("force_aft", values, rate_hz, frequency_hz, BANDS)
    told = {(part.part, part.order): value / uncertainty for part, value, uncertainty in entries}
    assert (told[Part.MAINS, 50] > 3.2) == (hum > 0.0)


@pytest.mark.parametrize("phase_rad", [0.3, 1.0, 1.5])
def test_hum_at_half_the_rate_is_hum(phase_rad: float) -> None:
    """50 Hz at 100 samples a second; at a phase of 0 no sample shows it."""
    time_s, rng = np.arange(1500) / 100.0, np.random.default_rng(3)
    values = rng.standard_normal(1500) + np.sin(2.0 * np.pi * 50.0 * time_s + phase_rad)
    told = {
        (part.part, part.order): value / uncertainty
        for part, value, uncertainty in between_harmonics("force_aft", values, 100.0, 0.83, BANDS)
    }
    assert told[Part.MAINS, 50] > 3.0
    assert told[Part.LINE, 2] < 3.0


@given(
    st.floats(0.02, 100.0),
    st.floats(0.001, 10.0),
    st.floats(0.7, 1.3),
    st.integers(0, 2**32 - 1),
)
@example(0.02, 10.0, 1.0, 0)
def test_a_line_is_as_large_as_it_is(
    hum: float, noise: float, frequency_hz: float, seed: int
) -> None:
    """In the channel's unit, within six deviations of what noise makes of it."""
    time_s, rng = np.arange(4000) / 210.0, np.random.default_rng(seed)
    values = hum * np.sin(2.0 * np.pi * 50.0 * time_s + 0.4)
    values = values + noise * rng.standard_normal(len(time_s))
    told = {
        (part.part, part.order): (value, uncertainty)
        for part, value, uncertainty in between_harmonics(
            "force_aft", values, 210.0, frequency_hz, BANDS
        )
    }
    value, uncertainty = told[Part.MAINS, 50]
    by_noise = noise * (2.0 / len(values)) ** 0.5 * 1.5**0.5
    assert uncertainty >= 0.7 * by_noise
    assert abs(value - hum) < 6.0 * by_noise + 0.02 * hum


def test_noise_alone_is_no_line_however_loud() -> None:
    """A simulation that is louder than the rig would else have hum that the rig has not."""
    rng, found = np.random.default_rng(6), []
    for _ in range(100):
        values = rng.uniform(0.01, 10.0) * rng.standard_normal(2000)
        entries = between_harmonics("force_aft", values, 210.0, 0.83, BANDS)
        found += [value for part, value, _ in entries if part.part is Part.MAINS]
    assert len(found) == 200
    assert np.count_nonzero(found) <= 6  # one is expected, and more than six in one of ten thousand


@pytest.mark.parametrize("hum_hz", [50.0, 49.97])
@pytest.mark.parametrize("hum", [0.3, 5.0, 100.0])
def test_the_loudest_hum_leaves_the_noise_about_it_as_it_is(hum: float, hum_hz: float) -> None:
    """Its leakage under a Hann taper falls with the third power of the distance, however strong."""
    time_s, rng = np.arange(4000) / 210.0, np.random.default_rng(9)
    quiet = 0.05 * rng.standard_normal(len(time_s))
    loud = quiet + hum * np.sin(2.0 * np.pi * hum_hz * time_s + 0.4)
    without, beside = (
        {
            (part.part, part.order): (value, uncertainty)
            for part, value, uncertainty in between_harmonics(
                "force_aft", values, 210.0, 0.83, BANDS
            )
            if part.part is not Part.MAINS
        }
        for values in (quiet, loud)
    )
    assert without.keys() == beside.keys()
    for part, (value, uncertainty) in without.items():
        assert abs(beside[part][0] - value) < 0.5 * uncertainty, part


@pytest.mark.parametrize("seed", range(8))
def test_a_zero_that_wanders_is_no_hum_that_folds_to_it(seed: int) -> None:
    """100 Hz at 100.2 samples a second is a line at 0.2 Hz, where a wandering zero is loud."""
    count, rng = 2000, np.random.default_rng(seed)
    wandering = np.cumsum(rng.standard_normal(count)) * 0.02
    values = 0.1 * rng.standard_normal(count) + wandering
    found = [
        value
        for part, value, _ in between_harmonics("force_aft", values, 100.2, 0.83, BANDS)
        if part == Component("force_aft", Part.MAINS, 50)
    ]
    assert found == [0.0]
