"""Spikes that were put into records: found, named, taken out, and nothing else touched."""

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat

from analysis.readers import read_recording, write_recording
from analysis.readers.conditioning import without_spikes
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.flags import Severity

RATE_HZ = 200.0
FREQUENCY_HZ = 0.8
NOISE_N = 0.4
COUNT = 8000  # 32 periods
TIME_S = np.arange(COUNT) / RATE_HZ


def motion() -> FloatArray:
    return 0.02 * np.sin(2.0 * np.pi * FREQUENCY_HZ * TIME_S)


def force(seed: int = 3, amplitude: float = 40.0, noise: float = NOISE_N) -> FloatArray:
    white = np.random.default_rng(seed).normal(size=COUNT)
    return amplitude * np.sin(2.0 * np.pi * FREQUENCY_HZ * TIME_S + 0.7) + noise * white


def record(values: FloatArray) -> Recording:
    channels = (Channel("y", "m"), Channel("F", "N"))
    return Recording("run", channels, np.array([motion(), values]), RATE_HZ)


def written(values: FloatArray, kind: str, folder: Path) -> Path:
    path = folder / f"run{kind}"
    if kind == ".nc":
        return write_recording(record(values), path)
    if kind == ".mat":
        savemat(path, {"t": TIME_S, "y": motion(), "F": values})
        return path
    table = np.column_stack((TIME_S, motion(), values))
    np.savetxt(path, table, "%.9g", ",", header="time [s],y [m],F [N]", comments="")
    return path


@pytest.mark.parametrize("kind", [".csv", ".nc", ".mat"])
def test_one_sample_of_500_n_costs_no_period(kind: str, tmp_path: Path) -> None:
    """The harmonics are those of the record without it, over all its periods."""
    spoilt = force()
    spoilt[4321] += 500.0
    found, clean = (
        analyse(
            read_recording(written(values, kind, folder)),
            ReferenceChoice(channel="y"),
            ResolverSettings(channels=("F",)),
        )
        for values, folder in ((spoilt, tmp_path), (force(), _made(tmp_path / "clean")))
    )
    assert found.stretch.period_count == clean.stretch.period_count > 28
    # One sample is off by its noise, not by 500 N: 2/N of that in a coefficient.
    away = found.readings[0].coefficients - clean.readings[0].coefficients
    assert np.abs(away).max() < 2.0 / COUNT * 5.0 * NOISE_N
    (flag,) = [one for one in found.recording.flags if one.code == "spike"]
    assert flag.severity is Severity.WARNING
    assert flag.channel == "F"
    assert "1 spike(s)" in flag.message
    assert "at 21.605 s" in flag.message
    (size,) = re.findall(r"\+(\d+\.\d)", flag.message)
    assert float(size) == pytest.approx(500.0, abs=2.0)


def _made(folder: Path) -> Path:
    folder.mkdir()
    return folder


@pytest.mark.slow
@given(
    start=st.integers(10, COUNT - 20),
    length=st.integers(1, 3),
    # 120 standard deviations of the noise, where all of each length are found; the least sample
    # is 0.7 of the largest.
    size=st.floats(120.0 * NOISE_N / 0.7, 1e6),
    sign=st.sampled_from([-1.0, 1.0]),
    seed=st.integers(0, 1000),
)
def test_what_is_planted_is_taken_out_and_nothing_else(
    start: int, length: int, size: float, sign: float, seed: int
) -> None:
    clean = force(seed)
    spoilt = clean.copy()
    heights = np.random.default_rng(seed).uniform(0.7, 1.0, length)
    spoilt[start : start + length] += sign * size * heights
    found = without_spikes(record(spoilt))
    values = found.samples[:, 0:COUNT]
    outside = np.ones(COUNT, dtype=bool)
    outside[start : start + length] = False
    assert np.array_equal(values[1, outside], clean[outside])
    assert np.array_equal(values[0], motion())
    # The cubic's own error: noise of four samples, weighted by at most 2.1 in all.
    assert values[1] == pytest.approx(clean, abs=12.0 * NOISE_N)
    assert [flag.code for flag in found.flags] == ["spike"]


@given(
    amplitude=st.floats(0.0, 1e6),
    noise=st.floats(0.0, 1e3),
    seed=st.integers(0, 10_000),
    digits=st.sampled_from([None, 0, 2]),
)
def test_a_clean_record_comes_back_as_it_is(
    amplitude: float, noise: float, seed: int, digits: int | None
) -> None:
    values = force(seed, amplitude, noise)
    one = record(values if digits is None else values.round(digits))
    assert without_spikes(one) is one


def test_many_spikes_of_all_sizes_at_any_time() -> None:
    rng = np.random.default_rng(11)
    places = np.sort(rng.choice(np.arange(20, COUNT - 20, 40), 25, replace=False))
    sizes = rng.choice([-1.0, 1.0], 25) * np.geomspace(60.0 * NOISE_N, 1e4, 25)
    values = force()
    values[places] += sizes
    found = without_spikes(record(values))
    (flag,) = found.flags
    assert "25 spike(s)" in flag.message
    assert "and 20 smaller" in flag.message
    assert found.samples[:, 0:COUNT][1] == pytest.approx(force(), abs=12.0 * NOISE_N)


def test_beside_a_gap_it_is_missing_too() -> None:
    values = force()
    values[4000:4010] = np.nan
    values[4010] += 500.0
    found = without_spikes(record(values))
    missing = np.isnan(found.samples[1:2, 0:COUNT][0])
    assert missing[4000:4011].all()
    assert not missing[4013:].any()


def test_slices_with_spikes_are_those_of_an_array(tmp_path: Path) -> None:
    values = force()
    values[[1000, 1001, 5000]] += 300.0
    lazy = read_recording(written(values, ".nc", tmp_path)).samples
    whole = lazy[:, 0:COUNT]
    for part in (slice(990, 1001), slice(1001, 1010), slice(0, COUNT, 3), slice(5000, 5001)):
        assert np.array_equal(lazy[[1, 0], part], whole[[1, 0], part])


def test_a_recording_that_is_read_in_stretches() -> None:
    count = 200_000
    white = np.random.default_rng(5).normal(size=(1, count))
    planted = [32_767, 65_536, 131_071, 199_000]
    white[0, planted] += [300.0, -400.0, 500.0, -600.0]
    one = Recording("long", (Channel("F", "N"),), white, RATE_HZ)
    values = without_spikes(one).samples[:, 0:count][0]
    assert np.flatnonzero(values != white[0]).tolist() == planted
