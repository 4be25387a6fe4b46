"""What an answer expects of runs that have not been made, or that nobody has looked at."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from scipy.sparse import csr_array

from analysis.gap.design.beside import Beside
from analysis.gap.forward.free_numbers import Free, tolerated
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import STEADY_PARTS, GapRun, Observation, Stack
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.joint import FittedRig
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.errors import PmmError
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun

_FAR: Final = 1e6  # sigma: what is uncertain by more is no better told for it, and rounding eats it
LEAST_FORM: Final = 0.05  # of itself, by which any effect's signature is off on a real rig


@dataclass(frozen=True, eq=False)
class Forecast:
    """The distribution that an answer predicts, given the campaign.

    Attributes
    ----------
    mean
        Departure from the nominal simulation in sigma, shape ``(observations,)``.
    root
        Times its transpose it is the covariance of what all runs share, ``(observations, k)``.
    run_root
        The same of each run's own frequency and phase reference, and of the loudness of its noise.
    form
        The same of the effect's own form, by about as much as it is off.
    deviation
        Covariance of a deviation of no particular form, ``(observations, observations)``: one block
        for each component.
    """

    mean: FloatArray
    root: FloatArray
    run_root: FloatArray
    form: FloatArray
    deviation: csr_array | None = None

    def covariance(self, rows: BoolArray) -> FloatArray:
        """Return the covariance of some observations to be made, their noise in it."""
        root = np.hstack([root[rows] for root in (self.root, self.run_root, self.form)])
        root = np.clip(root, -_FAR, _FAR)
        covariance: FloatArray = np.eye(len(root)) + root @ root.T
        if self.deviation is not None:
            covariance += self.deviation[rows][:, rows].toarray()
        return covariance

    def values(self, problem_ahead: Problem) -> FloatArray:
        """Return the predicted components in their own units."""
        simulator = problem_ahead.simulator
        return simulator.nominal + self.mean * simulator.stack.uncertainty


def next_place(problem: Problem) -> CampaignRun:
    """Return when the next run would be made: as long after the last one as they are apart."""
    stack = problem.simulator.stack
    began_s = np.sort([run.place.since_start_s for run in stack.turning])
    lapse_s = float(np.median(np.diff(began_s))) if len(began_s) > 1 else 0.0
    last = max(stack.turning, key=lambda run: run.place.since_start_s)
    waited_s = last.place.waited_s
    return CampaignRun(len(stack.runs), float(began_s[-1]) + lapse_s, waited_s, last.set_point)


def waited_s(problem: Problem) -> float:
    """Return the median time from the end of a run to the beginning of the next; 0 if untold."""
    runs = sorted(problem.simulator.stack.turning, key=lambda run: run.place.since_start_s)
    began_s = [run.place.since_start_s for run in runs]
    turned_s = [run.periods / run.set_point.frequency_hz for run in runs[:-1]]
    return max(float(np.median(np.diff(began_s) - turned_s)), 0.0) if turned_s else 0.0


def planned(
    problem: Problem, set_point: SetPoint, number: int, place: CampaignRun | None = None
) -> GapRun:
    """Return a run that has not been made, with the noise of the nearest one that has.

    Parameters
    ----------
    place
        When it would be made; nobody knows if not given, and it is as when the campaign began.
    """
    made = problem.simulator.stack.turning
    near = min(
        made, key=lambda run: abs(math.log(run.set_point.frequency_hz / set_point.frequency_hz))
    )
    rows = [
        at
        for at, component in enumerate(near.observed.components)
        if component.part in STEADY_PARTS
    ]
    parts = tuple(near.observed.components[at] for at in rows)
    longer = set_point.frequency_hz / near.set_point.frequency_hz
    noise = near.observed.uncertainty[rows] * math.sqrt(longer)
    planned_place = place or CampaignRun(len(made) + number, 0.0, 0.0, made[-1].set_point)
    observed = Observation(parts, np.zeros(len(parts)), noise)
    return replace(
        near, name=f"further {number}", set_point=set_point, place=planned_place, observed=observed
    )


def with_further_runs(
    problem: Problem, runs: Sequence[GapRun], free: Sequence[Free], tolerances: Tolerances
) -> Problem:
    """Return the same problem at further runs."""
    simulator = replace(problem.simulator, stack=Stack.of(runs))
    nuisances = tolerated(simulator, free, tolerances)
    return Problem(simulator, nuisances, tuple(free))


def forecast(
    problem: Problem,
    problem_ahead: Problem,
    fit: Fit | None,
    columns_ahead: FloatArray | None = None,
    *,
    roughly: bool = False,
    beside: Beside | None = None,
) -> Forecast:
    """Return what an answer predicts at further runs; ``None`` is an answer that names no effect.

    Coefficients and settings are as the campaign fits them; frequency and noise are each run's own,
    and the effect has a form of its own.

    Parameters
    ----------
    columns_ahead
        At the further runs, of a fit that has no effects to be simulated.
    roughly
        Take the effect's signature on the rig as it is believed to be: as the campaign fits its
        coefficients, it differs by a few per cent, as the effect's form does anyway.
    beside
        A deviation of no particular form beside it; none of it if not given.
    """
    if fit is not None and columns_ahead is not None:
        ahead = _Ahead(columns_ahead @ fit.units, columns_ahead)
    else:
        ahead = _Ahead.of(problem, problem_ahead, fit, roughly)
    prediction = _conditioned(problem, problem_ahead, fit, ahead, beside)
    if fit is None:
        return prediction
    # What the coefficients make up for, they make up for in any form.
    calm = _Ahead.of(problem, problem_ahead, None, roughly)
    alone = prediction.mean - _conditioned(problem, problem_ahead, None, calm, beside).mean
    return replace(prediction, form=_of_form(problem_ahead, alone, LEAST_FORM))


def _conditioned(
    problem: Problem,
    problem_ahead: Problem,
    fit: Fit | None,
    ahead: "_Ahead",
    beside: Beside | None,
) -> Forecast:
    """Return the Gaussian of further observations, given those that were made."""
    effect = np.zeros((len(problem.residual), 0)) if fit is None else fit.columns
    shared = np.hstack((problem.nuisances.columns, effect[:, : ahead.columns.shape[1]]))
    residual = problem.residual - (0.0 if fit is None else fit.signature)
    count, wide = len(problem.free), problem_ahead.nuisances.columns
    nuisance_count = problem.nuisances.columns.shape[1]
    columns = np.zeros((len(wide), shared.shape[1]))
    columns[:, :count], columns[:, nuisance_count:] = wide[:, :count], ahead.columns
    deviation, told = None, np.zeros(len(wide))
    if beside is not None:
        scaled = beside.scaled(shared), beside.scaled(columns)
        white = beside.white(np.column_stack((scaled[0], residual)))
        shared, residual = white[:, :-1], white[:, -1]
        columns, told = scaled[1] - beside.carried(shared), beside.carried(residual)
        deviation = beside.deviation
    # A root of the posterior's covariance by the precision's eigenvectors: no eigenvalue is below
    # the prior's 1, however well the campaign tells some numbers and not others.
    precision, turn = np.linalg.eigh(np.eye(shared.shape[1]) + shared.T @ shared)
    spread = turn / np.sqrt(np.maximum(precision, 1.0))
    fitted = spread @ (spread.T @ (shared.T @ residual))
    mean = ahead.signature + told + columns @ fitted
    nothing = np.zeros((len(mean), 0))
    return Forecast(mean, columns @ spread, wide[:, count:], nothing, deviation)


def _of_form(problem_ahead: Problem, signature: FloatArray, share: float) -> FloatArray:
    """Return what the effect's own form may change: of each harmonic of a channel some share."""
    number: dict[tuple[str, int], int] = {}
    kinds = [
        number.setdefault((component.channel, component.order), len(number))
        for component in problem_ahead.simulator.stack.components
    ]
    columns = share * signature[:, None] * np.eye(len(number))[kinds]
    return np.asarray(columns[:, columns.any(axis=0)], np.float64)


