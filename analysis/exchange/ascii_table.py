"""Plain tables as workshops exchange them: a title, names, units, then numbers in columns."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_WIDTH = 25


def write_table(
    path: Path,
    title: str,
    heads: Sequence[tuple[str, str]],
    values: FloatArray,
    labels: Sequence[str] = (),
) -> None:
    """Write a table.

    Parameters
    ----------
    heads
        Name and unit of each column; the first is the labels' where there are any.
    values
        Shape ``(rows, columns)``, the labels' column left out; 17 digits keep them whole.
    """
    lines = [f"# {title}"]
    for kind in (0, 1):
        names = "".join((head[kind] or "-").replace(" ", "*").rjust(_WIDTH) for head in heads)
        lines.append(f"# {names}")
    for k, row in enumerate(values):
        first = [labels[k].rjust(_WIDTH)] if labels else []
        lines.append("  " + "".join([*first, *(f"{value:{_WIDTH}.16e}" for value in row)]))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_table(path: Path, *, labelled: bool = False) -> tuple[list[str], FloatArray, list[str]]:
    """Read a table: names from the comment line that has as many as there are columns.

    Returns
    -------
    names
        Of the columns.
    values
        Shape ``(rows, columns)``.
    labels
        The first column's, where ``labelled``.

    Raises
    ------
    DataError
        If there is no such file, no line of names fits, or a value is not a finite number.
    """
    if not path.exists():
        raise DataError(f"{path}: no such file")
    comments: list[list[str]] = []
    rows: list[list[float]] = []
    labels: list[str] = []
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if line.lstrip().startswith(("#", "%")):
            comments.append(line.lstrip("#% ").split())
        elif line.strip():
            cells = line.replace(",", " ").split()
            labels += [cells.pop(0)] if labelled else []
            rows.append(_numbers(path, number, cells))
    _check_rows(path, rows)
    width = len(rows[0]) + labelled
    names = next((comment for comment in comments if len(comment) == width), None)
    if names is None:
        raise DataError(f"{path}: no comment line names the {width} columns")
    return names, np.array(rows), labels


def _check_rows(path: Path, rows: Sequence[Sequence[float]]) -> None:
    if not rows:
        raise DataError(f"{path}: the table has no rows")
    for number, row in enumerate(rows, 1):
        if len(row) != len(rows[0]):
            raise DataError(f"{path}, row {number}: {len(row)} values, {len(rows[0])} before")


def _numbers(path: Path, number: int, cells: Sequence[str]) -> list[float]:
    try:
        numbers = [float(cell) for cell in cells]
    except ValueError:
        raise DataError(f"{path}, line {number}: not all of {cells} are numbers") from None
    if not np.isfinite(numbers).all():
        raise DataError(f"{path}, line {number}: a value is not finite")
    return numbers
