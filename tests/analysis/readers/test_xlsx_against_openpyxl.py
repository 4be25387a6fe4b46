"""XLSX files as openpyxl writes them come back: titles, units, dates, and what is refused."""

from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from analysis.readers import ColumnMap
from analysis.readers.xlsx import READER
from analysis.recording import Recording
from hardware.description.errors import DataError

openpyxl = pytest.importorskip("openpyxl", reason="needs the extra xlsx")


def read(folder: Path, rows: list[list[Any]]) -> Recording:
    book = openpyxl.Workbook()
    book.active.append(["Operator", "N. N."])
    sheet = book.create_sheet("Data")
    for row in rows:
        sheet.append(row)
    book.save(folder / "run.xlsx")
    return READER.read(folder / "run.xlsx", ColumnMap(), "run", lambda _: None)


def test_titles_and_units(tmp_path: Path) -> None:
    head = [["Run 5"], [], ["Time", "F", "Roll"], ["s", "kN", "deg"]]
    found = read(tmp_path, [*head, *([k / 100.0, 0.5 * k, 3.0 * k] for k in range(50))])
    assert [(one.name, one.unit) for one in found.channels] == [("F", "N"), ("Roll", "rad")]
    assert found.sample_rate_hz == pytest.approx(100.0)
    np.testing.assert_allclose(found.values("F"), 500.0 * np.arange(50), rtol=1e-12)
    np.testing.assert_allclose(found.values("Roll"), np.radians(3.0 * np.arange(50)), rtol=1e-12)
    assert found.provenance["reader"] == "xlsx"


def test_dates_and_a_missing_cell(tmp_path: Path) -> None:
    start = datetime(2025, 3, 1, 23, 59, 59)
    stamps = [start + timedelta(milliseconds=100 * k) for k in range(40)]
    rows = [[stamp, k % 7 + 0.5 if k != 20 else None] for k, stamp in enumerate(stamps)]
    found = read(tmp_path, [["When", "F [N]"], *rows])
    assert found.start_s == pytest.approx(86399.0)
    assert found.end_s == pytest.approx(86402.9)
    assert "repaired" in [flag.code for flag in found.flags]


def test_text_among_numbers_names_its_row(tmp_path: Path) -> None:
    rows = [["Time [s]", "F [N]"], [0.0, 1.0], [0.1, "overload"], [0.2, 1.0]]
    with pytest.raises(DataError, match=r"sheet 'Data', row 3: 'overload' is not a number"):
        read(tmp_path, rows)


def test_no_workbook_is_refused(tmp_path: Path) -> None:
    (tmp_path / "run.xlsx").write_bytes(b"PK\x03\x04 nonsense")
    with pytest.raises(DataError, match="not a sound XLSX file"):
        READER.read(tmp_path / "run.xlsx", ColumnMap(), "run", lambda _: None)
