"""What no sensor gives counts as missing, and is named; everything else stays as it is."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from analysis.readers import read_recording, write_recording
from analysis.readers.missing_values import LARGEST, without_beyond
from analysis.recording import Recording
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.flags import Flag, Severity

ANY = st.floats(allow_nan=True, allow_infinity=True)
COUNT = 140_000  # more than is looked at in one go


def recording(samples: np.ndarray) -> Recording:
    return Recording("run", (FORCE_AFT, FORCE_FORE), samples, 100.0, start_s=2.0)


@given(arrays(np.float64, (2, 7), elements=ANY))
def test_all_that_is_left_is_within_or_missing(samples: np.ndarray) -> None:
    kept = without_beyond(recording(samples)).samples[:, 0:7]
    within = np.abs(samples) <= LARGEST
    assert np.array_equal(kept[within], samples[within])
    assert np.isnan(kept[~within]).all()


def test_the_channel_the_count_the_time_and_the_value_are_named() -> None:
    samples = np.zeros((2, 300_000))
    samples[1, 250_000:250_003] = (-np.inf, 1e300, np.nan)
    found = without_beyond(recording(samples))
    (flag,) = found.flags
    assert (flag.code, flag.channel) == ("beyond_range", "force_fore")
    assert "force_fore: 2 sample(s) beyond 1e+12, the first -inf at 2502 s" in flag.message
    assert np.isnan(found.values("force_fore")).sum() == 3
    assert np.isnan(samples).sum() == 1  # the source is as it was


def test_a_sound_recording_is_returned_as_it_is() -> None:
    sound = recording(np.full((2, 9), LARGEST))
    assert without_beyond(sound) is sound
    assert without_beyond(replace(sound, samples=np.zeros((2, 0)))).flags == ()


def by_text(values: np.ndarray) -> list[tuple[int, int]]:
    """First and number of each run of missing samples, by splitting a text of them."""
    text = "".join("x" if np.isnan(one) else "." for one in values)
    runs, at = [], 0
    for piece in text.replace(".", " ").split(" "):
        if piece:
            runs.append((at, len(piece)))
        at += len(piece) + 1
    return runs


def with_gaps(count: int, gaps: dict[int, list[tuple[int, int]]]) -> np.ndarray:
    samples = np.random.default_rng(7).standard_normal((2, count))
    for row, runs in gaps.items():
        for first, length in runs:
            samples[row, first : first + length] = np.nan
    return samples


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "gaps",
    [
        {0: [(0, 1)]},
        {0: [(10, 5), (20, 3)], 1: [(COUNT - 10, 10)]},
        {1: [(131_000, 200)]},  # over the end of a block
        {0: [(0, COUNT)]},
    ],
)
def test_what_is_missing_in_netcdf_is_said(
    tmp_path: Path, gaps: dict[int, list[tuple[int, int]]]
) -> None:
    samples = with_gaps(COUNT, gaps)
    found = read_recording(write_recording(recording(samples), tmp_path / "run.nc"))
    assert np.array_equal(found.samples[:, 0:COUNT], samples, equal_nan=True)
    told = {flag.channel: flag for flag in found.flags if flag.severity is Severity.VOID}
    assert set(told) == {found.channel_names[row] for row in gaps}
    for row in gaps:
        runs = by_text(samples[row])
        message = told[found.channel_names[row]].message
        if runs == [(0, COUNT)]:
            assert "every sample is missing" in message
            continue
        assert f": {sum(length for _, length in runs)} sample(s) are missing" in message
        assert message.endswith(f"the longest run {max(length for _, length in runs)}")


def test_what_is_said_already_is_not_said_again(tmp_path: Path) -> None:
    samples = with_gaps(300, {0: [(10, 5), (50, 2)], 1: [(10, 5)]})
    gap = Flag("gap", Severity.WARNING, "5 samples are missing")
    told = replace(recording(samples), flags=(gap,))
    found = read_recording(write_recording(told, tmp_path / "run.nc"))
    assert [(one.code, one.channel) for one in found.flags] == [
        ("gap", None),
        ("missing", "force_aft"),
    ]
    assert ": 2 sample(s) are missing" in found.flags[1].message
    again = read_recording(write_recording(found, tmp_path / "again.nc"))
    assert again.flags == found.flags
