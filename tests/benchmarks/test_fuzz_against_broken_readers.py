"""The fuzz board against readers that break each promise, and against itself when it is resumed."""

import json
import math
import time
from pathlib import Path

import numpy as np
import pytest

from analysis.recording import Recording
from benchmarks.fuzz import worker
from benchmarks.fuzz.__main__ import main
from benchmarks.fuzz.board import PROMISES, Count, document, keep_counts, read_counts
from benchmarks.fuzz.mutate import mutate
from benchmarks.fuzz.promises import SilentNanError, check_finite, check_recording
from benchmarks.fuzz.targets import TARGETS, opened
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

GOOD = b"frequency_hz = 0.83, eccentricity_mm = 20"


def test_an_input_is_the_same_for_its_number_and_another_for_another() -> None:
    made = [mutate(GOOD, GOOD, np.random.default_rng(n)) for n in (*range(200), *range(200))]
    assert made[:200] == made[200:]
    assert len(set(made[:200])) > 150


def test_the_whole_board_is_a_million_with_its_parts() -> None:
    sizes = {one.name: one.inputs for one in TARGETS}
    assert sum(sizes.values()) >= 1_000_000
    live = [one for one in sizes if one.startswith(("serial", "CAN", "console", "CSV", "TOML"))]
    assert sum(sizes[one] for one in live) >= 900_000
    assert {sizes[one] for one in ("run.nc", "samples.arrows", "bus.blf")} == {20_000}
    assert {sizes[one] for one in ("MAT 5", "MAT 7.3", "TDMS")} == {3_000}


@pytest.mark.sample(8)
@pytest.mark.parametrize("target", TARGETS, ids=[one.name for one in TARGETS])
def test_good_inputs_are_read_without_a_broken_promise(target, tmp_path: Path) -> None:
    with opened(target, tmp_path) as (seeds, read):
        told = [worker._outcome(read, one)[0] for one in seeds]
    assert not any(one.get("broken") for one in told), told
    assert any(one.get("taken") for one in told)


def _refuses(_data: bytes) -> object:
    raise DataError("no")


def _ends(_data: bytes) -> object:
    raise IndexError("list index out of range")


def _fools(_data: bytes) -> object:
    check_finite({"a": [1.0, float("nan")]})
    return 0


def _hangs(_data: bytes) -> object:
    while True:
        time.sleep(0.01)


@pytest.mark.parametrize(
    ("read", "broken"),
    [(_refuses, None), (_ends, "uncaught"), (_fools, "silent NaN"), (_hangs, "hangs over 5 s")],
)
def test_each_broken_promise_is_told(read, broken, monkeypatch: pytest.MonkeyPatch) -> None:
    import signal

    before = signal.signal(signal.SIGALRM, worker._late)
    monkeypatch.setattr(worker, "LONGEST_S", 0.2)
    # The process is that of many tests here: its memory is no reader's.
    monkeypatch.setattr(worker, "_MOST_BYTES", math.inf)
    try:
        told, _ = worker._told(read, b"")
    finally:
        signal.signal(signal.SIGALRM, before)
    assert told.get("broken") == broken
    assert broken is None or broken in PROMISES


def test_a_flag_of_the_channel_or_of_all_says_a_missing_value() -> None:
    values = np.array([[1.0, np.nan, 2.0], [1.0, 2.0, 3.0]])
    one = Recording("a", (Channel("x", "N"), Channel("y", "N")), values, 10.0)
    with pytest.raises(SilentNanError, match="'x' has 1"):
        check_recording(one)
    for channel in ("x", None):
        flag = Flag("missing", Severity.VOID, "one", channel)
        check_recording(Recording("a", one.channels, values, 10.0, flags=(flag,)))


@pytest.mark.slow
def test_a_board_goes_on_where_it_was_left(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    def run(share: str) -> str:
        words = ["--share", share, "--only", "TOML: calibration", "--folder", str(tmp_path)]
        assert main(words) == 0
        return capsys.readouterr().out

    assert "20 inputs" in run("0.002")
    assert "30 inputs" in run("0.003")
    kept = read_counts(tmp_path)
    assert kept["TOML: calibration"].done == 30
    keep_counts(tmp_path, {"a": Count(3, 1, 1, {"uncaught": 1})})
    found = document(read_counts(tmp_path), {"commit": "abc"})
    assert (found["inputs"], found["broken"]["uncaught"], found["broken"]["silent NaN"]) == (
        3,
        1,
        0,
    )
    assert json.loads(json.dumps(found)) == found
