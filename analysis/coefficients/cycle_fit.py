"""Non-linear coefficients from cycles: single runs, several runs, quasi-steady or with all orders.

====================  ============  ==========================================================
method                harmonics     tells cubic from linear by
====================  ============  ==========================================================
:data:`HIGHER`        1, 2, 3       third harmonics and amplitudes, all runs together
:data:`FIRST`         1             amplitudes alone (multiple runs)
:data:`QUASI_STEADY`  0, 1          means and amplitudes; needs zero runs, or a constant term
====================  ============  ==========================================================

A single run is fitted by giving it alone.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_checks import check_cycles, check_determined
from analysis.coefficients.cycle_model import CycleProblem
from analysis.coefficients.cycle_numbers import CycleNumbers
from analysis.coefficients.fit_sources import fit_sources, trusted
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import LOAD_WORDS, Term, name_of_term, term_of
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray

HIGHER = (1, 2, 3)
FIRST = (1,)
QUASI_STEADY = (0, 1)
STATIC = (0,)


@dataclass(frozen=True, eq=False)
class CycleFit:
    """Coefficients of terms, with their correlations.

    Attributes
    ----------
    names
        In the order of ``values``; SI units.
    chi_square
        Weighted squares of the residuals by load, as :data:`LOAD_WORDS`, shape ``(4,)``.
    data
        Numbers fitted by load, shape ``(4,)``.
    further_inputs
        Inputs besides scatter and what is stated.
    """

    names: tuple[str, ...]
    terms: tuple[Term, ...]
    values: FloatArray
    chi_square: FloatArray
    data: FloatArray
    problem: CycleProblem
    stated: StatedUncertainties
    further_inputs: tuple[Contribution, ...] = ()

    @cached_property
    def uncertain(self) -> UncertainValues:
        """The values with what scatter, stated uncertainties and other inputs add."""
        sources = fit_sources(self.problem, self.values, self.stated)
        return UncertainValues(self.values, (*sources, *self.further_inputs))

    def with_input(self, label: str, parts: FloatArray, freedom: float = np.inf) -> "CycleFit":
        """Return the fit with one more input.

        Parameters
        ----------
        parts
            Change of each value per standard deviation of each deviate, shape ``(n, deviates)``.
        freedom
            Degrees of freedom of the input's standard deviation.
        """
        source = Contribution(label, freedom, np.arange(len(self.values)), parts)
        return replace(self, further_inputs=(*self.further_inputs, source))

    def with_misfit(self, label: str, row: int) -> "CycleFit":
        """Return the fit with what one load's residuals scatter beyond its runs' own scatter.

        The variance grows by the squares over their degrees of freedom, where these exceed one
        (Birge's ratio): the runs' scatter knows neither how well a run repeats nor whether the
        form is that of the hull.
        """
        excess = self.misfit(row) ** 2 - 1.0
        if not excess > 0.0:
            return self
        columns = [k for k, term in enumerate(self.terms) if term.row == row]
        weighted = self.problem.weighted(self.problem.nominal[0][..., columns], row)
        parts = np.zeros((len(self.values), weighted.shape[0]))
        parts[columns] = np.linalg.pinv(weighted)
        return self.with_input(label, np.sqrt(excess) * parts, self._degrees_of_freedom(row))

    def __getitem__(self, name: str) -> float:
        """Return one coefficient."""
        return float(self.values[self.names.index(name)])

    def refitted(self, parts: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return values and squares of other numbers of the cycles, with the same weights.

        The results are values, chi_square: their shapes are ``(trials, n)`` and ``(trials, 4)``.

        Parameters
        ----------
        parts
            Shape ``(trials, cycles, numbers)``.
        """
        design, loads = self.problem.design(parts)
        values = self.problem.coefficients(design, loads)
        return values, self.problem.squares(design, loads, values)

    def misfit(self, *rows: int) -> float:
        """Return the root of ``chi_square`` per degree of freedom; NaN without any left over."""
        spare = sum(self._degrees_of_freedom(row) for row in rows)
        return float(np.sqrt(self.chi_square[list(rows)].sum() / spare)) if spare > 0 else math.nan

    def _degrees_of_freedom(self, row: int) -> float:
        """Degrees of freedom of one load's residuals."""
        return float(self.data[row]) - sum(term.row == row for term in self.terms)


def fit_cycles(
    cycles: Sequence[BodyCycle],
    names: Sequence[str],
    orders: tuple[int, ...] = HIGHER,
    *,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008 - frozen
    of_speed_m_s: float | None = None,
) -> CycleFit:
    """Return the coefficients of some terms.

    Parameters
    ----------
    cycles
        Of one oscillator, with what is known to be taken off. Static runs tell through order 0
        alone, runs of many lines through all harmonics up to the highest line.
    names, of_speed_m_s
        Of the terms, as :mod:`analysis.coefficients.terms` writes them; the speed they are of.
    orders
        The harmonics to be fitted.

    Raises
    ------
    ConfigurationError
        If the cycles do not belong together or a name means no term.
    DataError
        If the terms cannot be told apart; the message says which, and what run would do it.
    """
    check_cycles(cycles, orders)
    found = (term_of(name, cycles[0].plane) for name in names)
    terms = tuple(replace(term, of_speed_m_s=of_speed_m_s) for term in found)
    term_names = tuple(name_of_term(term, cycles[0].plane) for term in terms)
    return fit_terms(cycles, terms, term_names, orders, stated=stated)


def fit_terms(
    cycles: Sequence[BodyCycle],
    terms: tuple[Term, ...],
    names: tuple[str, ...],
    orders: tuple[int, ...],
    *,
    form: Form = Form.MANOEUVRING,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008 - frozen
) -> CycleFit:
    """Return the coefficients of terms of a form's velocities, by the names that it gives them.

    It raises what :func:`fit_cycles` raises.
    """
    fitted = [_fitted_orders(cycle, orders) for cycle in cycles]
    all_orders = tuple(sorted(set().union(*fitted)))
    highest = max((cycle.orders for cycle in cycles if cycle.lines), default=0)
    highest = highest or min(cycle.orders for cycle in cycles)
    chosen = np.array([[float(n in cycle_orders) for n in all_orders] for cycle_orders in fitted])
    even = np.repeat(chosen[..., None], len(LOAD_WORDS), axis=2)
    first = CycleProblem(CycleNumbers(tuple(cycles), highest, form), terms, all_orders, even)
    check_determined(first)
    problem = first.with_weights(_weights(first, first.solve_nominal()))
    nominal = problem.solve_nominal()
    chi_square = problem.squares(*problem.nominal, nominal)
    data = np.zeros(len(LOAD_WORDS))
    for row, _ in problem.rows:
        data[row] = (np.repeat(chosen, 2, axis=1) * problem.real).sum()
    return CycleFit(names, terms, nominal, chi_square, data, problem, stated)


def _fitted_orders(cycle: BodyCycle, orders: tuple[int, ...]) -> set[int]:
    """Return which harmonics of a cycle are fitted: of a motion of many lines all up to the last.

    What is not linear mixes its lines into every harmonic.
    """
    lines = range(1, max(cycle.lines) + 1) if cycle.lines else ()
    return {*orders, *lines}


def _weights(problem: CycleProblem, first: FloatArray) -> FloatArray:
    """One over the scatter of each load's residuals and order, shrunk towards all cycles' mean.

    Scalars by cycle, load and order, and not whole matrices: a covariance from a few periods makes
    a poor metric, while any fixed weights leave the result unbiased and its propagated covariance
    right. A cycle's own variance counts as far as its degrees of freedom go beside those of the
    cycles' mean (:func:`trusted`): weights that follow the luck of three periods would be too sure
    of it.

    Parameters
    ----------
    first
        Coefficients of a fit without weights.
    """
    variances = np.ones_like(problem.weights)
    for row, _ in problem.rows:
        slope = problem.residual_slopes(first, row)
        for k, cycle in enumerate(problem.numbers.cycles):
            variances[k, :, row] = residual_variance(problem, cycle, slope[k])
    if not np.isfinite(variances).all():
        return problem.weights
    periods = np.array([_least_freedom(cycle) for cycle in problem.numbers.cycles])[:, None, None]
    present = problem.weights
    mean = (present * variances).sum(axis=0) / np.maximum(present.sum(axis=0), 1.0)
    shrunk = trusted(variances, periods, mean)
    floor = 1e-9 * np.abs(problem.numbers.parts).max() + 1e-300
    return np.asarray(present / np.maximum(np.sqrt(shrunk), floor))


def residual_variance(
    problem: CycleProblem, cycle: BodyCycle, slope: FloatArray, *sources: Contribution
) -> FloatArray:
    """Return the variance of one load's residuals: the mean of both parts of each order.

    Parameters
    ----------
    slope
        :meth:`CycleProblem.residual_slopes` of this load and cycle.
    sources
        Of the scatter; all of the cycle's where none is given.
    """
    variance = np.zeros(len(slope))
    for source in sources or cycle.hull.phasors.real.contributions:
        variance += ((slope @ problem.numbers.scatter(cycle, source)) ** 2).sum(axis=1)
    numbers = problem.real.reshape(-1, 2)
    return np.asarray((variance.reshape(-1, 2) * numbers).sum(axis=1) / numbers.sum(axis=1))


def _least_freedom(cycle: BodyCycle) -> float:
    return min(
        (source.degrees_of_freedom for source in cycle.phasors.real.contributions), default=np.inf
    )
