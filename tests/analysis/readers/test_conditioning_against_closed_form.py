"""Repairs are exact where a cubic is, and saturation is told from natural peaks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers.conditioning import LONGEST_REPAIR, repair_missing, saturation_flags
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

FORCE = Channel("F", "N")


def repaired(row: np.ndarray) -> tuple[np.ndarray, list[str]]:
    samples = row[np.newaxis].copy()
    flags = repair_missing(samples, (FORCE,), "run")
    return samples[0], [flag.code for flag in flags]


@given(
    coefficients=st.lists(st.floats(-10, 10), min_size=4, max_size=4),
    start=st.integers(2, 44),
    length=st.integers(1, LONGEST_REPAIR),
)
def test_a_cubic_is_restored_exactly(coefficients: list[float], start: int, length: int) -> None:
    truth = np.polyval(coefficients, np.linspace(-1.0, 1.0, 50))
    row = truth.copy()
    row[start : start + length] = np.nan
    found, codes = repaired(row)
    assert codes == ["repaired"]
    assert found == pytest.approx(truth, abs=1e-12)


@pytest.mark.parametrize(
    "lost", [[0], [1], [48], [49], [10, 11, 12, 13], [10, 12], [10, 11, 13], range(20, 30)]
)
def test_runs_too_long_or_without_good_neighbours_stay_missing(lost: list[int]) -> None:
    row = np.arange(50.0)
    row[list(lost)] = np.nan
    found, codes = repaired(row)
    assert codes == ["missing"]
    assert np.flatnonzero(np.isnan(found)).tolist() == list(lost)


def test_good_samples_are_never_touched() -> None:
    row = np.random.default_rng(2).standard_normal(5000)
    row[np.random.default_rng(3).random(5000) < 0.05] = np.nan
    good = ~np.isnan(row)
    assert np.array_equal(repaired(row)[0][good], row[good])


def test_everything_missing_is_an_error_and_one_channel_a_flag() -> None:
    with pytest.raises(DataError, match=r"all are missing \(F\)"):
        repaired(np.full(10, np.nan))
    samples = np.array([np.arange(10.0), np.full(10, np.nan)])
    (flag,) = repair_missing(samples, (Channel("G"), FORCE), "run")
    assert (flag.code, flag.channel, flag.severity) == ("channel_empty", "F", Severity.VOID)


def flags_of(row: np.ndarray, full_scale: float | None = None) -> tuple[Flag, ...]:
    return saturation_flags(row[np.newaxis], (Channel("F", "N", full_scale),))


def sine(per_period: float, periods: float = 20.3) -> np.ndarray:
    angle = 2.0 * np.pi * np.arange(int(per_period * periods)) / per_period
    return np.asarray(np.sin(angle + 0.3))


def test_samples_at_a_known_full_scale_are_counted() -> None:
    row = np.clip(sine(200.0), -0.9, 0.95)
    (flag,) = flags_of(row, 0.95)
    assert (flag.code, flag.severity) == ("saturated", Severity.VOID)
    assert f"{np.count_nonzero(row == 0.95)} sample(s) at or above the full scale" in flag.message
    assert flags_of(row, 1.0) == ()


@pytest.mark.parametrize("per_period", [40.0, 200.0, 10_000.0])
@pytest.mark.parametrize("step", [None, 2.0**-11, 2.0**-15])
@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_tops_cut_off_are_told_from_quantised_peaks(
    per_period: float, step: float | None, noise: float
) -> None:
    row = sine(per_period)
    row += noise * np.random.default_rng(4).standard_normal(row.size)
    if step is not None:
        row = np.round(row / step) * step
    assert flags_of(row) == ()
    high, low = flags_of(np.clip(row, -0.9, 0.9))
    assert (high.code, low.code) == ("saturated", "saturated")
    assert high.severity is Severity.WARNING
    assert "at the highest value, 0.9 N" in high.message
    assert "at the lowest value, -0.9 N" in low.message


@pytest.mark.parametrize(
    "row",
    [
        np.zeros(100),
        np.where(np.arange(300) % 50 < 5, 5.0, 0.0),
        np.concatenate([np.zeros(500), 1.0 + sine(100.0)]),
        np.round(1.5 + 0.004 * np.random.default_rng(6).standard_normal(5000), 2),
    ],
    ids=["constant", "switch", "rest before motion", "coarse display"],
)
def test_flat_signals_that_are_not_saturated(row: np.ndarray) -> None:
    assert flags_of(row) == ()
