"""A memory that was found, and how its curves, ends and poles follow from what was measured."""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Final

import numpy as np
from scipy.linalg import block_diag

from analysis.coefficients.linear_fit import DISAGREE
from analysis.coefficients.zero_frequency import own_variance
from analysis.memory.measured_matrices import MeasuredMatrix
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.water.memory import state_space, symmetric
from sim.model.water.radiation import Radiation, constant
from sim.model.water.vector_fitting import PartialFractions, basis, pole_slopes, sum_free

# Criterion less the least one beyond which a number of states is ruled out: evidence 20 to 1.
DOUBTED: Final = 2.0 * math.log(20.0)
MISFIT: Final = "misfit of the memory"
STATES: Final = "number of states"
_SURE: Final = 3.0  # standard uncertainties
_ROUNDING: Final = 1e-8  # of the largest singular value: a direction that the values do not tell


@dataclass(frozen=True)
class Order:
    """How well a number of states describes the values.

    Attributes
    ----------
    states
        Of each degree of freedom; 0 is no memory.
    freedom
        How many squares chance leaves: values less numbers of the fit.
    unconditioned, chi_square
        Squares of what is left over its scatter: where damping may be negative, and where it may
        not. NaN where the first rules the number of states out.
    criterion
        Chi-square over the least one per degree of freedom of all numbers of states (where that is
        above 1), and ln n for each number of the fit (Schwarz 1978).
    """

    states: int
    freedom: int
    unconditioned: float
    chi_square: float = math.nan
    criterion: float = math.nan


