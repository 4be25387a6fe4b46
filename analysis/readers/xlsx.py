"""Recordings from Excel: XLSX files, by the package openpyxl (extra ``xlsx``).

The first sheet with a row of numbers is read as a text file would be: titles, header, a line of
units, dates and times of day. Formulas count as the values that Excel kept with them.
"""

from collections.abc import Iterator, Sequence
from datetime import date, datetime, time
from itertools import chain, islice
from pathlib import Path
from typing import Any, Final
from zipfile import BadZipFile

import numpy as np

from analysis.foreign.columns import ForeignColumns
from analysis.readers.clock import CLOCK, DATE
from analysis.readers.columns import TextLayout
from analysis.readers.foreign import foreign_reader
from analysis.readers.text_layout import HEAD_LINES, FoundLayout, layout_of
from hardware.description.errors import DataError

_LAYOUT: Final = TextLayout(separator="\t", decimal=".")


def read_xlsx(path: Path) -> ForeignColumns:
    """Return the columns of the first sheet that holds numbers.

    Raises
    ------
    DataError
        If it is no XLSX file that can be read, no sheet has numbers, or a cell is no number.
    """
    from openpyxl import load_workbook
    from openpyxl.utils.exceptions import InvalidFileException

    try:
        with path.open("rb") as raw:
            book = load_workbook(raw, read_only=True, data_only=True)
            sheets = [sheet for sheet in book.worksheets if _has_numbers(sheet)]
            if not sheets:
                raise DataError("no sheet has a row of numbers")
            return _columns(sheets[0].iter_rows(values_only=True), str(sheets[0].title))
    except (InvalidFileException, BadZipFile, OSError, KeyError, ValueError) as error:
        raise DataError(f"not a sound XLSX file: {error}") from None


READER: Final = foreign_reader("xlsx", read_xlsx, "openpyxl")


def _has_numbers(sheet: Any) -> bool:
    rows = islice(sheet.iter_rows(values_only=True), HEAD_LINES)
    return any(isinstance(cell, int | float) for row in rows for cell in row)


def _columns(rows: Iterator[Sequence[Any]], sheet: str) -> ForeignColumns:
    head = list(islice(rows, HEAD_LINES))
    text = "\n".join("\t".join(map(_text, row)) for row in head)
    layout = layout_of(text, _LAYOUT, f"sheet {sheet!r}")
    table = np.array(list(_numbers(chain(head, rows), layout, sheet)))
    values, units = {}, {}
    for header, column in zip(layout.headers, table.T, strict=True):
        if header.text or np.isfinite(column).any():
            name = header.text or header.generic
            values[name] = column
            units[name] = header.unit if header.unit in (CLOCK, DATE) else ""
    return ForeignColumns(values, units)


def _numbers(
    rows: Iterator[Sequence[Any]], layout: FoundLayout, sheet: str
) -> Iterator[list[float]]:
    """Yield the rows under the header, but for empty ones."""
    count = len(layout.headers)
    for line, row in enumerate(rows, 1):
        cells = [*row[:count], *[None] * (count - len(row))]
        if line > layout.first_line and any(cell is not None for cell in row):
            yield [_number(cell, layout, f"sheet {sheet!r}, row {line}") for cell in cells]


def _number(cell: Any, layout: FoundLayout, where: str) -> float:
    if isinstance(cell, int | float):
        return float(cell)
    try:
        return layout.number(_text(cell))
    except ValueError:
        raise DataError(f"{where}: {cell!r} is not a number; correct it") from None


def _text(cell: Any) -> str:
    """Return a cell as it would stand in a text file."""
    if cell is None:
        return ""
    if isinstance(cell, datetime | date | time):
        return cell.isoformat()
    return " ".join(str(cell).split())
