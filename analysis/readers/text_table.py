"""The numbers of a text file, read a stretch at a time: nothing of the text is kept."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analysis.readers.headers import Header
from analysis.readers.text_layout import FoundLayout, too_few_cells, too_many_cells
from analysis.readers.text_source import LineStream, TextSource, decoded
from analysis.reading_limits import limits
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_LINE_END = ord("\n")


class Columns(Mapping[Header, FloatArray]):
    """Columns of numbers in the pieces they were read in; each is joined when it is asked for."""

    def __init__(self, headers: Sequence[Header]) -> None:
        self._pieces: dict[Header, list[FloatArray]] = {header: [] for header in headers}

    def add(self, columns: Iterable[Iterable[FloatArray]]) -> None:
        """Add rows: pieces of each column, in the order of the headers."""
        for pieces, rows in zip(self._pieces.values(), columns, strict=True):
            pieces.extend(rows)

    def __getitem__(self, header: Header) -> FloatArray:
        return np.concatenate([np.empty(0), *self._pieces[header]])

    def __iter__(self) -> Iterator[Header]:
        return iter(self._pieces)

    def __len__(self) -> int:
        return len(self._pieces)

    @property
    def rows(self) -> int:
        """Rows so far."""
        return sum(map(len, next(iter(self._pieces.values()), [])))


@dataclass(frozen=True, eq=False)
class Numbers:
    """Some columns of a text file.

    Attributes
    ----------
    columns
        By header, shape ``(rows,)``; NaN where a cell is missing.
    sha256
        Of the whole file.
    flags
        ``row_cut`` where the file ends within a row, which is left out; ``no_final_newline`` where
        its last number may have lost digits.
    """

    columns: Columns
    sha256: str
    flags: tuple[Flag, ...]


def read_numbers(source: TextSource, layout: FoundLayout, wanted: Sequence[Header]) -> Numbers:
    """Read some columns of a text.

    Raises
    ------
    DataError
        For text where numbers belong (with line, column and the text), rows with more or fewer
        cells than the header, and a file without rows.
    """
    where, columns, allowed = str(source.path), Columns(wanted), limits()
    stream = source.lines(layout.first_line)
    try:
        line = layout.first_line + 1
        while text := stream.read():
            columns.add(_read(text, line, layout, wanted, where))
            line += int(np.count_nonzero(np.frombuffer(text, np.uint8) == _LINE_END))
            allowed.check_rows(columns.rows, len(wanted), where)
        last, flags = _last_row(stream, layout)
        columns.add(_read(last, line, layout, wanted, where))
    finally:
        stream.close()
    if not columns.rows:
        raise DataError(f"{where}: there are no rows of data under the header")
    return Numbers(columns, stream.sha256, flags)


def _last_row(stream: LineStream, layout: FoundLayout) -> tuple[bytes, tuple[Flag, ...]]:
    """Return the last row, which is left out if it has fewer cells than the header."""
    row = stream.last_row
    if not row.strip():
        return b"", ()
    cells = len(layout.cells(decoded(row)))
    if cells < layout.fewest_cells:
        message = (
            f"the file ends within a row ({cells} of {len(layout.headers)} cells); "
            "that row is left out"
        )
        return b"", (Flag("row_cut", Severity.WARNING, message),)
    if stream.line_end:
        return row, ()
    message = "the file does not end with a line end: its last number may have lost digits"
    return row, (Flag("no_final_newline", Severity.NOTE, message),)


def _read(
    text: bytes, line: int, layout: FoundLayout, wanted: Sequence[Header], where: str
) -> Iterable[Iterable[FloatArray]]:
    """Read whole lines, the first of which is line ``line`` of the file."""
    if not (text if layout.is_single else text.strip()):
        return [[]] * len(wanted)
    columns = _read_fast(text, layout, wanted)
    if columns is not None:
        return columns
    return [[column] for column in _read_carefully(text, line, layout, wanted, where)]


def _read_fast(
    text: bytes, layout: FoundLayout, wanted: Sequence[Header]
) -> list[list[FloatArray]] | None:
    """Read with Arrow; ``None`` where it finds anything odd, whatever that is."""
    import pyarrow as pa
    from pyarrow import csv

    columns = [str(header.number) for header in wanted]
    try:
        table = csv.read_csv(
            pa.BufferReader(_one_blank(text) if layout.separator == " " else text),
            csv.ReadOptions(
                column_names=[str(header.number) for header in layout.headers],
                use_threads=False,  # one block at a time is the least work
            ),
            csv.ParseOptions(delimiter=layout.separator, ignore_empty_lines=not layout.is_single),
            csv.ConvertOptions(
                column_types=dict.fromkeys(columns, pa.float64()),
                include_columns=columns,
                null_values=[*layout.missing, *(f" {cell}" for cell in layout.missing)],
                decimal_point=layout.decimal,
                check_utf8=False,
            ),
        )
    except pa.ArrowInvalid:
        return None
    return [[_array(chunk) for chunk in column.chunks if len(chunk)] for column in table.columns]


def _array(chunk: Any) -> FloatArray:
    """Return Arrow's numbers, NaN for what is missing; Arrow's own way would load pandas for it."""
    present, numbers = chunk.buffers()
    inside = slice(chunk.offset, chunk.offset + len(chunk))
    values = np.frombuffer(numbers, np.float64)[inside]
    if not chunk.null_count:
        return values
    bits = np.unpackbits(np.frombuffer(present, np.uint8), bitorder="little")
    return np.where(bits[inside], values, np.nan)


def _one_blank(text: bytes) -> bytes:
    """Leave one blank between cells, and none beside a line end."""
    text = text.replace(b"\t", b" ")
    while b"  " in text:
        text = text.replace(b"  ", b" ")
    return text.replace(b" \n", b"\n").replace(b"\n ", b"\n").strip(b" ")


def _read_carefully(
    text: bytes, first: int, layout: FoundLayout, wanted: Sequence[Header], where: str
) -> FloatArray:
    """Read cell by cell, and say where the first thing wrong is."""
    rows = []
    for number, line in enumerate(decoded(text).removesuffix("\n").split("\n"), first):
        if not line.strip() and not layout.is_single:
            continue
        cells = layout.cells(line) if line.strip() else [""]
        if len(cells) > len(layout.headers):
            raise too_many_cells(where, number, len(cells), len(layout.headers))
        if len(cells) < layout.fewest_cells:
            raise too_few_cells(where, number, len(cells), len(layout.headers))
        cells += [""] * (len(layout.headers) - len(cells))
        rows.append(
            [_number(cells, header, layout, f"{where}: line {number}") for header in wanted]
        )
    return np.array(rows, dtype=np.float64).reshape(-1, len(wanted)).T


def _decimal_hint(cell: str, layout: FoundLayout) -> str:
    """Say what to do about a number with the other decimal sign."""
    other = "," if layout.decimal == "." else "."
    try:
        replace(layout, decimal=other).number(cell)
    except ValueError:
        return ""
    return f"with decimal = '{other}' in the column map it is; else "


def _number(cells: list[str], header: Header, layout: FoundLayout, where: str) -> float:
    cell = cells[header.number - 1]
    try:
        return layout.number(cell)
    except ValueError:
        raise DataError(
            f"{where}, column {header.text or header.generic!r}: {cell!r} is not a number; "
            f"{_decimal_hint(cell, layout)}correct it, leave the column out of the column map, or, "
            "where it stands for a missing value, list it there under missing (times are "
            "12:00:01.5, or 2025-03-01 12:00:01.5)"
        ) from None
