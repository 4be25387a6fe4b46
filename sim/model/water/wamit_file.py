"""Added mass and damping as WAMIT writes them (``.1``), and panel methods that write as it does.

Each row has a period, the force's and the motion's mode (1 to 6: surge, sway, heave, roll, pitch,
yaw; 7 to 12 of a second body), and values over the water's density and powers of a length L:

    A = rho L^k a,    B = rho L^k w b,    k = 3 + (one of the modes turns) + (both do)

Modes that the body's symmetry lets vanish are left out. A period of 0 stands for an infinite
frequency, a negative one for none; neither row has a damping. Axes are those of
:mod:`sim.model.water.table_files` (WAMIT User Manual, chapters 3 and 5).
"""

import math
from enum import StrEnum
from pathlib import Path
from typing import Final

import numpy as np

from hardware.description.errors import DataError
from hardware.description.oscillator import Plane
from sim.model.water.table_files import coupling_signs
from sim.model.water.tables import RadiationTable

MODES: Final = {Plane.VERTICAL: (3, 5), Plane.HORIZONTAL: (2, 6)}
_PER_BODY: Final = 6
_ROUNDING: Final = 1e-9  # of the largest value of a plane

Values = dict[tuple[float, int, int], tuple[float, float]]


class FirstColumn(StrEnum):
    """What the rows of a file begin with: seconds, or radians a second."""

    PERIOD = "period"
    FREQUENCY = "frequency"


def read_wamit(
    path: Path,
    plane: Plane,
    density_kg_m3: float,
    length_m: float = 1.0,
    body: int = 1,
    rotation_sign: int = 1,
    first_column: FirstColumn = FirstColumn.PERIOD,
) -> RadiationTable:
    """Read one plane of one body, about the origin of its axes.

    Parameters
    ----------
    density_kg_m3, length_m
        What the values are made dimensionless by: of the water, and the geometry file's ``ULEN``.
    body
        Number of the body, from 1.
    rotation_sign
        -1 where the file's rotation has the other sign relative to its translation.

    Raises
    ------
    DataError
        If a row is none of such a file or there twice, or the body moves in no mode of the plane.
    """
    values = _values(path, first_column)
    modes = [mode + _PER_BODY * (body - 1) for mode in MODES[plane]]
    if not any(key[1] in modes and key[2] in modes for key in values):
        present = ", ".join(str(mode) for mode in sorted({key[1] for key in values}))
        raise DataError(
            f"{path}: no added mass of modes {modes[0]} and {modes[1]}; forces are there in modes "
            f"{present or 'none'}; state body, or compute these modes"
        )
    omega = np.array(sorted({key[0] for key in values}))
    matrices = np.array([
        [[values.get((w, i, j), (0.0, 0.0)) for j in modes] for i in modes] for w in omega
    ])  # fmt: skip
    powers = np.array([[1.0, length_m], [length_m, length_m**2]])
    size = density_kg_m3 * length_m**3 * powers * coupling_signs(rotation_sign)
    # What a body of revolution has of yaw, and what else cancels, is the computer's rounding.
    most = np.abs(matrices).max(axis=0)
    matrices[:, most < _ROUNDING * most.max(axis=(0, 1))] = 0.0
    finite = np.isfinite(omega)
    added, damping = matrices[..., 0] * size, matrices[finite, ..., 1] * size
    return RadiationTable(
        plane,
        omega[finite],
        added[finite],
        damping * omega[finite, None, None],
        None if finite.all() else added[~finite][0],
        name=path.name,
    )


def _values(path: Path, first: FirstColumn) -> Values:
    """Return added mass and damping by frequency and both modes, as the file has them."""
    values: Values = {}
    for number, line in enumerate(path.read_text(encoding="utf-8-sig").splitlines(), 1):
        if line.strip():
            key, pair = _row(path, number, line, first)
            if key in values:
                raise DataError(
                    f"{path}, line {number}: modes {key[1]} and {key[2]} at {key[0]:g} rad/s are "
                    "there twice"
                )
            values[key] = pair
    return values


def _row(
    path: Path, number: int, line: str, first: FirstColumn
) -> tuple[tuple[float, int, int], tuple[float, float]]:
    row = _numbers(line.split(), first)
    if row is None:
        raise DataError(
            f"{path}, line {number}: {line.strip()!r} is no row of a WAMIT .1 file: {first}, two "
            "modes, added mass and damping"
        )
    return row


def _numbers(
    cells: list[str], first: FirstColumn
) -> tuple[tuple[float, int, int], tuple[float, float]] | None:
    try:
        value, a, *b = (float(cell) for cell in (cells[0], *cells[3:]))
        i, j = (int(cell) for cell in cells[1:3])
    except (ValueError, IndexError):
        return None
    limit = value <= 0.0 if first is FirstColumn.PERIOD else value == 0.0
    complete = len(b) == 1 or (limit and not b)
    if not (complete and math.isfinite(value + a + sum(b)) and min(i, j) > 0):
        return None
    omega = _omega(value, first)
    return None if omega < 0.0 else ((omega, i, j), (a, 0.0 if limit else b[0]))


def _omega(value: float, first: FirstColumn) -> float:
    if first is FirstColumn.FREQUENCY:
        return value
    return math.inf if value == 0.0 else 2.0 * math.pi / value if value > 0.0 else 0.0
