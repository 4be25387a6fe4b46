"""Bad input: each kind gets its own message and exit status, and nothing on the output."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli

RATE_HZ = 100.0
TIME_S = np.arange(1000) / RATE_HZ


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in arguments], catch_exceptions=False)


def _rows(values: np.ndarray, time_s: np.ndarray = TIME_S) -> list[str]:
    return [f"{t:.2f},{y:.6f}" for t, y in zip(time_s, values, strict=True)]


def _good() -> list[str]:
    return _rows(5.0 * np.sin(2.0 * np.pi * 0.83 * TIME_S))


def _with_text() -> list[str]:
    rows = _good()
    return [*rows[:500], "5.00,broken", *rows[501:]]


def _backwards() -> list[str]:
    rows = _good()
    return [*rows[:500], rows[501], rows[500], *rows[502:]]


def _nothing() -> list[str]:
    return _rows(np.full(TIME_S.size, np.nan))


@pytest.fixture
def record(tmp_path: Path) -> Callable[[list[str]], Path]:
    def write(rows: list[str]) -> Path:
        path = tmp_path / "run.csv"
        path.write_text("\n".join(["Time [s],Force [N]", *rows]) + "\n")
        return path

    return write


CASES = {
    "no such channel": (
        _good,
        ("--frequency", "0.83", "--channel", "Forse"),
        ("no channel 'Forse'", "did you mean Force?"),
    ),
    "no such reference": (_good, ("--reference", "stroke"), ("no channel 'stroke'",)),
    "no reference found": (_good, (), ("no reference found", "give the frequency")),
    "text where numbers belong": (_with_text, ("--frequency", "0.83"), ("broken", "502")),
    "time running backwards": (
        _backwards,
        ("--frequency", "0.83"),
        ("time runs backwards at data row 502", "5 s after 5.01 s"),
    ),
    "fewer than one period": (
        _good,
        ("--frequency", "0.05"),
        ("holds 0.50 periods of 0.05 Hz", "at least one whole period"),
    ),
    "everything NaN": (_nothing, ("--frequency", "0.83"), ("no channel has any value",)),
    "window beyond the record": (
        _good,
        ("--frequency", "0.83", "--opens-at", "50"),
        ("cannot open at 50 s", "0.000 s to 9.990 s"),
    ),
    "more periods than there are": (
        _good,
        ("--frequency", "0.83", "--opens-at", "5", "--periods", "5"),
        ("4 whole periods follow 5 s, but 5 are asked for",),
    ),
    "gate longer than the stretch": (
        _good,
        ("--frequency", "0.83", "--gate", "50"),
        ("a gate of 50 periods does not fit",),
    ),
    "too many harmonics": (
        _good,
        ("--frequency", "20", "--harmonics", "4"),
        ("5.0 samples a period cannot carry harmonic 4",),
    ),
}


# What the request names, or asks for, and cannot be.
CANNOT_BE = {
    "window beyond the record",
    "more periods than there are",
    "gate longer than the stretch",
    "too many harmonics",
}


@pytest.mark.parametrize("case", CASES)
def test_the_data_say_no(case: str, record: Callable[[list[str]], Path]) -> None:
    rows, options, messages = CASES[case]
    path = record(rows())
    done = run("analyse", path, *options)
    assert done.exit_code == (2 if case in CANNOT_BE else 1)
    assert done.stdout == ""
    assert "Traceback" not in done.stderr
    for message in ("error: ", str(path), *messages):
        assert message in done.stderr


def test_each_message_is_its_own(record: Callable[[list[str]], Path]) -> None:
    said = {run("analyse", record(rows()), *options).stderr for rows, options, _ in CASES.values()}
    assert len(said) == len(CASES)


def test_an_empty_file(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.touch()
    done = run("analyse", path)
    assert (done.exit_code, done.stdout) == (1, "")
    assert done.stderr == f"error: {path}: the file is empty\n"


def test_a_missing_file() -> None:
    done = run("analyse", "nowhere.csv")
    assert (done.exit_code, done.stderr) == (1, "error: nowhere.csv: no such file\n")


def test_a_folder_without_a_campaign(tmp_path: Path) -> None:
    done = run("analyse", tmp_path)
    assert done.exit_code == 1
    assert f"{tmp_path}: a folder without a campaign.toml" in done.stderr


REQUESTS = {
    ("--reference", "Force", "--frequency", "1"): "give one reference",
    ("--periods", "3", "--frequency", "1"): "needs the time at which the gate opens",
    ("--latency", "0.01", "--frequency", "1"): "a latency is the photocell's",
    ("--angle-offset", "5", "--frequency", "1"): "an angle offset is that of",
    ("--map", "a.toml", "--column", "a=b"): "give --map or --column, not both",
    ("--map", "nowhere.toml"): "nowhere.toml: no such column map",
    ("--column", "a=Force:furlong"): "unknown unit 'furlong'",
    ("--harmonics", "0"): "0 is not in the range x>=1",
    ("--frequency", "nan"): "nan",
    ("--level", "1"): "1.0 is not in the range 0.0<x<1.0",
    ("--windoe", "1"): "No such option",
}


@pytest.mark.parametrize("options", REQUESTS)
def test_the_request_was_wrong(
    options: tuple[str, ...], record: Callable[[list[str]], Path]
) -> None:
    done = run("analyse", record(_good()), *options)
    assert done.exit_code == 2
    assert done.stdout == ""
    assert REQUESTS[options] in done.stderr


def test_no_file_at_all_is_a_wrong_request() -> None:
    assert run("analyse").exit_code == 2


def test_a_misspelt_command_is_named() -> None:
    done = run("analyze")
    assert done.exit_code == 2
    assert "did you mean 'analyse'?" in done.stderr


def test_one_bad_file_does_not_stop_the_others(
    tmp_path: Path, record: Callable[[list[str]], Path]
) -> None:
    good = record(_good())
    done = run("analyse", "nowhere.csv", good, "--frequency", "0.83")
    assert done.exit_code == 1
    assert str(good) in done.stdout
    assert "Force [N]" in done.stdout
    assert done.stderr == "error: nowhere.csv: no such file\n"


def test_debug_shows_where_it_was_raised(record: Callable[[list[str]], Path]) -> None:
    arguments = ("analyse", record(_good()), "--map", "a.toml", "--column", "a=b")
    done = run("--debug", *arguments)
    assert done.exit_code == 2
    assert "Traceback" in done.stderr
    assert "chosen_columns" in done.stderr
