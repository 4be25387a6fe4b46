"""Which release would tell the leading answers apart, among those that a test can make."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.gap.gaussian import Nuisances, misfit
from analysis.gap.pendulum.hypothesis import Hypothesis, held
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.trial import Problem, Trial

_DECAY, _MEAN = 0, 2


@dataclass(frozen=True)
class Proposal:
    """A further release and what it is expected to bring.

    Attributes
    ----------
    separation
        Expected difference of the two answers in sigma, all that is free fitted again; half its
        square is the expected gain in log evidence.
    """

    what: str
    factor: float
    longer: float
    separation: float


def propose(
    problem: Problem,
    first: Hypothesis,
    second: Hypothesis,
    wide: float = 1.0,
    factors: Sequence[float] = (0.5, 1.0, 1.5, 2.0, 3.0),
) -> tuple[Proposal, ...]:
    """Rank further releases of the first trial: larger and smaller ones, and longer records.

    Parameters
    ----------
    wide
        Chi-square per degree of freedom of the record there is: uncertainties are this much wider.
    """
    found = []
    for factor in factors:
        for longer in (1.0, 2.0):
            trial = _planned(problem.trials[0], factor, longer, first, wide)
            away = _separation(problem, trial, first, second)
            what = f"release at {factor:g} times the amplitude"
            what += ", a record twice as long" if longer > 1.0 else ", a record as long"
            found.append(Proposal(what, factor, longer, away))
    return tuple(sorted(found, key=lambda one: -one.separation))


def _planned(trial: Trial, factor: float, longer: float, first: Hypothesis, wide: float) -> Trial:
    """Return a trial as the first answer foretells it, with noise like the record's."""
    windows = replace(trial.windows, count=round(longer * trial.windows.count))
    held_at = trial.bench.release
    release = replace(
        held_at,
        displacement=tuple(factor * value for value in held_at.displacement),
        rate=tuple(factor * value for value in held_at.rate),
    )
    bench = replace(trial.bench, release=release)
    planned = replace(trial, windows=windows, bench=bench)
    observed = planned.simulate(first.effects(trial))
    known = np.exp(trial.observed[_DECAY])
    size = np.exp(observed[_DECAY])
    spread = np.empty_like(observed)
    for kind in range(len(KINDS)):
        own = trial.uncertainty[kind]
        absolute = np.nanmedian(own if kind == _MEAN else own * known)
        spread[kind] = absolute * math.sqrt(wide) / (1.0 if kind == _MEAN else size)
    return replace(planned, observed=observed, uncertainty=spread)


def _separation(problem: Problem, trial: Trial, first: Hypothesis, second: Hypothesis) -> float:
    there = replace(problem, trials=(trial,))
    one, other = (held(there, h.causes, h.units) for h in (first, second))
    root = np.linalg.cholesky(second.posterior.covariance)
    columns = [there.nuisances.columns, other.columns @ root]
    return math.sqrt(
        max(misfit(one.signature - other.signature, Nuisances(np.hstack(columns))), 0.0)
    )
