"""The hypothesis that something is there which the catalogue does not have.

It says that some cells (one harmonic of one channel over all runs) deviate, each by an amount that
is alike for runs that are alike in frequency, amplitude, strut phase, speed, medium and drift, and
claims nothing else. Its size is found cell by cell. It pays for its freedom: whatever an effect
explains with three parameters it explains worse, and so it wins only where no effect does well.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import Component, Part, Stack
from analysis.gap.gaussian import Nuisances
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import Medium, SetPoint

SIZES: Final = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)  # of a cell's deviation, in sigma
_OWN = 0.2  # share of a cell's variance that is every run's own
_DRIFT_RAD = 0.1  # of drift, after which runs are hardly alike
_SWEEPS = 2
# What these show is known by its nature: the drive's speed, or the photocell.
_TIMING: Final = (Part.FREQUENCY, Part.PULSES, Part.PERIOD_SCATTER)
_NOWHERE = 6.0  # log odds against a deviation that shows in no cell
_CHOICE = 7.0  # log odds against any one cell of some sixty, and any one size


@dataclass(frozen=True, eq=False)
class Deviation:
    """What deviates when nothing of the catalogue is assumed.

    Attributes
    ----------
    sizes
        Standard deviation in sigma by component; cells that do not deviate are left out.
    mean
        The deviation, shape ``(observations,)``, in sigma.
    """

    sizes: dict[Component, float]
    mean: FloatArray
    log_evidence: float


@dataclass(eq=False)
class _Cell:
    rows: NDArray[np.intp]
    values: FloatArray  # eigenvalues of the likeness of the runs
    vectors: FloatArray
    residual: FloatArray  # in the eigenvectors' coordinates
    columns: FloatArray
    size: float = 0.0

    def terms(self, size: float) -> tuple[float, FloatArray, FloatArray, float]:
        """Return log determinant, N^T B^-1 N, N^T B^-1 r and r^T B^-1 r with B = 1 + size^2 K."""
        weight = 1.0 / (1.0 + size**2 * self.values)
        scaled = self.columns * weight[:, None]
        square = float(self.residual @ (weight * self.residual))
        logs = float(-np.sum(np.log(weight)))
        return logs, self.columns.T @ scaled, scaled.T @ self.residual, square


def find_deviation(stack: Stack, residual: FloatArray, nuisances: Nuisances) -> Deviation:
    """Return which cells deviate, and the evidence that they do."""
    cells = _cells(stack, residual, nuisances)
    sums = _Sums(cells, nuisances.columns.shape[1])
    for _ in range(_SWEEPS):
        for component, cell in cells.items():
            if component.part not in _TIMING:
                sums.choose(cell)
    chosen = {name: cell.size for name, cell in cells.items() if cell.size}
    found = sums.log_evidence - (0.0 if chosen else _NOWHERE)
    return Deviation(chosen, _mean(cells, sums, len(residual)), found)


class _Sums:
    """The sums over all cells that the evidence needs, updated as cells change."""

    def __init__(self, cells: dict[Component, _Cell], count: int) -> None:
        self._logs, self._square, self._chosen = 0.0, 0.0, 0
        self._gram, self._right = np.eye(count), np.zeros(count)
        for cell in cells.values():
            self._change(cell, 1.0)

    @property
    def nuisances(self) -> FloatArray:
        """The nuisances' most probable values."""
        return np.asarray(np.linalg.solve(self._gram, self._right), np.float64)

    @property
    def log_evidence(self) -> float:
        """With the cells as they are."""
        explained = float(self._right @ self.nuisances)
        determinant = float(np.linalg.slogdet(self._gram)[1])
        return -0.5 * (self._logs + determinant + self._square - explained) - _CHOICE * self._chosen

    def choose(self, cell: _Cell) -> None:
        """Give a cell the size that makes the data most probable, 0 included."""
        self._change(cell, -1.0)
        scores = [(self._with(cell, size), size) for size in (0.0, *SIZES)]
        cell.size = max(scores)[1]
        self._change(cell, 1.0)

    def _with(self, cell: _Cell, size: float) -> float:
        cell.size = size
        self._change(cell, 1.0)
        found = self.log_evidence
        self._change(cell, -1.0)
        return found

    def _change(self, cell: _Cell, sign: float) -> None:
        logs, gram, right, square = cell.terms(cell.size)
        self._logs += sign * logs
        self._gram = self._gram + sign * gram
        self._right = self._right + sign * right
        self._square += sign * square
        self._chosen += round(sign) * (cell.size > 0.0)


def _cells(stack: Stack, residual: FloatArray, nuisances: Nuisances) -> dict[Component, _Cell]:
    alike = likeness([run.set_point for run in stack.runs])
    found = {}
    for component in dict.fromkeys(stack.components):
        rows = np.array([at for at, one in enumerate(stack.components) if one == component])
        runs = stack.run[rows]
        values, vectors = np.linalg.eigh(alike[np.ix_(runs, runs)])
        found[component] = _Cell(
            rows,
            np.maximum(values, 0.0),
            vectors,
            vectors.T @ residual[rows],
            vectors.T @ nuisances.columns[rows],
        )
    return found


def _mean(cells: dict[Component, _Cell], sums: _Sums, count: int) -> FloatArray:
    mean, fitted = np.zeros(count), sums.nuisances
    for cell in cells.values():
        variance = cell.size**2 * cell.values
        left = cell.residual - cell.columns @ fitted
        mean[cell.rows] = cell.vectors @ (variance / (1.0 + variance) * left)
    return mean


def likeness(set_points: Sequence[SetPoint]) -> FloatArray:
    """Return how alike a deviation is between runs, shape ``(runs, runs)``; 1 on the diagonal."""
    places = np.array([_place(one) for one in set_points])
    distance = np.sum((places[:, None, :] - places[None, :, :]) ** 2, axis=2)
    shared = (1.0 - _OWN) * np.exp(-0.5 * distance)
    return np.asarray(shared + _OWN * np.eye(len(places)))


def _place(one: SetPoint) -> tuple[float, ...]:
    return (
        math.log(one.frequency_hz),
        math.log(max(one.eccentricity_m, 1e-6)),
        math.cos(one.strut_phase_rad),
        math.sin(one.strut_phase_rad),
        one.carriage_speed_m_s,
        2.0 * (one.medium is Medium.AIR),
        one.drift_rad / _DRIFT_RAD,
    )
