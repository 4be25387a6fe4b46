"""SIMMAN's deliverables as files: averaged cycle, Fourier coefficients, description; out and in.

They are plain tables as workshops exchange them: a title, names, units, then numbers in columns.
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.exchange.simman import (
    AHEAD,
    AHEAD_UNITS,
    NAMES,
    UNITS,
    Deliverables,
    SimmanDescription,
    fourier,
)
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane

CYCLE_FILE: Final = "cycle.dat"
FOURIER_FILE: Final = "fourier.dat"
DESCRIPTION_FILE: Final = "description.txt"
_FILES: Final = (CYCLE_FILE, FOURIER_FILE, DESCRIPTION_FILE)
_LOADS_ARE: Final = "of the water and of the model's inertia on the model"
_WIDTH = 25


def write_simman(deliverables: Deliverables, folder: Path, *, overwrite: bool = False) -> Path:
    """Write ``cycle.dat``, ``fourier.dat`` and ``description.txt`` into a folder.

    Raises
    ------
    DataError
        If one of them is there and may not be replaced.
    """
    existing = [name for name in _FILES if (folder / name).exists()]
    if existing and not overwrite:
        raise DataError(f"{folder}: {', '.join(existing)} there already; choose another folder")
    folder.mkdir(parents=True, exist_ok=True)
    units = _units(deliverables.plane)
    names = [name for name in ("t", *units) if name in deliverables.columns]
    title = f"{deliverables.description.run}: one averaged cycle, SI units, model scale"
    write_table(
        folder / CYCLE_FILE,
        title,
        [(name, "s" if name == "t" else units[name]) for name in names],
        np.stack([deliverables.columns[name] for name in names], axis=1),
    )
    orders = len(next(iter(deliverables.sine.values())))
    heads = [("channel", ""), ("A0", "SI")]
    heads += [(f"{part}{n}", "SI") for n in range(1, orders + 1) for part in "SC"]
    rows = []
    for name in deliverables.mean:
        parts = np.stack((deliverables.sine[name], deliverables.cosine[name]), axis=1).ravel()
        rows.append([deliverables.mean[name], *parts])
    write_table(
        folder / FOURIER_FILE,
        f"{deliverables.description.run}: A0 + sum Sn sin(n theta) + Cn cos(n theta), "
        "theta = 0 at t = 0",
        heads,
        np.array(rows),
        labels=list(deliverables.mean),
    )
    (folder / DESCRIPTION_FILE).write_text(_description_text(deliverables), encoding="utf-8")
    return folder


def _units(plane: Plane) -> dict[str, str]:
    names = NAMES[plane]
    first = dict(zip(("X", *names[:2]), ("N", *UNITS[:2]), strict=True))
    return first | dict(zip(AHEAD, AHEAD_UNITS, strict=True)) | dict(
        zip(names[2:], UNITS[2:], strict=True)
    )  # fmt: skip


def _description_text(deliverables: Deliverables) -> str:
    rows: list[tuple[str, Any]] = [
        ("plane", str(deliverables.plane)),
        ("frequency_hz", deliverables.frequency_hz),
        ("speed_m_s", deliverables.speed_m_s),
        ("drift_rad", deliverables.drift_rad),
        ("loads", _LOADS_ARE),
        ("axes", "x ahead, y to starboard, z down, origin midway between the struts"),
    ]
    rows += [
        (item.name, getattr(deliverables.description, item.name))
        for item in fields(deliverables.description)
    ]
    lines = (f"{key} = {_as_text(value)}" for key, value in rows if value not in (None, ""))
    return "\n".join(lines) + "\n"


def _as_text(value: Any) -> str:
    return repr(float(value)) if isinstance(value, float) else str(value)


def read_simman(folder: Path) -> Deliverables:
    """Read deliverables: what :func:`write_simman` wrote, or another tank in the same layout.

    Without ``fourier.dat`` the Fourier coefficients are taken from the averaged cycle.

    Raises
    ------
    DataError
        If a file or a column is missing, or a value is not a number; the message names it.
    """
    entries = _read_description(folder / DESCRIPTION_FILE)
    plane = _plane(folder, entries)
    heads, values, _ = read_table(folder / CYCLE_FILE)
    columns = dict(zip(heads, values.T, strict=True))
    needed = ("t", *NAMES[plane][:4])
    missing = [name for name in needed if name not in columns]
    if missing:
        raise DataError(
            f"{folder / CYCLE_FILE}: no column {', '.join(missing)} (columns: {', '.join(heads)})"
        )
    if (folder / FOURIER_FILE).exists():
        mean, sine, cosine = _read_fourier(folder / FOURIER_FILE)
    else:
        mean, sine, cosine = fourier(columns)
    return Deliverables(
        plane,
        _number(folder, entries, "frequency_hz"),
        _number(folder, entries, "speed_m_s"),
        float(entries.get("drift_rad", 0.0)),
        _description(folder, entries),
        columns,
        mean,
        sine,
        cosine,
    )


def _read_fourier(
    path: Path,
) -> tuple[dict[str, float], dict[str, FloatArray], dict[str, FloatArray]]:
    _, values, labels = read_table(path, labelled=True)
    return (
        {name: float(row[0]) for name, row in zip(labels, values, strict=True)},
        {name: row[1::2].copy() for name, row in zip(labels, values, strict=True)},
        {name: row[2::2].copy() for name, row in zip(labels, values, strict=True)},
    )


def _read_description(path: Path) -> dict[str, str]:
    if not path.exists():
        raise DataError(f"{path}: no such file; it says speed, frequency and plane of the run")
    lines = path.read_text(encoding="utf-8").splitlines()
    pairs = (line.partition("=") for line in lines if "=" in line)
    return {key.strip(): value.strip() for key, _, value in pairs}


def _plane(folder: Path, entries: Mapping[str, str]) -> Plane:
    text = entries.get("plane", str(Plane.HORIZONTAL))
    try:
        return Plane(text)
    except ValueError:
        raise DataError(
            f"{folder / DESCRIPTION_FILE}: plane = {text!r}; it is {' or '.join(Plane)}"
        ) from None


def _number(folder: Path, entries: Mapping[str, str], key: str) -> float:
    try:
        return float(entries[key])
    except KeyError:
        raise DataError(f"{folder / DESCRIPTION_FILE}: {key} is missing") from None
    except ValueError:
        raise DataError(
            f"{folder / DESCRIPTION_FILE}: {key} = {entries[key]!r} is not a number"
        ) from None


def _description(folder: Path, entries: Mapping[str, str]) -> SimmanDescription:
    values: dict[str, Any] = {"run": entries.get("run", folder.name)}
    for item in fields(SimmanDescription):
        if item.name not in entries or item.name == "run":
            continue
        if item.name == "campaign":
            values[item.name] = entries[item.name]
        elif item.name == "periods":
            values[item.name] = int(_number(folder, entries, item.name))
        else:
            values[item.name] = _number(folder, entries, item.name)
    return SimmanDescription(**values)


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
