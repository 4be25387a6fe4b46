"""A bench that does what a simulated record does: where the simulation is somebody else's.

The record of a foreign simulation (a potential flow code, say) becomes a body afloat whose damping
and restoring are fitted to it. What the bench does not reproduce of the record is the model's own
error and goes into the uncertainty of every comparison.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.gap.forward.candidate import Candidate
from analysis.gap.forward.problem import built
from analysis.gap.pendulum.causes import cause
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import cause_names, fit
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.trial import Trial
from analysis.gap.search.fit import Fit, no_effect
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.pendulum.bench import PendulumBench
from sim.pendulum.effects import body as effects
from sim.pendulum.effects.setup import RestoringError

_STAGES = (
    (effects.ViscousDamping,),
    (effects.ViscousDamping, effects.QuadraticDrag),
)
_PERIODS = (
    (RestoringError,),
    (RestoringError, effects.AmplitudePeriod),
    (RestoringError, effects.AmplitudePeriod, effects.CubicRestoring),
)
_OF_PERIODS = ("restoring", "amplitude_period")


@dataclass(frozen=True, eq=False)
class Surrogate:
    """A bench and how well it stands for the record.

    Attributes
    ----------
    variants
        Benches one standard deviation away, along each direction in which the record leaves the
        parameters free: how unsure the bench is, beyond the record's amplitudes above all.
    rms
        What it leaves of amplitude (logarithm), phase in rad, mean and third harmonic; 0 where the
        record has none.
    """

    bench: PendulumBench
    variants: tuple[PendulumBench, ...]
    effects: tuple[str, ...]
    rms: tuple[float, ...]


def surrogate(trial: Trial, *, restoring: bool = True) -> Surrogate:
    """Fit damping, and restoring that changes with amplitude, to a trial's own record.

    Parameters
    ----------
    restoring
        Whether the restoring may change too; only the decay is followed otherwise.
    """
    kinds = KINDS[:2] if restoring else KINDS[:1]
    problem = PendulumProblem((trial,), kinds=kinds)
    best = no_effect(problem)
    for stage in _STAGES:
        best = _better_fit(problem, best, [cause(kind) for kind in stage])
    for more in _PERIODS if restoring else ():
        candidates = [
            candidate for candidate in best.candidates if candidate.name not in _OF_PERIODS
        ]
        best = _better_fit(problem, best, [*candidates, *(cause(kind) for kind in more)])
    bench = _released_bench(problem, trial, best)
    remainder = trial.observed - replace(trial, bench=bench).simulate()
    rms = tuple(_rms(row) for row in remainder)
    return Surrogate(bench, tuple(_variants(trial, best)), cause_names(best), rms)


def _variants(trial: Trial, best: Fit) -> Iterator[PendulumBench]:
    values, vectors = np.linalg.eigh(best.posterior.covariance)
    for value, vector in zip(values, vectors.T, strict=True):
        for sign in (1.0, -1.0):  # the other way where this one leaves what a body can do
            moved = best.units + sign * np.sqrt(value) * vector
            try:
                yield trial.bench.with_effects(trial.placed(built(best.candidates, moved)))
            except PmmError:
                continue
            break


def _rms(row: FloatArray) -> float:
    good = row[np.isfinite(row)]
    return float(np.sqrt(np.mean(good**2))) if good.size else 0.0


def _better_fit(problem: PendulumProblem, best: Fit, causes: Sequence[Candidate]) -> Fit:
    start = np.concatenate([_start(best, candidate) for candidate in causes])
    tried = fit(problem, causes, start)
    return tried if tried.log_evidence > best.log_evidence else best


def _start(best: Fit, candidate: Candidate) -> FloatArray:
    """Return where the best fit has a cause, or its typical value."""
    at = 0
    for part in best.candidates:
        if part.name == candidate.name:
            return best.units[at : at + len(candidate.axes)]
        at += len(part.axes)
    return 0.1 * candidate.start


def _released_bench(problem: PendulumProblem, trial: Trial, best: Fit) -> PendulumBench:
    """Return the bench with the effects, released as the record was."""
    free = problem.nuisances.fitted(problem.residual - best.signature)
    released = trial.as_released(float(free[0]), float(free[1]))
    return released.bench.with_effects(trial.placed(best.effects))
