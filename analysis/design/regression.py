"""What each run that could be made would tell of each coefficient, by the fit's own equations.

With the terms' columns A of :class:`analysis.coefficients.cycle_model.CycleProblem`, the variance R
of the residuals' harmonics and the fit's own weights W, a run adds to the sums of each fit that it
is part of, and the coefficients' covariance is

    N = sum A' W A    Q = sum A' W R W A    G = sum A' W s    N^-1 (Q + G G') N^-1

where s is what one standard uncertainty of each stated quantity (mass, lag, gain ...) does to the
residuals. R is ``V_1 / T + V_r``: what one second leaves over the measured time, and what a repeat
differs by. W is not ``R^-1``: of few periods the fit trusts the runs' mean variance more than each
one's own (:func:`analysis.coefficients.fit_sources.trusted`).
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import HIGHER, residual_variance
from analysis.coefficients.cycle_model import CycleProblem
from analysis.coefficients.cycle_numbers import CycleNumbers
from analysis.coefficients.fit_sources import trusted
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import ORDERS, Belief, believed_cycles
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignFit, DesignTarget, fits_of
from analysis.design.noise import Noise
from hardware.description.arrays import FloatArray, IntArray
from hardware.description.setpoint import SetPoint

_REGULAR: Final = 1e-12  # of a scaled normal matrix: rounding leaves 1e-16 where terms are alike
_AT_ONCE: Final = 500  # cycles: some 100 MB


@dataclass(frozen=True, eq=False)
class Regression:
    """A fit of one load by some of the candidates, each coefficient over what is wanted of it.

    Attributes
    ----------
    names
        Of its terms, p of them.
    members
        Places of its candidates, shape ``(n,)``.
    normals, meats
        What each adds to N and Q, shape ``(n, p, p)``.
    pulls
        What each adds to G, shape ``(n, p, s)``.
    wanted
        Standard uncertainty that is wanted of each term; infinite where none is.
    where
        Which runs it is of, in words; empty for all.
    """

    names: tuple[str, ...]
    members: IntArray
    normals: FloatArray
    meats: FloatArray
    pulls: FloatArray
    wanted: FloatArray
    where: str = ""

    @property
    def is_determined(self) -> bool:
        """Whether all candidates together tell its terms apart."""
        total = self.normals.sum(axis=0)
        sizes = np.sqrt(np.diagonal(total))
        if not sizes.all():
            return False
        return bool(np.linalg.eigvalsh(total / np.outer(sizes, sizes))[0] > _REGULAR)


@dataclass(frozen=True, eq=False)
class LoadResiduals:
    """Of all motions: columns, variances and slopes of one load's residuals.

    Shapes ``(m, 2 orders, p)``, ``(m, 2 orders)`` twice, ``(m, 2 orders, s)``.
    """

    columns: FloatArray
    after_1_s: FloatArray
    of_repeats: FloatArray
    slopes: FloatArray


@dataclass(frozen=True, eq=False)
class Prospects:
    """Candidates, and what is known of each of their motions.

    Attributes
    ----------
    motion
        Which motion each candidate has, shape ``(n,)``.
    """

    candidates: tuple[CandidateRun, ...]
    belief: Belief
    motion: IntArray
    residuals: Mapping[int, LoadResiduals]

    def regressions(
        self, targets: Sequence[DesignTarget], like: Sequence[int] = ()
    ) -> tuple[Regression, ...]:
        """Return the regressions that targets ask for, as :func:`fits_of` has them.

        Parameters
        ----------
        like
            Candidates on whose mean variance the weights lean, as the fit's do on that of its runs;
            all by default.
        """
        return tuple(
            self._regression(fit, like) for fit in fits_of(self.candidates, targets, self.belief)
        )

    def _regression(self, fit: DesignFit, like: Sequence[int]) -> Regression:
        names = tuple(list(self.belief.values)[k] for k in fit.places)
        wanted = np.array([fit.wanted.get(name, np.inf) for name in names])
        motions, load_values = self.motion[fit.members], self.residuals[fit.row]
        numbers = [2 * HIGHER.index(n) + part for n in fit.orders for part in (0, 1)]
        runs = [self.candidates[k] for k in fit.members]
        time = np.array([run.measured_s for run in runs])[:, None]
        variance = (
            load_values.after_1_s[motions][:, numbers] / time
            + load_values.of_repeats[motions][:, numbers]
        )
        freedom = np.array([run.freedom for run in runs])[:, None]
        place = {candidate: k for k, candidate in enumerate(fit.members)}
        leant_on = [place[candidate] for candidate in like if candidate in place] or slice(None)
        weights = 1.0 / trusted(variance, freedom, variance[leant_on].mean(axis=0))
        columns = load_values.columns[motions][:, numbers][..., list(fit.places)]
        weighted = (columns * weights[..., None]).swapaxes(-1, -2)
        spread = (columns * (weights * np.sqrt(variance))[..., None]).swapaxes(-1, -2)
        return Regression(
            names,
            fit.members,
            weighted @ columns,
            spread @ spread.swapaxes(-1, -2),
            weighted @ load_values.slopes[motions][:, numbers],
            wanted,
            fit.where,
        )


def prospects(
    candidates: Sequence[CandidateRun], belief: Belief, noise: Noise, stated: StatedUncertainties
) -> Prospects:
    """Return what is known of runs that could be made.

    Raises
    ------
    DataError
        If a candidate cannot be reached, or its loads not be told.
    """
    points = list(dict.fromkeys(candidate.point for candidate in candidates))
    places = {point: k for k, point in enumerate(points)}
    motion = np.array([places[candidate.point] for candidate in candidates])
    return Prospects(
        tuple(candidates), belief, motion, _load_residuals(points, belief, noise, stated)
    )


def _load_residuals(
    points: Sequence[SetPoint], belief: Belief, noise: Noise, stated: StatedUncertainties
) -> dict[int, LoadResiduals]:
    pieces: dict[int, list[LoadResiduals]] = {}
    for first in range(0, len(points), _AT_ONCE):
        cycles = _of_a_second(points[first : first + _AT_ONCE], belief, noise)
        for row, piece in _of_cycles(cycles, belief, stated):
            pieces.setdefault(row, []).append(piece)
    return {
        row: LoadResiduals(*(np.concatenate([getattr(piece, key) for piece in row_pieces])
                     for key in LoadResiduals.__dataclass_fields__))
        for row, row_pieces in pieces.items()
    }  # fmt: skip


def _of_a_second(points: Sequence[SetPoint], belief: Belief, noise: Noise) -> list[BodyCycle]:
    """Return runs' cycles with the scatter of one second each, and of a repeat."""
    names = [f"run {k}" for k in range(len(points))]
    scatter = [
        noise.scatter(name, point.frequency_hz, point.frequency_hz)
        for name, point in zip(names, points, strict=True)
    ]
    return [noise.repeating(cycle) for cycle in believed_cycles(names, points, belief, scatter)]


def _of_cycles(
    cycles: Sequence[BodyCycle], belief: Belief, stated: StatedUncertainties
) -> Iterator[tuple[int, LoadResiduals]]:
    even = np.ones((len(cycles), len(HIGHER), 3))
    numbers = CycleNumbers(tuple(cycles), ORDERS, belief.form)
    problem = CycleProblem(numbers, belief.terms, HIGHER, even)
    acting = np.flatnonzero(stated.vector)
    spread = [numbers.sensitivity(cycle)[:, acting] * stated.vector[acting] for cycle in cycles]
    for row, _ in problem.rows:
        slopes = problem.residual_slopes(belief.vector, row)
        variances = np.zeros((2, len(cycles), len(HIGHER)))
        for k, (cycle, slope) in enumerate(zip(cycles, slopes, strict=True)):
            for n, source in enumerate(cycle.hull.phasors.real.contributions):
                variances[n, k] = residual_variance(problem, cycle, slope, source)
        after, repeats = np.repeat(variances, 2, axis=-1)
        yield (
            row,
            LoadResiduals(
                problem.nominal[0], after, repeats, np.einsum("kbn,kns->kbs", slopes, spread)
            ),
        )
