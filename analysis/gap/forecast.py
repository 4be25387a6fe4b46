"""What an answer expects of runs that have not been made, or that nobody has looked at."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import STEADY_PARTS, GapRun, Observation, Stack
from analysis.gap.fit import Fit, Problem, at
from analysis.gap.free import Free, columns
from analysis.gap.gaussian import Nuisances
from analysis.gap.priors import Priors
from hardware.description.errors import PmmError
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun

FloatArray = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Forecast:
    """The distribution that an answer predicts, given the campaign.

    Attributes
    ----------
    mean
        Departure from the nominal simulation in sigma, shape ``(observations,)``.
    root
        Times its transpose it is the covariance, without the noise; ``(observations, k)``.
    """

    mean: FloatArray
    root: FloatArray

    def values(self, there: Problem) -> FloatArray:
        """Return the predicted components in their own units."""
        simulator = there.simulator
        return simulator.nominal + self.mean * simulator.stack.uncertainty


def planned(problem: Problem, set_point: SetPoint, number: int) -> GapRun:
    """Return a run that has not been made, with the noise of the nearest one that has."""
    made = problem.simulator.stack.runs
    near = min(
        made, key=lambda run: abs(math.log(run.set_point.frequency_hz / set_point.frequency_hz))
    )
    kept = [at for at, one in enumerate(near.observed.components) if one.part in STEADY_PARTS]
    parts = tuple(near.observed.components[at] for at in kept)
    longer = set_point.frequency_hz / near.set_point.frequency_hz
    noise = near.observed.uncertainty[kept] * math.sqrt(longer)
    place = CampaignRun(len(made) + number, 0.0, 0.0, made[-1].set_point)
    observed = Observation(parts, np.zeros(len(parts)), noise)
    return GapRun(
        f"further {number}", set_point, place, observed, near.periods, near.sample_rate_hz
    )


def further(
    problem: Problem, runs: Sequence[GapRun], free: Sequence[Free], priors: Priors
) -> Problem:
    """Return the same problem at further runs."""
    simulator = replace(problem.simulator, stack=Stack.of(runs))
    return Problem(simulator, Nuisances(columns(simulator, free, priors)), problem.free)


def forecast(problem: Problem, there: Problem, fit: Fit | None) -> Forecast:
    """Return what an answer predicts at further runs; ``None`` is the answer "no gap".

    Coefficients and settings are as the campaign fits them; frequency and noise are each run's own.
    """
    count = len(problem.free)
    ahead = _Ahead.of(there, fit)
    effect = np.zeros((len(problem.residual), 0)) if fit is None else fit.columns
    shared = np.hstack((problem.nuisances.columns, effect[:, : ahead.columns.shape[1]]))
    covariance = np.linalg.inv(np.eye(shared.shape[1]) + shared.T @ shared)
    residual = problem.residual - (0.0 if fit is None else fit.signature)
    fitted = covariance @ (shared.T @ residual)
    own = problem.nuisances.columns.shape[1]
    kept = np.r_[np.arange(count), own + np.arange(ahead.columns.shape[1])]
    wide = there.nuisances.columns
    known = np.hstack((wide[:, :count], ahead.columns))
    root = np.linalg.cholesky(covariance[np.ix_(kept, kept)])
    mean = ahead.signature + known @ fitted[kept]
    return Forecast(mean, np.hstack((known @ root, wide[:, count:])))


@dataclass(frozen=True, eq=False)
class _Ahead:
    """An effect's signature and columns at further runs; empty where it cannot be run there."""

    signature: FloatArray
    columns: FloatArray

    @classmethod
    def of(cls, there: Problem, fit: Fit | None) -> "_Ahead":
        if fit is not None:
            try:
                found = at(there, fit.candidates, fit.units)
                return cls(found.signature, found.columns)
            except PmmError:
                pass
        count = len(there.nuisances.columns)
        return cls(np.zeros(count), np.zeros((count, 0)))
