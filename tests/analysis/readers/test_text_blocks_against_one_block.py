"""A text file read in blocks of a few bytes gives what it gives in one, and names the same line."""

import gzip
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import read_recording, text_source
from hardware.description.errors import DataError

COUNT = 60
VALUES = np.round(40.0 * np.sin(0.37 * np.arange(COUNT)), 3)


def table(separator: str, decimal: str, end: str, last: str) -> str:
    rows = [
        f"{n / 8:.3f}{separator}{'' if n == 20 and separator != ' ' else value}{separator} {n}"
        for n, value in enumerate(VALUES.tolist())
    ]
    text = end.join(rows).replace(".", decimal)
    return f"t [s]{separator}F [N]{separator}G [mm]{end}{text}{last}"


def read(path: Path, block: int) -> tuple[list[list[float]], list[str], str]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text_source, "_BLOCK", block)
        one = read_recording(path)
    values = one.samples[:, 0 : one.sample_count].tolist()
    return values, [flag.message for flag in one.flags], one.provenance["sha256"]


@pytest.mark.slow
@given(
    block=st.integers(1, 300),
    layout=st.sampled_from([(",", "."), (";", ","), ("\t", "."), (" ", ".")]),
    end=st.sampled_from(["\n", "\r\n", "\r"]),
    last=st.sampled_from(["", "\n", "\r\n\r\n", "\n9.5"]),
    encoding=st.sampled_from(["utf-8", "utf-8-sig", "utf-16"]),
    packed=st.booleans(),
)
def test_any_block(
    tmp_path_factory: pytest.TempPathFactory,
    block: int,
    layout: tuple[str, str],
    end: str,
    last: str,
    encoding: str,
    packed: bool,
) -> None:
    data = table(*layout, end, last).encode(encoding)
    path = tmp_path_factory.mktemp("blocks") / ("run.csv.gz" if packed else "run.csv")
    path.write_bytes(gzip.compress(data) if packed else data)
    whole = read(path, 1 << 20)
    assert len(whole[0][0]) == COUNT
    good = np.delete(np.arange(COUNT), 20)
    assert np.array_equal(np.array(whole[0][0])[good], VALUES[good])
    assert read(path, block) == whole


@pytest.mark.parametrize("block", [7, 64, 1 << 20])
def test_the_line_is_the_files(tmp_path: Path, block: int) -> None:
    lines = table(",", ".", "\r\n", "\r\n").split("\r\n")
    lines[0:0] = ["made by somebody", "", "by hand"]
    lines[45] = lines[45].replace(".", "x", 1)
    path = tmp_path / "run.csv"
    path.write_bytes("\r\n".join(["# a", "", *lines[3:]]).encode())
    with pytest.raises(DataError, match=r"line 45, column 't \[s\]': '\d+x\d+' is not a number"):
        read(path, block)


@pytest.mark.parametrize("block", [1, 2, 5, 13])
@pytest.mark.parametrize("odd", ["", " "])
def test_empty_lines_of_a_single_column(tmp_path: Path, block: int, odd: str) -> None:
    cells = [str(value) for value in VALUES]
    cells[20:25] = [odd] * 5
    path = tmp_path / "run.csv"
    path.write_text("\n".join(["F [N]", *cells, ""]), encoding="utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text_source, "_BLOCK", block)
        found = read_recording(path, sample_rate_hz=8.0).values("F")
    assert np.flatnonzero(np.isnan(found)).tolist() == [20, 21, 22, 23, 24]
    assert np.array_equal(np.delete(found, np.s_[20:25]), np.delete(VALUES, np.s_[20:25]))


def test_progress_goes_from_nothing_to_all(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text(table(",", ".", "\n", "\n"))
    told: list[float] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(text_source, "_BLOCK", 100)
        read_recording(path, progress=told.append)
    assert told[-1] == 1.0
    assert 0.0 < told[0] < 0.2
    assert len(told) >= 10