@dataclass(frozen=True, eq=False)
class _Ahead:
    """An effect's signature and columns at further runs; empty where it cannot be run there."""

    signature: FloatArray
    columns: FloatArray

    @classmethod
    def of(
        cls, problem: Problem, problem_ahead: Problem, fit: Fit | None, roughly: bool
    ) -> "_Ahead":
        if fit is not None:
            try:
                fit_ahead = linearised_at(problem_ahead, fit.candidates, fit.units)
                signature = fit_ahead.signature
                if not roughly:
                    signature = _on_fitted_rig(problem, problem_ahead, fit, fit_ahead)
                return cls(signature, fit_ahead.columns)
            except PmmError:
                pass
        count = len(problem_ahead.nuisances.columns)
        return cls(np.zeros(count), np.zeros((count, 0)))


def _on_fitted_rig(
    problem: Problem, problem_ahead: Problem, fit: Fit, fit_ahead: Fit
) -> FloatArray:
    """Return the signature at further runs on the rig as the campaign fits its coefficients."""
    if not any(candidate.repeats for candidate in fit.candidates):
        return fit_ahead.signature
    shared = problem.nuisances.fitted(problem.residual - fit.signature)[
        : len(problem_ahead.numbers)
    ]
    return FittedRig.of(problem_ahead, problem_ahead.numbers, shared).signature(
        fit.candidates, fit.units
    )
