"""How far the gap shrinks on swings that the fit has not seen.

Half of each record's range of amplitude (in its logarithm) is withheld, first the small swings,
then the large ones; of one body on several suspensions each suspension in its turn, for light gates
do not tell an amplitude; under a known force each run. Everything is fitted to the rest: releases,
tolerances, causes.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.gap.inference.gaussian import Nuisances, posterior
from analysis.gap.judge.withheld import gap_of, share_gone
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import cause_names, fit
from analysis.gap.pendulum.trial import Trial
from analysis.gap.search.fit import Fit, linearised_at, no_effect
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import PmmError

_DRAWS = 400
_SEED = 20261
_DECAY, _PERIOD = 0, 1
FEWEST = 5  # windows in either half
FEWEST_RUNS = 3


@dataclass(frozen=True)
class WithheldPrediction:
    """One hypothesis on the withheld swings.

    Attributes
    ----------
    gap
        Root mean square of measured less foretold, of the kinds that are compared, in u.
    amplitude_gap
        The same of the amplitudes, in the record's unit.
    period_gap
        The same of the phases, in rad.
    shrinkage, low, high
        Share of the gap without a cause that goes away, noise floor taken off, and its 95 %
        interval from what the fitted swings leave open.
    """

    causes: tuple[str, ...]
    gap: float
    amplitude_gap: float
    period_gap: float
    shrinkage: float
    low: float
    high: float


@dataclass(frozen=True)
class WithheldSwings:
    """What was withheld, and how each hypothesis foretold it.

    Attributes
    ----------
    amplitude
        Range of the withheld windows' amplitudes.
    before
        Without a cause.
    """

    name: str
    windows: int
    amplitude: tuple[float, float]
    before: WithheldPrediction
    foretold: tuple[WithheldPrediction, ...]

    @property
    def gap(self) -> bool:
        """Whether there is anything to foretell, by four standard deviations of its square."""
        return self.before.gap**2 > 1.0 + 4.0 * math.sqrt(2.0 / self.windows)


def predict_withheld(problem: PendulumProblem, sets: Sequence[Fit]) -> tuple[WithheldSwings, ...]:
    """Withhold small swings, then large ones, and foretell them with some sets of causes.

    Where the records are of several suspensions, each of them is withheld instead.

    Parameters
    ----------
    sets
        The answer first: compared are the kinds of observables in which its causes show most.
    """
    if problem.suspensions:
        return (_left_out("each suspension", problem, sets),)
    if problem.driven:
        enough = len(set(problem.runs)) >= FEWEST_RUNS
        return (_left_out("each run", problem, sets),) if enough else ()
    regimes = []
    for name, large in (("small swings", False), ("large swings", True)):
        hidden = [_withheld_windows(trial, large=large) for trial in problem.trials]
        if (
            min(
                _least_count(rows, trial)
                for rows, trial in zip(hidden, problem.trials, strict=True)
            )
            >= FEWEST
        ):
            regimes.append(_regime(name, problem, hidden, sets))
    return tuple(regimes)


def _withheld_windows(trial: Trial, *, large: bool) -> BoolArray:
    size = trial.observed[_DECAY]
    middle = 0.5 * (np.nanmin(size) + np.nanmax(size))
    return np.asarray(size > middle if large else size <= middle)


def _least_count(hidden: BoolArray, trial: Trial) -> int:
    good = np.isfinite(trial.observed[_DECAY])
    return int(min((good & hidden).sum(), (good & ~hidden).sum()))


def _regime(
    name: str,
    problem: PendulumProblem,
    hidden: Sequence[BoolArray],
    sets: Sequence[Fit],
) -> WithheldSwings:
    training = _without_windows(problem, hidden)
    parts = [
        np.broadcast_to(rows, (len(t.observed), rows.size))
        for rows, t in zip(hidden, problem.trials, strict=True)
    ]
    rows = problem.flat([part.astype(float) for part in parts]) > 0.5
    plain = _remainder(problem, no_effect(training), rows)
    shown = _shown(problem, sets)
    before = _prediction(problem, rows, shown, (), plain, plain)
    after = []
    for cause_set in sets:
        remainder = _remainder(problem, fit(training, cause_set.candidates, cause_set.units), rows)
        after.append(_prediction(problem, rows, shown, cause_names(cause_set), plain, remainder))
    sizes = problem.amplitude[rows]
    count = int(sum(r.sum() for r in hidden))
    return WithheldSwings(
        name, count, (float(sizes.min()), float(sizes.max())), before, tuple(after)
    )


def _without_windows(problem: PendulumProblem, hidden: Sequence[BoolArray]) -> PendulumProblem:
    """Return the problem without some windows of each trial."""
    trials = [
        replace(trial, observed=np.where(rows, np.nan, trial.observed))
        for trial, rows in zip(problem.trials, hidden, strict=True)
    ]
    return replace(problem, trials=tuple(trials))


def _left_out(name: str, problem: PendulumProblem, sets: Sequence[Fit]) -> WithheldSwings:
    """Foretell each run from the others; the sensors of one run belong together."""
    all_rows = np.ones(problem.residual.size, dtype=bool)
    remainders: list[list[tuple[FloatArray, FloatArray]]] = [[] for _ in (None, *sets)]
    for out in np.unique(problem.runs):
        hidden = [
            np.full(trial.windows.count, run == out)
            for run, trial in zip(problem.runs, problem.trials, strict=True)
        ]
        training, rows = _without_windows(problem, hidden), problem.runs[problem.trial] == out
        remainders[0].append(_remainder(problem, no_effect(training), rows))
        for set_remainders, cause_set in zip(remainders[1:], sets, strict=True):
            try:
                set_remainders.append(
                    _remainder(problem, fit(training, cause_set.candidates, cause_set.units), rows)
                )
            except PmmError:  # friction that holds the body there foretells nothing
                set_remainders.append(remainders[0][-1])
    plain, *after = [
        (np.concatenate([values for values, _ in part]), np.hstack([drawn for _, drawn in part]))
        for part in remainders
    ]
    sizes, shown = problem.amplitude, _shown(problem, sets)
    return WithheldSwings(
        name,
        sum(trial.windows.count for trial in problem.trials),
        (float(sizes.min()), float(sizes.max())),
        _prediction(problem, all_rows, shown, (), plain, plain),
        tuple(
            _prediction(problem, all_rows, shown, cause_names(cause_set), plain, remainder)
            for cause_set, remainder in zip(sets, after, strict=True)
        ),
    )


def _remainder(
    problem: PendulumProblem, cause_set: Fit, rows: BoolArray
) -> tuple[FloatArray, FloatArray]:
    """Return the withheld windows' remainder in u, and draws of it, shape ``(draws, rows)``."""
    full = linearised_at(problem, cause_set.candidates, cause_set.units)
    nuisance_columns = problem.nuisances.columns
    among = Nuisances(nuisance_columns[~rows])
    residual = problem.residual - full.signature
    columns = np.hstack([nuisance_columns, full.columns])
    estimate = posterior(
        residual[~rows], columns[~rows], Nuisances(np.zeros((int((~rows).sum()), 0)))
    )
    remainder = residual[rows] - nuisance_columns[rows] @ among.fitted(residual[~rows])
    drawn = np.random.default_rng(_SEED).standard_normal((_DRAWS, columns.shape[1]))
    return remainder, remainder - drawn @ (columns[rows] @ estimate.root).T


