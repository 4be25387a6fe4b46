"""Stamps on no even grid come back as they were written, and clocks and dates as seconds."""

from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording, write_recording
from analysis.readers.time_base import LARGEST_DEVIATION, fit_time_base
from analysis.recording import Recording
from hardware.description.errors import DataError

START = datetime(2025, 3, 1, 23, 59, 59, 900000)
FORCE = [f"{k % 7}.25" for k in range(200)]


def uneven(rng: np.random.Generator, rate: float = 50.0, seconds: float = 20.0) -> np.ndarray:
    time_s = (np.arange(0.0, seconds * rate) + rng.uniform(-0.3, 0.3, int(seconds * rate))) / rate
    return np.asarray(time_s[rng.random(time_s.size) > 0.2])


def written(folder: Path, header: str, stamps: list[str]) -> Recording:
    path = folder / "run.csv"
    rows = [f"{stamp}{header[-1]}{force}" for stamp, force in zip(stamps, FORCE, strict=False)]
    path.write_text("\n".join([f"{header[:-1]}{header[-1]}F [N]", *rows]) + "\n")
    return read_recording(path)


def test_each_stamp_counts_as_it_is(tmp_path: Path) -> None:
    time_s = uneven(np.random.default_rng(3))[:200]
    found = written(tmp_path, "Time [s],", [f"{t:.6f}" for t in time_s])
    assert [flag.code for flag in found.flags] == ["time_uneven"]
    np.testing.assert_allclose(found.time_s(), time_s, atol=1e-6)
    np.testing.assert_allclose(found.sample_number(found.time_s()), np.arange(200), atol=1e-9)
    assert found.values("F").tolist() == [float(force) for force in FORCE]
    part = found.between(float(time_s[20]) - 1e-3, float(time_s[30]) + 1e-3)
    np.testing.assert_allclose(part.time_s(), time_s[20:31], atol=1e-6)
    assert part.values("F").tolist() == found.values("F")[20:31].tolist()
    with pytest.raises(DataError, match=r"NetCDF needs evenly spaced samples"):
        write_recording(found, tmp_path / "run.nc")


@pytest.mark.parametrize(
    "stamps",
    [
        (np.arange(500) + np.random.default_rng(1).uniform(-0.4, 0.4, 500)) / 10.0,
        np.r_[np.arange(500) / 100.0, 5.0 + np.arange(500) / 103.0],
        np.arange(200) / 100.0 + 0.103 * (np.arange(200) >= 120),
    ],
    ids=["jitter", "a change of rate", "a gap of no whole number of intervals"],
)
def test_what_no_even_grid_holds_is_kept(stamps: np.ndarray) -> None:
    base = fit_time_base(stamps, "run")
    assert base.stamps_s is not None
    assert np.array_equal(base.stamps_s, stamps)
    assert base.sample_rate_hz == pytest.approx((stamps.size - 1) / np.ptp(stamps))
    assert LARGEST_DEVIATION < 0.4


def test_two_runs_in_one_record_are_refused() -> None:
    time_s = uneven(np.random.default_rng(5))
    with pytest.raises(DataError, match=r"(29.9|30)\.?\d* s without a sample .* split the record"):
        fit_time_base(np.r_[time_s, time_s + time_s[-1] + 30.0], "run")


CLOCKS: dict[str, tuple[str, Callable[[datetime], str]]] = {
    "time of day": ("Clock,", lambda t: t.strftime("%H:%M:%S.%f")),
    "ISO 8601": ("When,", lambda t: t.isoformat()),
    "UTC": ("Timestamp,", lambda t: f"{t.isoformat()}Z"),
    "with a blank": ("Time,", lambda t: str(t)),
    "blank and tab": ("Time\t", lambda t: str(t)),
    "day first": ("Zeit;", lambda t: t.strftime("%d.%m.%Y %H:%M:%S,%f")),
    "month first": ("Time,", lambda t: t.strftime("%m/%d/%Y %H:%M:%S.%f")),
    "month first, twelve hours": ("Time\t", lambda t: t.strftime("%m/%d/%Y %I:%M:%S.%f %p")),
    "day first, slashes": ("Time;", lambda t: t.strftime("%d/%m/%Y %H:%M:%S.%f")),
    "day first, dashes": ("Time;", lambda t: t.strftime("%d-%m-%Y %H:%M:%S.%f")),
    "date beside": ("Date,Time,", lambda t: t.strftime("%Y-%m-%d,%H:%M:%S.%f")),
    "date beside, blanks": ("Date Time ", lambda t: str(t)),
}


@pytest.mark.parametrize("kind", CLOCKS)
def test_clocks_run_on_over_midnight(tmp_path: Path, kind: str) -> None:
    header, said = CLOCKS[kind]
    stamps = [said(START + timedelta(milliseconds=10 * k + (k > 50))) for k in range(200)]
    found = written(tmp_path, header, stamps)
    assert found.channel_names == ("F",)
    assert found.start_s == pytest.approx(86399.9, abs=1e-3)
    assert found.end_s - found.start_s == pytest.approx(1.991, abs=1e-3)


@pytest.mark.parametrize("order", ["%d/%m/%Y", "%m/%d/%Y"])
@pytest.mark.parametrize("day", ["2025-03-04", "2025-11-11", "2025-12-12", "2025-12-31"])
def test_days_that_may_be_months_are_told_by_the_next(tmp_path: Path, order: str, day: str) -> None:
    """Before and after midnight: the other order would leave a month between."""
    start = datetime.fromisoformat(f"{day} 23:59:59.5")
    times = [start + timedelta(milliseconds=10 * k) for k in range(100)]
    stamps = [one.strftime(f"{order} %H:%M:%S.%f") for one in times]
    found = written(tmp_path, "Time,", stamps)
    assert found.start_s == pytest.approx(86399.5)
    assert found.end_s - found.start_s == pytest.approx(0.99)


def test_a_zone_is_taken_off_and_no_such_date_is_refused(tmp_path: Path) -> None:
    stamps = [f"{(START + timedelta(milliseconds=10 * k)).isoformat()}+01:30" for k in range(9)]
    assert written(tmp_path, "Time,", stamps).start_s == pytest.approx(86399.9 - 5400.0)
    with pytest.raises(DataError, match=r"is not a number.*2025-03-01 12:00:01\.5"):
        written(tmp_path, "Time,", ["2025-02-30 12:00:00.1", "2025-02-30 12:00:00.2"])
