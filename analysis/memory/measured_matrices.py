"""Added mass and damping over frequency as a campaign measured them at rest: what a memory fits."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import PLACES, Form, MatrixElement, name_of
from analysis.coefficients.zero_frequency import own_variance
from analysis.uncertainty.values import UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Plane
from sim.model.water.table_files import DEGREES_OF_FREEDOM

FEWEST: Final = 4
"""Frequencies: two states, a constant and a damping of one motion are five numbers."""
_UNLIKE: Final = 3.0  # standard uncertainties, root mean square: coupling of both ways is unlike
# Rows and columns of the elements, by the number of degrees of freedom: of a symmetric matrix.
_PAIRS: Final = {1: ((0, 0),), 2: ((0, 0), (0, 1), (1, 1))}

_Rows = Mapping[MatrixElement, Mapping[float, int]]


@dataclass(frozen=True, eq=False)
class MeasuredMatrix:
    """Added mass A and damping B of the motions that are fitted together, at k frequencies.

    Attributes
    ----------
    dofs
        0 for translation, 1 for rotation, or both.
    omega_rad_s
        Shape ``(k,)``, rising.
    uncertain
        Element by element of the symmetric matrix (11, or 11, 12, 22): A at each frequency, then
        B; SI units, of what the struts exert, ``2 k e`` in all.
    skew
        One value, N s: by how much the damping 12 is above, and 21 below, that of the symmetric
        matrix at all frequencies. It does no work. 0 where one way alone was measured.
    unlike
        By how many standard uncertainties the coupling of both ways differs beside that, root mean
        square; at rest it is the same.
    """

    plane: Plane
    dofs: tuple[int, ...]
    omega_rad_s: FloatArray
    uncertain: UncertainValues
    skew: UncertainValues = field(default_factory=lambda: UncertainValues(np.zeros(1)))
    unlike: float = 0.0

    @property
    def elements(self) -> tuple[tuple[int, int], ...]:
        """Row and column of each element."""
        return tuple((self.dofs[i], self.dofs[j]) for i, j in _PAIRS[len(self.dofs)])

    @property
    def names(self) -> tuple[tuple[str, str], ...]:
        """What added mass and damping of each element are called: ``("a33", "b33")`` ..."""
        return tuple(
            (
                name_of(MatrixElement(row, column, True), self.plane, Form.SEAKEEPING),
                name_of(MatrixElement(row, column, False), self.plane, Form.SEAKEEPING),
            )
            for row, column in self.elements
        )

    @property
    def motions(self) -> str:
        """The degrees of freedom for people: ``heave and pitch``, ``sway`` ..."""
        return " and ".join(motions_of(self.plane)[dof] for dof in self.dofs)

    @property
    def coupling_differs(self) -> bool:
        """Whether the coupling of one way is not that of the other."""
        return self.unlike > _UNLIKE

    def shaped(self, values: FloatArray) -> FloatArray:
        """Return 2 k e values as element, A or B, frequency: shape ``(e, 2, k)``."""
        return values.reshape(len(self.elements), 2, -1)


def motions_of(plane: Plane) -> tuple[str, ...]:
    """Return what both degrees of freedom are called."""
    return tuple(name.lower() for name in DEGREES_OF_FREEDOM[plane])


def measured_matrices(coefficients: CampaignCoefficients) -> tuple[MeasuredMatrix, ...]:
    """Return what was measured at rest at four frequencies or more.

    Both motions together where they share the frequencies, else each by itself. Coupling that was
    measured both ways is averaged by its scatter: at rest both are the same, but for a damping that
    does not depend on the frequency.

    Parameters
    ----------
    coefficients
        In SI units.
    """
    rows = _rows(coefficients)
    joint = _matrix(coefficients, rows, (0, 1))
    if joint is not None:
        return (joint,)
    return tuple(
        matrix for dof in (0, 1) if (matrix := _matrix(coefficients, rows, (dof,))) is not None
    )


def _rows(coefficients: CampaignCoefficients) -> _Rows:
    """Return where each coefficient at rest stands in the table, by its frequency."""
    names = {place: name_of(place, coefficients.plane, coefficients.form) for place in PLACES}
    return {
        place: {
            round(coefficients.entries[k].frequency_hz, 4): k
            for k in coefficients.at_each_frequency(name, 0.0)
        }
        for place, name in names.items()
    }


def _matrix(
    coefficients: CampaignCoefficients, rows: _Rows, dofs: tuple[int, ...]
) -> MeasuredMatrix | None:
    """Return what was measured of some degrees of freedom; ``None`` of too few frequencies."""
    pairs = [(dofs[i], dofs[j]) for i, j in _PAIRS[len(dofs)]]
    ways = [[(i, j), (j, i)] if i != j else [(i, j)] for i, j in pairs]
    rows_of_elements = [
        [[rows[MatrixElement(*way, inertial)] for way in pair_ways] for inertial in (True, False)]
        for pair_ways in ways
    ]
    hertz = [
        frequency
        for frequency in sorted(
            set().union(*(way for readings in rows_of_elements[0] for way in readings))
        )
        if all(
            any(frequency in way for way in readings)
            for element in rows_of_elements
            for readings in element
        )
    ]
    if len(hertz) < FEWEST:
        return None
    row_groups = [
        [way[frequency] for way in readings if frequency in way]
        for element in rows_of_elements
        for readings in element
        for frequency in hertz
    ]
    values = coefficients.uncertain.select([k for group in row_groups for k in group])
    values = values.scaled(np.full(len(values), coefficients.form.sign))
    columns, variances = list(_columns(row_groups)), own_variance(values)
    shift, signs = np.zeros(len(values)), np.zeros((len(row_groups), 2))
    damping = slice(3 * len(hertz), 4 * len(hertz))  # of the coupling, where there is one
    if len(dofs) == 2 and all(len(column) == 2 for column in columns[damping]):
        signs[damping] = (1.0, -1.0)
        shift = _skew(columns[damping], variances)
    mean, squares = np.zeros((len(row_groups), len(values))), []
    beta = float(shift @ values.values)
    for row, column in enumerate(columns):
        weights = 1.0 / variances[column]
        mean[row, column] = weights / weights.sum()
        mean[row] -= (signs[row, : len(column)] @ weights / weights.sum()) * shift
        if len(column) == 2:
            difference = (
                values.values[column[0]] - values.values[column[1]] - 2.0 * signs[row, 0] * beta
            )
            squares.append(difference**2 / float(variances[column].sum()))
    omega = np.array(
        [coefficients.entries[group[0]].frequency_hz for group in row_groups[: len(hertz)]]
    )
    return MeasuredMatrix(
        coefficients.plane,
        dofs,
        2.0 * np.pi * omega,
        values.mapped(mean),
        values.mapped(shift[None, :]),
        float(np.sqrt(np.mean(squares))) if squares else 0.0,
    )


def _skew(columns: Sequence[Sequence[int]], variances: FloatArray) -> FloatArray:
    """Return what half the mean difference of both ways is of the values."""
    shift = np.zeros(variances.size)
    for first, second in columns:
        weight = 0.5 / (variances[first] + variances[second])
        shift[first], shift[second] = weight, -weight
    return np.asarray(shift * 0.5 / shift[shift > 0.0].sum())


def _columns(row_groups: Sequence[Sequence[int]]) -> Iterator[list[int]]:
    """Yield where the values of each stand in what was taken."""
    first = 0
    for group in row_groups:
        yield list(range(first, first + len(group)))
        first += len(group)
