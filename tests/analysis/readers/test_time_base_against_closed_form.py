"""Time stamps of known origin: the grid comes back, or the reason why there is none."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers.time_base import TimeBase, fit_time_base
from hardware.description.errors import DataError
from hardware.description.flags import Severity


def codes(base: TimeBase) -> list[str]:
    return [flag.code for flag in base.flags]


@given(
    rate=st.floats(0.1, 1e5),
    start=st.floats(-1e3, 1e3),
    count=st.integers(3, 400),
    seed=st.integers(0, 99),
    lost=st.floats(0.0, 0.4),
)
def test_rows_find_their_places(
    rate: float, start: float, count: int, seed: int, lost: float
) -> None:
    rng = np.random.default_rng(seed)
    steps = np.where(rng.random(count) < lost, rng.integers(2, 4, count), 1)
    steps[: count // 2 + 2] = 1  # most rows follow one another
    places = np.cumsum(steps) - steps[0]
    base = fit_time_base(start + places / rate, "run")
    assert base.sample_count == places[-1] + 1
    found = np.arange(count) if base.places is None else base.places
    assert np.array_equal(found, places)
    assert base.sample_rate_hz == pytest.approx(rate, rel=1e-6)
    assert base.start_s == pytest.approx(start, abs=1e-3 / rate)
    assert ("gap" in codes(base)) == bool((steps[1:] > 1).any())


@pytest.mark.parametrize("rate", [100.0, 200.0, 1000.0, 44100.0, 1e6 / 7.0])
def test_an_even_grid_is_taken_as_it_is(rate: float) -> None:
    base = fit_time_base(np.arange(10_000.0) / rate, "run")
    assert base == TimeBase(0.0, base.sample_rate_hz, 10_000)
    assert base.sample_rate_hz == pytest.approx(rate, rel=1e-13)


def test_a_round_rate_comes_back_exactly() -> None:
    assert fit_time_base(np.arange(15_580.0) * 0.005, "run").sample_rate_hz == 200.0


def test_single_precision_interval_is_said_and_kept() -> None:
    base = fit_time_base(np.arange(15_580.0) * 0.0050000002374872, "run")
    assert codes(base) == ["time_single_precision"]
    assert base.sample_rate_hz == pytest.approx(1.0 / 0.0050000002374872, rel=1e-12)
    assert "199.9999905 Hz, which is 200 Hz but for 5e-08" in base.flags[0].message


def test_single_precision_stamps_are_fitted() -> None:
    stamps = (np.arange(15_580) * 0.005).astype(np.float32).astype(np.float64)
    base = fit_time_base(stamps, "run")
    assert codes(base) == ["time_rounded"]
    assert base.flags[0].severity is Severity.NOTE
    assert base.sample_rate_hz == pytest.approx(200.0, rel=1e-9)


def test_milliseconds_of_300_hz_are_fitted_across_a_gap() -> None:
    kept = np.r_[0:3000, 3500:6000]
    base = fit_time_base(np.round(kept / 300.0, 3), "run")
    assert base.places is not None
    assert np.array_equal(base.places, kept)
    assert base.sample_rate_hz == pytest.approx(300.0, rel=1e-7)
    assert codes(base) == ["time_jitter", "gap"]
    assert "500 sample(s) are missing in 1 gap(s), the most 500 after t = 9.997" in (
        base.flags[1].message
    )


@given(seed=st.integers(0, 1000), jitter=st.floats(0.02, 0.15))
def test_jitter_is_averaged_out_and_its_size_said(seed: int, jitter: float) -> None:
    count, rate = 2000, 50.0
    offset = np.random.default_rng(seed).uniform(-jitter, jitter, count)
    base = fit_time_base((np.arange(count) + offset) / rate, "run")
    assert codes(base) == ["time_jitter"]
    assert base.flags[0].severity is Severity.WARNING
    # Five standard deviations of a line's slope through uniform jitter.
    limit = 5.0 * (jitter / 3**0.5) * (12.0 / count**3) ** 0.5
    assert base.sample_rate_hz == pytest.approx(rate, rel=limit)
    said = float(base.flags[0].message.split("(")[1].split()[0])
    assert said == pytest.approx(np.abs(offset).max(), rel=0.15)


def refused(time_s: np.ndarray, message: str) -> None:
    with pytest.raises(DataError, match=message):
        fit_time_base(time_s, "run.csv")


def test_more_missing_than_present_is_refused() -> None:
    refused(np.r_[0:50, 500:550] / 100.0, "450 samples are missing and only 100 present.*split")


def test_backwards_repeats_and_missing_stamps_name_the_row() -> None:
    time_s = np.arange(100) / 10.0
    for value, message in ((2.0, "runs backwards"), (4.9, "repeats"), (np.nan, "are missing")):
        bad = time_s.copy()
        bad[50] = value
        refused(bad, rf"run\.csv: .*{message}.*data row 51")


def test_one_row_is_refused() -> None:
    refused(np.array([1.0]), r"1 row\(s\) of data")