@dataclass(frozen=True, eq=False)
class MeasuredMemory:
    """The memory of some degrees of freedom.

    Attributes
    ----------
    fit
        In units in which all is of the order of one.
    unit, middle
        Of mass, shape ``(2, 2)``, and of frequency (rad/s).
    orders
        What was tried; :attr:`chosen` is the one that was taken.
    alternatives
        Fits of other numbers of states that are not ruled out, each with its weight.
    """

    measured: MeasuredMatrix
    fit: PartialFractions
    unit: FloatArray
    middle: float
    orders: tuple[Order, ...]
    chosen: Order
    alternatives: tuple[tuple[float, PartialFractions], ...]

    @property
    def poles(self) -> ComplexArray:
        """Real ones and one of each conjugate pair, rad/s."""
        return self.fit.poles * self.middle

    @property
    def infinite(self) -> FloatArray:
        """Added mass at infinite frequency, shape ``(e,)``, SI units."""
        return self.fit.infinite * self._units

    @property
    def steady(self) -> FloatArray:
        """Damping B_0 that does not depend on the frequency, shape ``(e,)``, SI units."""
        return self.fit.steady * self._units * self.middle

    @property
    def residues(self) -> ComplexArray:
        """Of the memory's force per velocity at each pole, p_n R_n, shape ``(e, q)``, SI units.

        A conjugate pair has the conjugate residue as well.
        """
        count, paired = self.fit.poles.size, self.fit.poles.imag != 0.0
        residues = self.fit.residues[:, :count].astype(np.complex128)
        residues[:, paired] += 1j * self.fit.residues[:, count:]
        return residues * self._units[:, None] * self.middle * self.poles

    @cached_property
    def radiation(self) -> Radiation:
        """The state space with the added mass at infinite frequency; B_0 is not in it."""
        dofs, added = self.measured.dofs, np.zeros((2, 2))
        added[np.ix_(dofs, dofs)] = symmetric(self.infinite)
        if not self.chosen.states:
            return constant(added)
        return constant(added).joined(*state_space(self.fit, dofs, self.unit, self.middle))

    def damping_matrix(self) -> FloatArray:
        """Return B_0 with what of it is not symmetric, shape ``(2, 2)``."""
        dofs, beta = self.measured.dofs, float(self.measured.skew.values[0])
        damping = np.array([[0.0, beta], [-beta, 0.0]])
        damping[np.ix_(dofs, dofs)] += symmetric(self.steady)
        return damping

    def curves(self, omega_rad_s: FloatArray) -> UncertainValues:
        """Return A and B of each element, in the order of what was measured.

        To first order in what was measured, scatter and shared inputs alike, with what the fit
        leaves beyond scatter; beyond the measured band they are extrapolated.
        """
        slope = _real_rows(self._slopes(omega_rad_s), omega_rad_s, self._units)
        best_values = self._added_mass_and_damping(self.fit, omega_rad_s)
        squares = [
            weight * (self._added_mass_and_damping(fit, omega_rad_s) - best_values) ** 2
            for weight, fit in self.alternatives
        ]
        curves = self._measured_values.carried(best_values, slope @ self._numbers)
        return curves.plus(STATES, np.sqrt(np.sum(squares, axis=0))) if squares else curves

    def ends(self) -> UncertainValues:
        """Return A_inf and B_0 of each element in turn."""
        count = self._own_count
        rows = [e * count + count - 2 + k for e in range(len(self._units)) for k in (0, 1)]
        scale = np.stack([self._units, self._units * self.middle], axis=1).ravel()
        values = np.stack([self.infinite, self.steady], axis=1).ravel()
        return self._measured_values.carried(values, scale[:, None] * self._numbers[rows])

    def rates(self) -> UncertainValues:
        """Return real parts of the poles, then imaginary parts of the pairs, rad/s."""
        poles = self.poles
        values = np.append(poles.real, poles.imag[poles.imag != 0.0])
        return (
            self._measured_values.carried(values, self.middle * self._numbers[-values.size :])
            if len(values)
            else UncertainValues(values)
        )

    @property
    def contradicted(self) -> bool:
        """Whether the values ask for energy from the water.

        A measured damping is negative by more than three of its standard uncertainties, or the
        condition costs agreement, with evidence of 20 to 1.
        """
        cost = self.chosen.chi_square - self.chosen.unconditioned
        uncertain = self.measured.uncertain
        measured, spread = map(
            self.measured.shaped, (uncertain.values, uncertain.standard_uncertainty)
        )
        pairs = zip(self.measured.elements, measured[:, 1] + _SURE * spread[:, 1], strict=True)
        negative = any(row == column and highest.min() < 0.0 for (row, column), highest in pairs)
        return negative or cost / max(1.0, self.misfit**2) > DOUBTED

    @property
    def misfit(self) -> float:
        """What is left over, over what scatter explains, root mean square."""
        return math.sqrt(self.chosen.chi_square / self.chosen.freedom)

    @property
    def misfits(self) -> bool:
        """Whether more is left than values without faults of their own would leave."""
        return self.misfit > DISAGREE

    @property
    def _units(self) -> FloatArray:
        return np.array([self.unit[pair] for pair in self.measured.elements])

    @property
    def _own_count(self) -> int:
        """How many numbers each element has of its own: residues, end value, steady damping."""
        return max(int(self.fit.residues.shape[1]) - 1, 0) + 2

    def _added_mass_and_damping(self, fit: PartialFractions, omega_rad_s: FloatArray) -> FloatArray:
        """Return A and B of a fit, in the order of what was measured, SI units."""
        omega = omega_rad_s / self.middle
        values = (fit.residues @ basis(fit.poles, omega).T + fit.ends(omega)) * self._units[:, None]
        return np.stack([values.real, -values.imag * omega_rad_s], axis=1).ravel()

    def _slopes(self, omega_rad_s: FloatArray) -> ComplexArray:
        """Return how M of each element goes with the fit's numbers, shape ``(e m, p)``."""
        omega, poles = omega_rad_s / self.middle, self.fit.poles
        constant = np.ones((omega.size, 1))
        functions = [
            basis(poles, omega) @ sum_free(poles),
            constant,
            constant / (1j * omega[:, None]),
        ]
        linear_slopes = block_diag(*[np.hstack(functions)] * len(self._units))
        pole_parts = [pole_slopes(poles, row, omega) for row in self.fit.residues]
        return np.hstack([linear_slopes, np.vstack(pole_parts)])

    @cached_property
    def _numbers(self) -> FloatArray:
        """How the fit's numbers go with what was measured, shape ``(p, 2 k e)``."""
        omega = self.measured.omega_rad_s
        slope = _real_rows(self._slopes(omega), omega, self._units)
        weights = 1.0 / np.sqrt(own_variance(self.measured.uncertain))
        system = slope * weights[:, None]
        size = np.linalg.norm(system, axis=0)
        size = np.where(size > 0.0, size, 1.0)
        return np.asarray(np.linalg.pinv(system / size, rcond=_ROUNDING) / size[:, None] * weights)

    @cached_property
    def _measured_values(self) -> UncertainValues:
        """What was measured, with what the memory leaves of it beyond scatter."""
        uncertain, beyond = self.measured.uncertain, self.misfit**2 - 1.0
        if beyond <= 0.0:
            return uncertain
        parts = np.diag(np.sqrt(beyond * own_variance(uncertain)))
        misfit = Contribution(MISFIT, float(self.chosen.freedom), np.arange(len(uncertain)), parts)
        return replace(uncertain, contributions=(*uncertain.contributions, misfit))


def _real_rows(slopes: ComplexArray, omega_rad_s: FloatArray, units: FloatArray) -> FloatArray:
    """Return slopes of M ``(e m, p)`` as those of A and B in SI units, ``(2 e m, p)``."""
    split = slopes.reshape(len(units), omega_rad_s.size, -1) * units[:, None, None]
    parts = np.stack([split.real, -split.imag * omega_rad_s[:, None]], axis=1)
    return np.asarray(parts.reshape(-1, slopes.shape[1]))
