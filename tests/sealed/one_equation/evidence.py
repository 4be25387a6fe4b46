"""The evidence of a hypothesis beside a deviation of each size."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Final

import numpy as np

from analysis.gap.components import SETTLING, Part, Stack
from analysis.gap.fit import Fit, Problem, most_probable
from analysis.gap.gaussian import posterior
from analysis.gap.look import Looked
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import FORCES
from tests.sealed.one_equation.constants import PLAIN, TAUS, TOLERATED, VISIBLE, WIDE
from tests.sealed.one_equation.kernel import Kernel, units
from tests.sealed.one_equation.learned import Learned
from tests.sealed.one_equation.metric import Metric

_KINDS: Final = {
    Part.MEAN: "means",
    Part.TREND: "means",
    **dict.fromkeys(SETTLING, "trends"),
    Part.CYCLE_SCATTER: "scatter",
    Part.PERIOD_SCATTER: "scatter",
    Part.BETWEEN: "lines",
    Part.LINE: "lines",
}


@dataclass(frozen=True, eq=False)
class Beside:
    """What every hypothesis of a campaign has: tolerances, and a deviation of no particular form.

    Attributes
    ----------
    residual
        Measured minus simulated as stated, in sigma, shape ``(observations,)``.
    tolerances
        Columns of what every good rig and model is off by, ``(observations, columns)``.
    sought
        Which of them are the coefficients that such a test is made to find, shape ``(columns,)``.
    kinds
        The observations of each kind, by its name.
    own
        Each run's own gain and zero of each force, at a deviation of 1, ``(observations, any)``.
    """

    residual: FloatArray
    tolerances: FloatArray
    sought: BoolArray
    kernel: Kernel
    learned: Learned
    kinds: Mapping[str, BoolArray]
    own: FloatArray

    @classmethod
    def of(
        cls, problem: Problem, looked: Sequence[Looked], sought: BoolArray, moved: FloatArray
    ) -> "Beside":
        """Learn from first looks what may be beside what is named.

        Parameters
        ----------
        moved
            By how many tolerances the rig's coefficients were moved before, shape ``(free,)``.
        """
        stack = problem.simulator.stack
        nominal, columns = problem.simulator.nominal, problem.nuisances.columns
        scale = units(stack, nominal) / stack.uncertainty
        learned = Learned.of(looked, scale, Metric(columns))
        stated = problem.residual + columns[:, : len(moved)] @ moved
        wide = np.zeros(columns.shape[1], dtype=bool)
        wide[: len(sought)] = sought
        own = np.column_stack(list(_own(stack, nominal / stack.uncertainty, scale)))
        return cls(stated, columns, wide, Kernel.of(stack, nominal), learned, _kinds(stack), own)

    @cached_property
    def _plain(self) -> Kernel:
        return self.kernel.times_share(PLAIN)

    def none(self) -> FloatArray:
        """Return the log evidence of no effect, beside a smooth deviation of each size."""
        return self._each(partial(Metric, self.tolerances, self.kernel), TOLERATED)

    def coefficients(self) -> FloatArray:
        """Return that of coefficients that are off by more than anybody thought: one, or all."""
        ones = [np.arange(len(self.sought)) == at for at in np.flatnonzero(self.sought)]
        wide = [np.where(own, WIDE, 1.0) for own in (*ones, self.sought)]
        logs = [
            self._each(partial(Metric, self.tolerances * one, self.kernel), TOLERATED)
            for one in wide
        ]
        return np.asarray(np.logaddexp.reduce(logs, axis=0) - math.log(len(logs)), np.float64)

    def unknown(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the stage whose effects it looks like."""
        shapes = {stage: self.learned.at(stage) for stage in self.learned.stages}
        return {stage: self._seen(partial(self.metric, own)) for stage, own in shapes.items()}

    def alone(self) -> dict[str, FloatArray]:
        """Return that of something unknown, by the kind of observations in which it shows."""
        kernels = {kind: self.kernel.only(rows) for kind, rows in self.kinds.items()}
        return {
            kind: self._seen(partial(Metric, self.tolerances, own)) for kind, own in kernels.items()
        }

    def named(self, fit: Fit) -> FloatArray:
        """Return that of named effects."""
        shapes = self.learned.beside(fit.names)
        return np.array([self.under(fit, self.metric(shapes, tau)).log_evidence for tau in TAUS])

    def metric(self, shapes: FloatArray, tau: float) -> Metric:
        """Return the covariance of a deviation with some shapes, and a little of none.

        Of that little each run has gains and zeros of its own.
        """
        columns = (self.tolerances, tau * shapes, tau * math.sqrt(PLAIN) * self.own)
        return Metric(np.hstack(columns), self._plain, tau)

    def under(self, fit: Fit, metric: Metric) -> Fit:
        """Return a fit as it is weighed under a covariance, to first order about where it is."""
        target = fit.linearised(self.residual)
        found = posterior(target, fit.columns, metric)
        moved = replace(fit, posterior=found, shared=metric.log_determinant)
        best = most_probable(moved)
        left = target - fit.columns @ best
        cost = float(left @ metric.whiten(left)) + float(best @ best)
        return replace(moved, cost=cost)

    def _each(self, metric_at: Callable[[float], Metric], most: float) -> FloatArray:
        """Return the log evidence at each size, minus infinity at larger ones than ``most``."""
        return np.array([self._density(metric_at(tau)) if tau <= most else -np.inf for tau in TAUS])

    def _density(self, metric: Metric) -> float:
        square = float(self.residual @ metric.whiten(self.residual))
        return -0.5 * (square + metric.log_determinant)

    def _seen(self, metric_at: Callable[[float], Metric]) -> FloatArray:
        """Return the same, minus infinity where these runs would hardly show such a deviation."""
        least = Metric(self.tolerances).log_determinant + 2.0 * VISIBLE
        found = [metric_at(tau) for tau in TAUS]
        return np.array(
            [self._density(one) if one.log_determinant > least else -np.inf for one in found]
        )


def _kinds(stack: Stack) -> dict[str, BoolArray]:
    """Return the observations of each kind, and all of them: where something unknown may show."""
    kinds = [
        f"{one.channel or 'photocell'}: {_KINDS.get(one.part, 'harmonics')}"
        for one in stack.components
    ]
    found = {kind: np.array([one == kind for one in kinds]) for kind in dict.fromkeys(kinds)}
    return {**found, "all": np.ones(len(kinds), dtype=bool)}


def _own(stack: Stack, nominal: FloatArray, scale: FloatArray) -> Iterator[FloatArray]:
    """Yield what a gain and a zero of each run's own change of each force."""
    for number in range(len(stack.runs)):
        for channel in FORCES:
            here = np.array([one.channel == channel for one in stack.components])
            here &= stack.run == number
            mean = here & np.array([one.part is Part.MEAN for one in stack.components])
            yield np.where(here & stack.steady, nominal, 0.0)
            yield np.where(mean, scale, 0.0)
