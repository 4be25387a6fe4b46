"""Fit the memory of the water to a table of added mass and damping.

The identification runs in the frequency domain, on A + B/(i w) at the table's frequencies, by
vector fitting (:mod:`sim.model.water.vector_fitting`) with a damping that is nowhere negative
(:mod:`sim.model.water.passive_fit`). The added mass at infinite frequency is fitted along unless
the table has it.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from sim.model.water.fitted_memory import FittedMemory, scales
from sim.model.water.passive_fit import passive_fit
from sim.model.water.radiation import constant
from sim.model.water.tables import UNCERTAINTY, RadiationTable
from sim.model.water.vector_fitting import (
    PartialFractions,
    SampledTable,
    fitted_poles,
    fitted_residues,
    input_column,
    state_matrix,
)

# Relative to the diagonal: below it a table's coupling is rounding, and the two degrees of freedom
# are fitted one by one.
COUPLING_IS_NOISE: Final = 1e-4
_FEWEST: Final = 2  # states
_MOST: Final = 12
_MOST_CHOSEN: Final = 10
_SHARE: Final = 2.0 / 3.0  # of the table's values that a fit may have numbers for
# Rows and columns of the elements that are fitted, by the number of degrees of freedom.
_INDICES: Final = {1: ((0,), (0,)), 2: ((0, 0, 1), (0, 1, 1))}


def fit_memory(
    table: RadiationTable,
    states: int | None = None,
    *,
    uncertainty: float = UNCERTAINTY,
) -> FittedMemory:
    """Return the passive memory that comes nearest to the table.

    Least squares of the relative deviations, by relaxed vector fitting. Where the degrees of
    freedom are coupled, both are fitted together, with common poles.

    Parameters
    ----------
    states
        States for each degree of freedom, 2 to 12. ``None``: the fewest, up to 10, whose misfit is
        not above the uncertainty of the table; where none reaches it, those that come nearest.
    uncertainty
        Standard uncertainty of the table's values, relative.

    Raises
    ------
    ConfigurationError
        If ``states`` or ``uncertainty`` is out of range.
    DataError
        If the table has fewer frequencies than states, or its coupling is not symmetric.
    """
    _check(table, states, uncertainty)
    target = _Target(table.symmetrised())
    fits = [(dofs, *_fitted(target.of(dofs), states, uncertainty)) for dofs in target.groups()]
    infinite = target.table.added_mass_infinite
    added = np.array(target.table.added_mass[-1] if infinite is None else infinite)
    radiation = constant(added)
    for dofs, fit, _ in fits:
        radiation = radiation.joined(*state_space(fit, dofs, target.unit, target.middle))
        added[np.ix_(dofs, dofs)] = symmetric(fit.infinite) * target.unit[np.ix_(dofs, dofs)]
    radiation = replace(radiation, added_mass_infinite=added)
    loss = max((loss for *_, loss in fits), default=1.0)
    return FittedMemory(radiation, target.table, uncertainty, loss)


def _fitted(
    samples: SampledTable, states: int | None, uncertainty: float
) -> tuple[PartialFractions, float]:
    """Return the fit, and by which factor its misfit is larger for the damping's condition."""
    elements, k = samples.values.shape
    most = min(_MOST_CHOSEN, max(_FEWEST, int(_SHARE * 2 * k * elements / (1 + elements))))
    counts = range(_FEWEST, most + 1) if states is None else (states,)
    tried: list[tuple[float, int, PartialFractions]] = []
    for count in counts:
        plain, _ = fitted_residues(samples, fitted_poles(samples, count))
        tried.append((_per_freedom(samples, plain), count, plain))
        if tried[-1][0] <= uncertainty:
            fit = passive_fit(samples, plain.poles)
            if _per_freedom(samples, fit) <= uncertainty:
                return fit, _loss(samples, fit, plain)
    fits = [(passive_fit(samples, plain.poles), plain) for *_, plain in sorted(tried)[:2]]
    fit, plain = min(fits, key=lambda pair: _per_freedom(samples, pair[0]))
    return fit, _loss(samples, fit, plain)


def _loss(samples: SampledTable, fit: PartialFractions, plain: PartialFractions) -> float:
    misfit = plain.misfit(samples)
    return fit.misfit(samples) / misfit if misfit > 0.0 else 1.0


def _per_freedom(samples: SampledTable, fit: PartialFractions) -> float:
    """Return the root mean square deviation for each degree of freedom that the fit leaves."""
    elements, count = fit.residues.shape
    data = 2 * samples.values.size
    numbers = count + elements * (count - 1 + (samples.infinite is None))
    return fit.misfit(samples) * math.sqrt(data / max(data - numbers, 1))


