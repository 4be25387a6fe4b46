"""What hypotheses leave of the gap, by kind of observable and by run."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.settle import Settled
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.search.fit import Fit, no_effect
from hardware.description.arrays import FloatArray

_BEYOND: Final = 4.0
_SIGN_RAD: Final = 0.54  # from half a turn, within which a sign is reversed: as in a campaign


@dataclass(frozen=True)
class KindOfGap:
    """One kind of observable, over all records.

    Attributes
    ----------
    stated
        Root mean square of measured less simulated in u, releases fitted.
    before, after
        The same with what is known within tolerances fitted too: without a cause, and with the
        best set.
    """

    kind: str
    count: int
    stated: float
    before: float
    after: float

    @property
    def is_beyond_noise(self) -> bool:
        """Whether what is left is more than noise, by four standard deviations of its square."""
        return self._is_gap(self.after)

    @property
    def gap(self) -> bool:
        """The same of the simulation as it is stated."""
        return self._is_gap(self.stated)

    @property
    def out_of_tolerance(self) -> bool:
        """The same without a cause, what is known within tolerances fitted."""
        return self._is_gap(self.before)

    def _is_gap(self, rms: float) -> bool:
        return rms**2 > 1.0 + _BEYOND * math.sqrt(2.0 / self.count)


def gap_by_kind(problem: PendulumProblem, after: Settled) -> tuple[KindOfGap, ...]:
    """Return the gap by kind of observable, before and after."""
    leftover = remainder(after.problem, after.best)
    leftovers = (as_stated(problem), remainder(problem, no_effect(problem)), leftover)
    kinds = []
    for kind in np.unique(problem.kind):
        rows = problem.kind == kind
        sizes = [float(np.sqrt(np.mean(leftover[rows] ** 2))) for leftover in leftovers]
        kinds.append(KindOfGap(problem.names[kind], int(rows.sum()), *sizes))
    return tuple(kinds)


def remainder(problem: PendulumProblem, hypothesis: Fit) -> FloatArray:
    """Return what a hypothesis leaves of the gap with its nuisances at their best, in sigma."""
    leftover = problem.residual - hypothesis.signature
    return leftover - problem.nuisances.columns @ problem.nuisances.fitted(leftover)


def turned_runs(problem: PendulumProblem, after: Settled) -> tuple[str, ...]:
    """Return the runs under a known force that are half a turn off, which no cause explains.

    Parameters
    ----------
    after
        The best set of causes; no tolerance is fitted, for it would be torn towards such runs.
    """
    if not problem.driven:
        return ()
    stated = np.abs(problem.residual * problem.uncertainty)
    leftover = np.abs((after.problem.residual - after.best.signature) * problem.uncertainty)
    off = (np.abs(stated - math.pi) < _SIGN_RAD) & (leftover > _SIGN_RAD)
    phase = problem.kind == KINDS.index("period")
    names = [trial.run or trial.name for trial in problem.trials]
    wrong = {run for at, run in enumerate(names) if off[phase & (problem.trial == at)].all()}
    return tuple(run for run in dict.fromkeys(names) if run in wrong)


def as_stated(problem: PendulumProblem) -> FloatArray:
    """Return the gap to the simulation as it is stated, releases at their best, in sigma."""
    release = Nuisances(problem.releases)
    return problem.residual - release.columns @ release.fitted(problem.residual)
