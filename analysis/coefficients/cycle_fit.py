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

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analysis.coefficients.cycle import Cycle
from analysis.coefficients.cycle_checks import check_cycles, check_determined
from analysis.coefficients.cycle_model import DESIGNS_AT_ONCE, CycleProblem
from analysis.coefficients.phasors import ComplexArray, FloatArray
from analysis.coefficients.quality import residual_spread, trusted
from analysis.coefficients.stated import STATED, Stated
from analysis.coefficients.terms import SURGE, Term, name_of_term, term_of
from analysis.uncertainty import Contribution, UncertainValues, added

HIGHER = (1, 2, 3)
FIRST = (1,)
QUASI_STEADY = (0, 1)
STATIC = (0,)

_STEP = 1e-5  # of the largest motion or load
_STATED_STEP = 0.01  # of the stated uncertainty: curvature is the Monte Carlo's to find


@dataclass(frozen=True, eq=False)
class CycleFit:
    """Coefficients of terms, with their correlations.

    Attributes
    ----------
    names
        In the order of ``values``; SI units.
    chi_square
        Weighted squares of the residuals by load (force, moment, surge), shape ``(3,)``.
    data
        Numbers fitted by load, shape ``(3,)``.
    more
        Inputs besides scatter and what is stated.
    """

    names: tuple[str, ...]
    terms: tuple[Term, ...]
    values: FloatArray
    chi_square: FloatArray
    data: FloatArray
    problem: CycleProblem
    stated: Stated
    more: tuple[Contribution, ...] = ()

    @cached_property
    def uncertain(self) -> UncertainValues:
        """The values with what scatter, stated uncertainties and other inputs add."""
        return UncertainValues(self.values, (*_contributions(self), *self.more))

    def beside(self, label: str, parts: FloatArray, freedom: float = np.inf) -> "CycleFit":
        """Return the fit with one more input.

        Parameters
        ----------
        parts
            Change of each value per standard deviation of each deviate, shape ``(n, deviates)``.
        freedom
            Degrees of freedom of the input's standard deviation.
        """
        more = Contribution(label, freedom, np.arange(len(self.values)), parts)
        return replace(self, more=(*self.more, more))

    def with_misfit(self, label: str, row: int) -> "CycleFit":
        """Return the fit with what one load's residuals scatter beyond its runs' own scatter.

        The variance grows by the squares over their degrees of freedom, where these exceed one
        (Birge's ratio): the runs' scatter knows neither how well a run repeats nor whether the
        form is that of the hull.
        """
        excess = self.misfit(row) ** 2 - 1.0
        if not excess > 0.0:
            return self
        design, _ = self.problem.nominal_design()
        columns = [k for k, term in enumerate(self.terms) if term.row == row]
        weighted = self.problem.weights[..., row, None] * design[0][..., columns]
        flat = weighted.reshape(-1, len(columns))
        parts = np.zeros((len(self.values), 2 * len(flat)))
        parts[columns] = np.linalg.pinv(np.concatenate((flat.real, flat.imag)))
        return self.beside(label, np.sqrt(excess) * parts, self._spare(row))

    def __getitem__(self, name: str) -> float:
        """Return one coefficient."""
        return float(self.values[self.names.index(name)])

    def misfit(self, row: int) -> float:
        """Return the root of ``chi_square`` per degree of freedom; NaN without any left over."""
        spare = self._spare(row)
        return float(np.sqrt(self.chi_square[row] / spare)) if spare > 0 else float("nan")

    def _spare(self, row: int) -> float:
        """Degrees of freedom of one load's residuals."""
        return float(self.data[row]) - sum(term.row == row for term in self.terms)


def fit_cycles(
    cycles: Sequence[Cycle],
    names: Sequence[str],
    orders: tuple[int, ...] = HIGHER,
    *,
    stated: Stated = Stated(),  # noqa: B008 - frozen
) -> CycleFit:
    """Return the coefficients of some terms.

    Parameters
    ----------
    cycles
        Of one oscillator, with what is known to be taken off; any frequencies, amplitudes, drift
        angles. Static runs tell through order 0 alone.
    names
        Of the terms, as :mod:`analysis.coefficients.terms` writes them.
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
    terms = tuple(term_of(name, cycles[0].plane) for name in names)
    highest = min(cycle.orders for cycle in cycles)
    first = CycleProblem(
        tuple(cycles), terms, orders, np.ones((len(cycles), len(orders), 3)), highest
    )
    design, loads = first.nominal_design()
    check_determined(first, design[0])
    problem = replace(first, weights=_weights(first, first.fit(design, loads)[0]))
    nominal = problem.fit(design, loads)[0]
    chi_square, data = _squares(problem, nominal, design[0], loads[0])
    own = tuple(name_of_term(term, cycles[0].plane) for term in terms)
    return CycleFit(own, terms, nominal, chi_square, data, problem, stated)


def _weights(problem: CycleProblem, first: FloatArray) -> FloatArray:
    """One over the scatter of each load and order, shrunk towards the mean of all cycles'.

    Parameters
    ----------
    first
        Coefficients of a fit without weights.
    """
    spread = residual_spread(problem.linear, _linear_part(problem, first))
    count = problem.highest + 1
    variance = spread.reshape(len(problem.cycles), count, 2) ** 2
    whole = np.concatenate((variance, _surge_variance(problem, count)), axis=2)
    whole = whole[:, list(problem.orders)]
    if not np.isfinite(whole).all():
        return np.ones_like(whole)
    own = np.array([_fewest(cycle) for cycle in problem.cycles])[:, None, None]
    shrunk = trusted(whole, own)
    sizes = np.abs(problem.parts()).max()
    floor = 1e-9 * sizes + 1e-300
    return np.asarray(1.0 / np.maximum(np.sqrt(shrunk), floor))


def _fewest(cycle: Cycle) -> float:
    return min((source.degrees_of_freedom for source in cycle.phasors.sources), default=np.inf)


def _linear_part(problem: CycleProblem, first: FloatArray) -> FloatArray:
    """A and B of the linear terms in a first fit, shape ``(2, 2, 2)``, for the residuals' size."""
    found = np.zeros((2, 2, 2))
    for term, value in zip(problem.terms, first, strict=True):
        if term.degree == 1 and term.row != SURGE and "|" not in term.factors[0]:
            column = int("r" in term.factors[0].replace("dot", ""))
            found[term.row, column, int(term.rates == 0)] = -value
    return found