@dataclass(frozen=True)
class _Target:
    """The table in units in which all that is fitted is of the order of one.

    Frequencies are divided by their geometric middle, masses by the root of the largest of either
    degree of freedom.
    """

    table: RadiationTable

    @property
    def rows(self) -> slice:
        """The frequencies above 0, where B + i w A tells A."""
        return slice(int(self.table.omega_rad_s[0] == 0.0), None)

    def groups(self) -> Iterator[tuple[int, ...]]:
        """Yield the degrees of freedom that radiate: each alone, or both where they are coupled."""
        freedoms = [i for i in (0, 1) if self.table.damping[:, i, i].any()]
        if len(freedoms) == 2 and self.coupling > COUPLING_IS_NOISE:
            yield (0, 1)
            return
        yield from ((i,) for i in freedoms)

    @property
    def middle(self) -> float:
        """Unit of frequency, rad/s."""
        omega = self.table.omega_rad_s[self.rows]
        return math.sqrt(float(omega[0]) * float(omega[-1]))

    @property
    def unit(self) -> FloatArray:
        """Unit of mass of each element, ``(2, 2)``."""
        largest = np.abs(self.table.added_mass[:, (0, 1), (0, 1)]).max(axis=0)
        root = np.sqrt(np.where(largest > 0.0, largest, 1.0))
        return np.outer(root, root)

    @property
    def coupling(self) -> float:
        """Largest coupling, relative to the diagonal."""
        matrices = (self.table.added_mass, self.table.damping)
        parts = zip(matrices, scales(self.table), strict=True)
        return float(max(np.abs(x[self.rows] / s[self.rows])[:, 0, 1].max() for x, s in parts))

    def of(self, dofs: tuple[int, ...]) -> SampledTable:
        """Return what has to be reproduced for some degrees of freedom."""
        first, second = (np.take(dofs, at) for at in _INDICES[len(dofs)])
        omega = self.table.omega_rad_s[self.rows]
        unit = self.unit[first, second]

        def elements(matrices: FloatArray) -> FloatArray:
            return np.asarray(matrices[self.rows][:, first, second].T / unit[:, None])

        scale_a, scale_b = map(elements, scales(self.table))
        values = elements(self.table.added_mass) - 1j * elements(self.table.damping) / omega
        infinite = self.table.added_mass_infinite
        infinite_mass = None if infinite is None else infinite[first, second] / unit
        weights = np.hstack([1.0 / scale_a, omega / scale_b])
        return SampledTable(omega / self.middle, values, weights, infinite_mass)


def state_space(
    fit: PartialFractions, dofs: Sequence[int], unit: FloatArray, middle: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return state, input and output matrix in SI units, input and output equally large.

    Parameters
    ----------
    dofs
        The degrees of freedom that the fit is of: 0, 1 or both.
    unit, middle
        What the fit's masses, shape ``(2, 2)``, and its frequencies are divided by.
    """
    state, column = state_matrix(fit.poles), input_column(fit.poles)
    n, m = len(state), len(dofs)
    residues = np.array([symmetric(residue) for residue in fit.residues.T])  # (n, m, m)
    residues = residues * unit[np.ix_(dofs, dofs)] * middle
    inputs, outputs = np.zeros((m * n, 2)), np.zeros((2, m * n))
    for j, dof in enumerate(dofs):
        block = slice(j * n, (j + 1) * n)
        # K = s (M - A_inf), and the residues add up to zero: the output is R A.
        answers = residues[:, :, j].T @ state * middle
        size = math.sqrt(float(np.linalg.norm(answers) / np.linalg.norm(column))) or 1.0
        inputs[block, dof] = size * column
        outputs[list(dofs), block] = answers / size
    return np.asarray(np.kron(np.eye(m), state * middle), np.float64), inputs, outputs


def symmetric(elements: FloatArray) -> FloatArray:
    """Return a symmetric matrix from its 1 or 3 elements."""
    return elements[[[0]]] if elements.size == 1 else elements[[[0, 1], [1, 2]]]


def _check(table: RadiationTable, states: int | None, uncertainty: float) -> None:
    if states is not None and not _FEWEST <= states <= _MOST:
        raise ConfigurationError(
            f"states = {states} must be {_FEWEST} to {_MOST} for each degree of freedom"
        )
    if not 0.0 < uncertainty <= 1.0:
        raise ConfigurationError(f"uncertainty = {uncertainty} must be above 0 and at most 1")
    count = int(np.count_nonzero(table.omega_rad_s))
    needed = _FEWEST if states is None else states
    if count < needed:
        raise DataError(
            f"{table.name} has {count} frequencies above 0, too few for {needed} states of each "
            f"degree of freedom; compute more, or use at most {count} states"
        )
