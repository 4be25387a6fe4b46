"""Bad input: each kind gets its own message and exit status, and nothing on the output."""

import json
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
    "no such channel",
    "no such reference",
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
    assert (done.exit_code, done.stderr) == (2, "error: nowhere.csv: no such file\n")
    done = run("analyse", "nowhere")
    assert (done.exit_code, done.stderr) == (2, "error: nowhere: no such file or folder\n")


def test_a_folder_without_a_campaign(tmp_path: Path) -> None:
    done = run("analyse", tmp_path)
    assert done.exit_code == 2
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
    ("--level", "1"): "1 is no probability between 0 and 1.",
    ("--level", "95"): "95 is no probability between 0 and 1; for 95 % write 0.95",
    ("--windoe", "1"): "No such option",
    ("--edges", "nowhere.csv"): "nowhere.csv: no such file",
    ("--column", "force=Forse:N"): "no column 'Forse'; did you mean 'Force [N]'?",
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
    assert done.exit_code == 2
    assert str(good) in done.stdout
    assert "Force [N]" in done.stdout
    error, note = done.stderr.splitlines()
    assert error == "error: nowhere.csv: no such file"
    assert note == "without checksums, so that no change would be seen: run.csv"


def test_debug_shows_where_it_was_raised(record: Callable[[list[str]], Path]) -> None:
    arguments = ("analyse", record(_good()), "--map", "a.toml", "--column", "a=b")
    done = run("--debug", *arguments)
    assert done.exit_code == 2
    assert "Traceback" in done.stderr
    assert "chosen_columns" in done.stderr


def test_where_one_files_data_say_no_that_is_the_status(
    tmp_path: Path, record: Callable[[list[str]], Path]
) -> None:
    assert run("analyse", "nowhere.csv", record(_nothing()), "--frequency", "1").exit_code == 1


@pytest.mark.parametrize("option", ["--plot", "--save"])
def test_a_folder_in_whose_place_a_file_stands(
    option: str, tmp_path: Path, record: Callable[[list[str]], Path]
) -> None:
    path = record(_good())
    done = run("analyse", path, "--frequency", "0.83", option, path / "out")
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == f"error: {option} {path / 'out'}: {path} is a file, not a folder\n"


def test_no_reference_names_the_options(record: Callable[[list[str]], Path]) -> None:
    done = run("analyse", record(_good()))
    assert done.exit_code == 1
    assert "(--frequency HZ, --reference CHANNEL)" in done.stderr


def _without_unit(folder: Path) -> Path:
    """Milliseconds under a header that does not say so."""
    path = folder / "run.csv"
    rows = _rows(5.0 * np.sin(2.0 * np.pi * 0.83 * TIME_S), 1e3 * TIME_S)
    path.write_text("\n".join(["Tijd,Force [N]", *rows]) + "\n")
    return path


def test_what_the_reader_noticed_is_said_with_the_error(tmp_path: Path) -> None:
    path = _without_unit(tmp_path)
    done = run("analyse", path, "--frequency", "0.83")
    assert done.exit_code == 1
    warning, error = done.stderr.splitlines()
    assert warning.startswith("WARNING the time column 'Tijd' states no unit; seconds are assumed")
    assert "0.1 samples a period" in error
    document = json.loads(run("analyse", path, "--frequency", "0.83", "--json").stdout)
    assert [flag["code"] for flag in document["failed"][0]["flags"]] == ["time_unit_assumed"]
    right = run("analyse", path, "--frequency", "0.83", "--column", "Tijd=Tijd:ms")
    assert right.exit_code == 0
    assert "recording  1000 samples, 100 Hz, 9.99 s" in right.stdout


def test_a_channel_that_the_map_leaves_out_is_told_so(record: Callable[[list[str]], Path]) -> None:
    options = ("--column", "lift=Force", "--frequency", "0.83", "--channel", "Force")
    done = run("analyse", record(_good()), *options)
    assert done.exit_code == 2
    assert "is not in the column map" in done.stderr
    assert "keep_others = true" in done.stderr
