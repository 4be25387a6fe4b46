"""Fit the memory of the water to a table of added mass and damping.

The identification runs in the frequency domain, on B + i w A at the table's frequencies, over the
numbers of a :class:`sim.model.water.ladder.Ladder`: what comes out is passive, has no damping at
zero frequency and a kernel that begins with a finite value, by its form. The added mass at infinite
frequency is fitted along unless the table has it.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from sim.model.water.identification import MemoryTarget, best_joint_ladder, best_ladder
from sim.model.water.ladder import Ladder
from sim.model.water.radiation import Radiation, constant
from sim.model.water.tables import RadiationTable

# Relative to the diagonal: below it a table's coupling is rounding, and the two degrees of freedom
# are fitted one by one.
COUPLING_IS_NOISE: Final = 1e-4
_FEWEST: Final = 2  # states


@dataclass(frozen=True, eq=False)
class FittedMemory:
    """A memory and how well it reproduces the table that it was fitted to.

    Attributes
    ----------
    added_mass_error, damping_error
        Largest deviation at the table's frequencies above 0, shape ``(2, 2)``: relative to the
        table's value on the diagonal, to the root of the product of both diagonal values off it. A
        diagonal value below ``floor`` of its peak counts as that. Zero for a degree of freedom that
        the table does not have.
    """

    radiation: Radiation
    added_mass_error: FloatArray
    damping_error: FloatArray
    floor: float

    @property
    def error(self) -> float:
        """Largest of all deviations."""
        return float(max(self.added_mass_error.max(), self.damping_error.max()))


def fit_memory(
    table: RadiationTable,
    states: int = 6,
    *,
    floor: float = 0.01,
    starts: int = 12,
    seed: int = 0,
) -> FittedMemory:
    """Return the passive memory that comes nearest to the table.

    Least squares of the relative deviations from several starting points, drawn around the peak of
    the damping; the best is kept. Where the degrees of freedom are coupled, both are fitted once
    more together. It takes one to three seconds: keep the result.

    Parameters
    ----------
    states
        States for each degree of freedom, 2 to 10: 4 to 6 serve most hulls. Where no memory of so
        many fades, as with a table that has a slow tail, it is one of as many as do.
    floor
        Part of its peak below which a value counts as that, in the weights and in the errors.
    starts, seed
        Number of starting points, and the seed of their random stream.

    Raises
    ------
    ConfigurationError
        If ``states``, ``floor`` or ``starts`` is out of range.
    DataError
        If the table has fewer frequencies than states, its coupling is not symmetric, or no
        start leads to a memory that fades.
    """
    _check(table, states, floor, starts)
    targets = _Targets(table.symmetrised(), floor)
    for count in range(states, _FEWEST, -1):
        try:
            return _fitted(targets, count, starts, np.random.default_rng(seed))
        except DataError:  # none of that many fades: a slow tail asks for fewer
            continue
    return _fitted(targets, _FEWEST, starts, np.random.default_rng(seed))


def _fitted(
    targets: "_Targets", states: int, starts: int, generator: np.random.Generator
) -> FittedMemory:
    fits = {
        i: best_ladder(targets.of((i,)), states, starts, generator) for i in targets.with_damping
    }
    if len(fits) == 2 and targets.coupling > COUPLING_IS_NOISE:
        both = best_joint_ladder(targets.of((0, 1)), fits[0], fits[1], starts, generator)
        return targets.judged([((0, 1), *both)])
    return targets.judged([((i,), *fit) for i, fit in fits.items()])


@dataclass(frozen=True)
class _Targets:
    """The table in units in which all that is fitted is of the order of one.

    Frequencies are divided by their geometric middle, masses by the root of the largest of either
    degree of freedom.
    """

    table: RadiationTable
    floor: float

    @property
    def rows(self) -> slice:
        """The frequencies above 0, where B + i w A tells A."""
        return slice(int(self.table.omega_rad_s[0] == 0.0), None)

    @property
    def with_damping(self) -> list[int]:
        """The degrees of freedom that radiate."""
        return [i for i in (0, 1) if self.table.damping[:, i, i].any()]

    @property
    def middle(self) -> float:
        """Unit of frequency, rad/s."""
        omega = self.table.omega_rad_s[self.rows]
        return math.sqrt(float(omega[0]) * float(omega[-1]))

    @property
    def mass(self) -> FloatArray:
        """Square root of the unit of mass of each degree of freedom."""
        largest = np.abs(self.table.added_mass[:, (0, 1), (0, 1)]).max(axis=0)
        return np.sqrt(np.where(largest > 0.0, largest, 1.0))

    @property
    def scales(self) -> tuple[FloatArray, FloatArray]:
        """What a deviation of A, of B counts relative to; each ``(k, 2, 2)``."""
        return self._scale(self.table.added_mass), self._scale(self.table.damping)

    def _scale(self, matrices: FloatArray) -> FloatArray:
        own = np.abs(matrices[self.rows][:, (0, 1), (0, 1)])
        own = np.maximum(own, self.floor * own.max(axis=0))
        own = np.sqrt(np.where(own > 0.0, own, np.inf))
        return own[:, :, None] * own[:, None, :]

    @property
    def coupling(self) -> float:
        """Largest coupling, relative to the diagonal."""
        both = (self.table.added_mass, self.table.damping)
        parts = zip(both, self.scales, strict=True)
        return float(max(np.abs(x[self.rows] / s)[:, 0, 1].max() for x, s in parts))

    def of(self, dofs: tuple[int, ...]) -> MemoryTarget:
        """Return what has to be reproduced for some degrees of freedom."""
        pick = np.ix_(range(self.table.omega_rad_s[self.rows].size), dofs, dofs)
        mass = np.outer(self.mass, self.mass)
        a, b = self.table.added_mass[self.rows] / mass, self.table.damping[self.rows] / mass
        scale_a, scale_b = self.scales
        infinite = self.table.added_mass_infinite
        return MemoryTarget(
            self.table.omega_rad_s[self.rows] / self.middle,
            a[pick],
            b[pick] / self.middle,
            (mass / scale_a)[pick],
            (mass * self.middle / scale_b)[pick],
            None if infinite is None else (infinite / mass)[np.ix_(dofs, dofs)],
        )

    def judged(self, fits: list[tuple[tuple[int, ...], Ladder, FloatArray]]) -> FittedMemory:
        """Return the memory in SI units, and its deviations from the table."""
        infinite = self.table.added_mass_infinite
        added = np.array(self.table.added_mass[-1] if infinite is None else infinite)
        radiation = constant(added)
        for dofs, ladder, numbers in fits:
            matrices = ladder.matrices(numbers)
            added[np.ix_(dofs, dofs)] = (
                matrices.added_mass * np.outer(self.mass, self.mass)[np.ix_(dofs, dofs)]
            )
            gain = np.zeros((ladder.states, 2))
            gain[:, dofs] = self.middle * matrices.input * self.mass[list(dofs)]
            radiation = radiation.joined(self.middle * matrices.state, gain, gain.T)
        radiation = Radiation(
            added, radiation.state_matrix, radiation.input_matrix, radiation.output_matrix
        )
        omega = self.table.omega_rad_s[self.rows]
        scale_a, scale_b = self.scales
        off_a = np.abs(radiation.added_mass(omega) - self.table.added_mass[self.rows]) / scale_a
        off_b = np.abs(radiation.damping(omega) - self.table.damping[self.rows]) / scale_b
        return FittedMemory(radiation, off_a.max(axis=0), off_b.max(axis=0), self.floor)


def _check(table: RadiationTable, states: int, floor: float, starts: int) -> None:
    if not _FEWEST <= states <= 10:
        raise ConfigurationError(f"states = {states} must be 2 to 10 for each degree of freedom")
    if not 0.0 < floor <= 1.0:
        raise ConfigurationError(f"floor = {floor} must be above 0 and at most 1")
    if starts < 1:
        raise ConfigurationError(f"starts = {starts} must be at least 1")
    count = int(np.count_nonzero(table.omega_rad_s))
    if count < states:
        raise DataError(
            f"{table.name} has {count} frequencies above 0, too few for {states} states of each "
            f"degree of freedom; compute more, or use at most {count} states"
        )