def _shown(problem: PendulumProblem, sets: Sequence[Fit]) -> BoolArray:
    """Return which observations are of the kinds in which causes of the answer show most."""
    answer, kinds, shown = sets[0], np.unique(problem.kind), []
    for number in range(len(answer.candidates)):
        own = answer.effect_index == number
        change = answer.columns[:, own] @ answer.units[own]
        shown.append(max(kinds, key=lambda kind: _rms(change[problem.kind == kind])))
    return np.isin(problem.kind, shown)


def _prediction(
    problem: PendulumProblem,
    rows: BoolArray,
    shown: BoolArray,
    causes: tuple[str, ...],
    plain: tuple[FloatArray, FloatArray],
    remainder: tuple[FloatArray, FloatArray],
) -> WithheldPrediction:
    kind, chosen = problem.kind[rows], shown[rows]
    absolute = remainder[0] * problem.uncertainty[rows]
    share, low, high = 0.0, 0.0, 0.0
    if causes:
        old = gap_of(plain[0][chosen])
        share = share_gone(old, gap_of(remainder[0][chosen]))
        shares = [share_gone(old, gap_of(draw[chosen])) for draw in remainder[1]]
        low, high = (float(value) for value in np.quantile(shares, (0.025, 0.975)))
    return WithheldPrediction(
        causes,
        _rms(remainder[0][chosen]),
        _rms((absolute * problem.amplitude[rows])[kind == _DECAY]),
        _rms(absolute[kind == _PERIOD]),
        share,
        min(low, share),
        max(high, share),
    )


def _rms(remainder: FloatArray) -> float:
    return float(np.sqrt(np.mean(remainder**2))) if remainder.size else math.nan
