"""Which further record would tell the leading answers apart, among those that a test can make."""

import math
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.design.information_gain import expected_log_odds
from analysis.gap.inference.gaussian import Nuisances, posterior
from analysis.gap.pendulum.driven import DrivenTrial
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.trial import Trial
from analysis.gap.search.fit import Fit, linearised_at
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, PmmError
from sim.pendulum.effects.base import small_swing, suspension_of

_DECAY, _MEAN = 0, 2
_FACTORS: Final = (0.5, 1.0, 1.5, 2.0, 3.0)  # of the release
_BEYOND: Final = 1.25  # how far past the lines that were used, where nothing is said
_EACH: Final = 5  # spacings, and lines


@dataclass(frozen=True)
class FurtherRecord:
    """A further record and what it is expected to bring.

    Attributes
    ----------
    gains
        By how much the right one of two answers is expected to gain on the other in ln evidence:
        if the first is right, and if the second is.
    """

    record: str
    gains: tuple[float, float]

    @property
    def gain(self) -> float:
        """The least of them: what it brings whichever is right."""
        return min(self.gains)


@dataclass(frozen=True)
class Reach:
    """Smallest and largest half spacing and length of lines, m, that a body can be hung on."""

    half_spacing_m: tuple[float, float]
    line_m: tuple[float, float]

    def __post_init__(self) -> None:
        for name in ("half_spacing_m", "line_m"):
            low, high = getattr(self, name)
            if not 0.0 < low <= high:
                raise ConfigurationError(
                    f"{name} = [{low:g}, {high:g}] is no range of lengths: above 0, smallest first"
                )


def propose(
    problem: PendulumProblem,
    first: Fit,
    second: Fit,
    reach: Reach | None = None,
) -> tuple[FurtherRecord, ...]:
    """Rank further records: other suspensions where light gates watch one, forces, releases.

    Parameters
    ----------
    reach
        Of suspensions; where left out a little beyond those that were used, but no wider.
    """
    planned_records = (
        _suspensions(problem, first, reach or _reach(problem))
        if problem.on_lines
        else _runs(problem.trials, first)
        if problem.driven
        else _releases(problem.trials[0], first)
    )
    records = []
    for label, trial in planned_records:
        try:
            expected = [_predict(problem, trial, answer) for answer in (first, second)]
        except PmmError:  # an answer's friction holds the body at rest
            continue
        means = np.column_stack([answer.mean for answer in expected])
        odds = expected_log_odds(means, [answer.covariance for answer in expected])
        records.append(FurtherRecord(label, (float(odds[0, 1]), float(odds[1, 0]))))
    return tuple(sorted(records, key=lambda record: -record.gain))


def _releases(trial: Trial, first: Fit) -> Iterator[tuple[str, Trial]]:
    """Yield larger and smaller releases, and longer records, as the first answer foretells them."""
    held_at = trial.bench.release
    for factor in _FACTORS:
        for longer in (1, 2):
            release = replace(
                held_at,
                displacement=tuple(factor * value for value in held_at.displacement),
                rate=tuple(factor * value for value in held_at.rate),
            )
            windows = replace(trial.windows, count=longer * trial.windows.count)
            bench = replace(trial.bench, release=release)
            label = f"release at {factor:g} times the amplitude"
            label += ", a record twice as long" if longer > 1 else ", a record as long"
            yield label, _planned(replace(trial, windows=windows, bench=bench), trial, first)


def _runs(trials: Sequence[Trial], first: Fit) -> Iterator[tuple[str, Trial]]:
    """Yield the runs again under smaller and larger forces, as the first answer foretells them."""
    for trial in (trial for trial in trials if isinstance(trial, DrivenTrial)):
        for factor in _FACTORS:
            label = f"{trial.name} again under {factor:g} times the force"
            with suppress(PmmError):
                yield label, _planned(trial.pushed(factor), trial, first)


def _suspensions(problem: PendulumProblem, first: Fit, reach: Reach) -> Iterator[tuple[str, Trial]]:
    """Yield suspensions within reach, as the first answer foretells their records."""
    trial = problem.trials[0]
    body = suspension_of(trial.bench, "a further suspension")
    halves, lines = (
        np.unique(np.round(np.geomspace(*span, _EACH), 2))
        for span in (reach.half_spacing_m, reach.line_m)
    )
    for half in halves:
        for line in lines:
            hung = replace(body, half_spacing_m=float(half), line_length_m=float(line))
            planned = replace(trial, bench=replace(trial.bench, body=hung))
            on = planned.placed([*planned.effects, *first.effects])
            bench = planned.bench.with_effects(on)
            inertia, restoring = small_swing(bench, trial.acts_on)
            omega = math.sqrt(restoring / inertia)
            planned = replace(planned, windows=replace(trial.windows, reference_rad_s=omega))
            label = f"half spacing {half:.2f} m, lines of {line:.2f} m"
            yield label, _planned(planned, trial, first)


def _reach(problem: PendulumProblem) -> Reach:
    bodies = [suspension_of(trial.bench, "a further suspension") for trial in problem.trials]
    halves = [body.half_spacing_m for body in bodies]
    lines = [body.line_length_m for body in bodies]
    return Reach((min(halves) / _BEYOND, max(halves)), (min(lines) / _BEYOND, _BEYOND * max(lines)))


def _planned(planned: Trial, trial: Trial, first: Fit) -> Trial:
    """Return a trial as the first answer foretells it, with noise like the record's."""
    observed = planned.simulate(first.effects)
    record_size, size = np.exp(trial.observed[_DECAY]), np.exp(observed[_DECAY])
    spread = np.full_like(observed, np.nan)
    for kind in range(len(KINDS)):
        noise = trial.uncertainty[kind] if kind == _MEAN else trial.uncertainty[kind] * record_size
        if np.isfinite(noise).any():
            spread[kind] = np.nanmedian(noise) / (1.0 if kind == _MEAN else size)
    return replace(planned, observed=observed, uncertainty=spread)


@dataclass(frozen=True, eq=False)
class _Prediction:
    """What one answer expects of a record, in sigma: normal, with this mean and covariance."""

    mean: FloatArray
    covariance: FloatArray


def _predict(problem: PendulumProblem, trial: Trial, answer: Fit) -> _Prediction:
    """Return what an answer expects of a planned record, given the records that there are."""
    problem_ahead = replace(problem, trials=(trial,))
    same_body = len(problem.trials) == 1 and not problem.on_lines
    (shared, free), (carried, begun) = (
        _shared_and_separate(part, same_body=same_body) for part in (problem, problem_ahead)
    )
    columns = np.hstack([shared, answer.columns])
    estimate = posterior(answer.linearised(problem.residual), columns, Nuisances(free))
    planned = linearised_at(problem_ahead, answer.candidates, answer.units)
    slopes = np.hstack([carried, planned.columns])
    moved = estimate.mean - np.concatenate([np.zeros(shared.shape[1]), answer.units])
    covariance = np.eye(len(slopes)) + begun @ begun.T + slopes @ estimate.covariance @ slopes.T
    return _Prediction(planned.signature + slopes @ moved, covariance)


def _shared_and_separate(
    problem: PendulumProblem, *, same_body: bool
) -> tuple[FloatArray, FloatArray]:
    """Return the columns that a further record shares with the others, and those it does not."""
    record_columns: Sequence[FloatArray] = (problem.releases, problem.model_error_columns)
    if same_body:  # the same body in the same set-up: only the release is new
        return np.hstack([problem.shared_columns, problem.set_ups]), np.hstack(record_columns)
    return problem.shared_columns, np.hstack([*record_columns, problem.set_ups])
