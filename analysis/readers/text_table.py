"""The numbers of a text file."""

import gzip
import io
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from analysis.readers.headers import Header
from analysis.readers.text_layout import FoundLayout, too_few_cells, too_many_cells
from analysis.recording import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_GZIP_MARK = b"\x1f\x8b"


def read_bytes(path: Path) -> bytes:
    """Return a file's content.

    Raises
    ------
    DataError
        If it is not there or may not be read.
    """
    try:
        return path.read_bytes()
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None


def unpack(data: bytes, path: Path) -> str:
    """Turn a file's bytes into text: gzip, UTF-8 (with or without mark), UTF-16 or Latin-1.

    Raises
    ------
    DataError
        If the file is empty, its gzip stream is cut short or damaged, or it is not text.
    """
    if path.suffix.lower() == ".gz":
        try:
            data = gzip.decompress(data) if data else data
        except EOFError:
            raise DataError(f"{path}: the gzip file is cut short; copy it again") from None
        except (gzip.BadGzipFile, zlib.error) as error:
            if not data.startswith(_GZIP_MARK):
                raise DataError(f"{path}: not a gzip file, whatever its name says") from None
            raise DataError(f"{path}: not a sound gzip file ({error}); copy it again") from None
    if not data.strip():
        raise DataError(f"{path}: the file is empty")
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = data.decode("utf-16", errors="replace")
    elif b"\0" in data:
        raise DataError(f"{path}: not a text file (it holds zero bytes)")
    else:
        text = _decode(data)
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _decode(data: bytes) -> str:
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def read_numbers(
    text: str, layout: FoundLayout, wanted: Sequence[Header], where: str
) -> tuple[FloatArray, tuple[Flag, ...]]:
    """Read some columns of a text.

    Returns
    -------
    values
        Shape ``(wanted columns, rows)``; NaN where a cell is missing.
    flags
        ``row_cut`` where the file ends within a row, which is left out; ``no_final_newline`` where
        its last number may have lost digits.

    Raises
    ------
    DataError
        For text where numbers belong (with line, column and the text), rows with more or fewer
        cells than the header, and a file without rows.
    """
    body, flags = _complete_rows(_after_line(text, layout.first_line), layout)
    if not body.strip():
        raise DataError(f"{where}: there are no rows of data under the header")
    values = _read_fast(body, layout, wanted)
    if values is None:
        values = _read_carefully(body, layout, wanted, where)
    return values, flags


def _after_line(text: str, line: int) -> str:
    start = 0
    for _ in range(line):
        end = text.find("\n", start)
        start = end + 1 if end >= 0 else len(text)
    return text[start:]


def _complete_rows(body: str, layout: FoundLayout) -> tuple[str, tuple[Flag, ...]]:
    """Leave out a last row that has fewer cells than the header."""
    stripped = body.rstrip("\n")
    start = stripped.rfind("\n") + 1
    cells = layout.cells(stripped[start:])
    if stripped.strip() and len(cells) < layout.fewest_cells:
        message = (
            f"the file ends within a row ({len(cells)} of {len(layout.headers)} cells); "
            "that row is left out"
        )
        return stripped[:start], (Flag("row_cut", Severity.WARNING, message),)
    if stripped and not body.endswith("\n"):
        message = "the file does not end with a line end: its last number may have lost digits"
        return body, (Flag("no_final_newline", Severity.NOTE, message),)
    return body, ()


def _read_fast(body: str, layout: FoundLayout, wanted: Sequence[Header]) -> FloatArray | None:
    """Read with pandas; ``None`` where it finds anything odd, whatever that is."""
    import pandas as pd

    count = len(layout.headers)
    first_row = next(line for line in io.StringIO(body) if line.strip())
    if len(layout.cells(first_row)) != count:
        return None
    columns = {header.number - 1 for header in wanted}
    try:
        frame = pd.read_csv(
            io.StringIO(body),
            sep=r"\s+" if layout.separator == " " else layout.separator,
            decimal=layout.decimal,
            header=None,
            names=list(range(count)),
            index_col=False,
            dtype={column: np.float64 if column in columns else str for column in range(count)},
            na_values=list(layout.missing),
            keep_default_na=False,
            skipinitialspace=True,
        )
    except (ValueError, pd.errors.ParserError):
        return None
    if frame[layout.fewest_cells - 1].isna().any() and _any_short(body, layout):
        return None
    return np.array([frame[header.number - 1].to_numpy() for header in wanted], dtype=np.float64)


def _any_short(body: str, layout: FoundLayout) -> bool:
    """Whether a row has too few cells; pandas fills them up without a word."""
    fewest, separator = layout.fewest_cells, layout.separator
    rows = (line for line in io.StringIO(body) if line.strip())
    if separator == " " or '"' in body:
        return any(len(layout.cells(line)) < fewest for line in rows)
    return any(line.count(separator) < fewest - 1 for line in rows)


def _read_carefully(
    body: str, layout: FoundLayout, wanted: Sequence[Header], where: str
) -> FloatArray:
    """Read cell by cell, and say where the first thing wrong is."""
    rows = []
    for number, line in enumerate(io.StringIO(body), layout.first_line + 1):
        if not line.strip():
            continue
        cells = layout.cells(line)
        if len(cells) > len(layout.headers):
            raise too_many_cells(where, number, len(cells), len(layout.headers))
        if len(cells) < layout.fewest_cells:
            raise too_few_cells(where, number, len(cells), len(layout.headers))
        cells += [""] * (len(layout.headers) - len(cells))
        rows.append(
            [_number(cells, header, layout, f"{where}: line {number}") for header in wanted]
        )
    return np.array(rows, dtype=np.float64).T.copy()


def _number(cells: list[str], header: Header, layout: FoundLayout, where: str) -> float:
    cell = cells[header.number - 1]
    try:
        return layout.number(cell)
    except ValueError:
        raise DataError(
            f"{where}, column {header.text or header.generic!r}: {cell!r} is not a number; "
            "correct it, leave the column out of the column map, or, where it stands for a "
            "missing value, list it there under missing"
        ) from None