def _surge_variance(problem: CycleProblem, count: int) -> FloatArray:
    found = np.ones((len(problem.cycles), count, 1))
    for k, cycle in enumerate(problem.cycles):
        if cycle.has_surge:
            places = np.array(problem.places(cycle)).reshape(count, -1)[:, -1]
            diagonal = np.diagonal(cycle.phasors.covariance).reshape(-1, 2)
            found[k, :, 0] = diagonal[places].mean(axis=1)
    return found


def _squares(
    problem: CycleProblem, nominal: FloatArray, design: ComplexArray, loads: ComplexArray
) -> tuple[FloatArray, FloatArray]:
    """Weighted squares and count of the numbers fitted, by load."""
    squares, data = np.zeros(3), np.zeros(3)
    for row in range(3):
        columns = [k for k, term in enumerate(problem.terms) if term.row == row]
        if not columns:
            continue
        left = loads[..., row] - design[..., columns] @ nominal[columns]
        squares[row] = float((np.abs(problem.weights[..., row] * left) ** 2).sum())
        per_order = [1 if order == 0 else 2 for order in problem.orders]
        data[row] = len(problem.cycles) * sum(per_order)
    return squares, data


def _contributions(fit: CycleFit) -> tuple[Contribution, ...]:
    """Scatter by source, of all cycles that share it, then each stated uncertainty."""
    problem, stated = fit.problem, fit.stated
    by_part, by_stated = _slopes(problem, fit.values, stated)
    everywhere, found = np.arange(len(problem.terms)), []
    for k, cycle in enumerate(problem.cycles):
        of_fit, of_cycle = problem.measured(cycle)
        slope = by_part[k][:, of_fit]
        for source in cycle.phasors.sources:
            parts = slope @ source.root[of_cycle]
            found.append(Contribution(source.label, source.degrees_of_freedom, everywhere, parts))
    for k, (name, spread) in enumerate(zip(STATED, stated.vector, strict=True)):
        if spread > 0.0:
            column = by_stated[:, k, None] * spread
            found.append(Contribution(name, stated.freedom(name), everywhere, column))
    return added(found)


def _slopes(
    problem: CycleProblem, values: FloatArray, stated: Stated
) -> tuple[FloatArray, FloatArray]:
    """Return derivatives by the cycles' numbers and by the stated quantities.

    A cycle's numbers change that cycle's part of the design alone, so that all cycles are moved at
    once; what a moved design does to the coefficients is exact.

    Returns
    -------
    by_part
        Shape ``(cycles, terms, per_cycle)``.
    by_stated
        Shape ``(terms, len(STATED))``.
    """
    parts = problem.parts()
    size = np.abs(parts).reshape(len(parts), problem.highest + 1, -1, 2)
    steps = _STEP * np.broadcast_to(size.max(axis=(0, 1, 3))[:, None], size.shape[1:]).ravel()
    spreads = _STATED_STEP * stated.vector
    shifts = np.concatenate((np.diag(steps), np.zeros((len(spreads), len(steps)))))
    off = np.concatenate((np.zeros((len(steps), len(spreads))), np.diag(spreads)))
    every = np.concatenate((steps, spreads))
    found = np.zeros((len(every), len(parts), len(values)))
    moving = np.flatnonzero(every)
    for some in np.array_split(moving, -(-len(moving) * len(parts) // DESIGNS_AT_ONCE)):
        ahead, back = (
            problem.design(parts + sign * shifts[some, None], sign * off[some])
            for sign in (1.0, -1.0)
        )
        change = [
            (more - less) / (2.0 * every[some]).reshape(-1, *(1,) * (more.ndim - 1))
            for more, less in zip(ahead, back, strict=True)
        ]
        found[some] = problem.followed(values, *change)
    return found[: len(steps)].transpose(1, 2, 0), found[len(steps) :].sum(axis=1).T
