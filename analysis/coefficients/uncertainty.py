"""Uncertainty of coefficients: to first order with shares, and by Monte Carlo beside it.

Scatter of the harmonics belongs to each run, stated uncertainties are shared by all of them, so
that runs do not average out an unknown mass. Derivatives are central differences, all at once.
"""

from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from analysis.coefficients.model import PER_RUN, STATED, Problem, Stated
from analysis.coefficients.phasors import FloatArray, Source
from analysis.coefficients.result import Share
from analysis.coefficients.run import LOADS, MOTIONS, Run
from analysis.uncertainty import Contribution, added

_STEP = 1e-6  # of the run's largest motion or load
_STATED_STEP = 0.01  # of the stated uncertainty: curvature is the Monte Carlo's to find
TRIALS_AT_ONCE = 5_000
_IN_CACHE = 250  # trials solved at once: more wait for memory, and for each other's workers


@dataclass(frozen=True, eq=False)
class Trials:
    """What a Monte Carlo gave.

    Attributes
    ----------
    mean, standard_uncertainty, low, high
        Mean, standard deviation and the symmetric interval of each coefficient, shape ``(n,)``.
    covariance
        Shape ``(n, n)``.
    """

    count: int
    mean: FloatArray
    standard_uncertainty: FloatArray
    covariance: FloatArray
    low: FloatArray
    high: FloatArray


def linear_shares(problem: Problem, stated: Stated) -> tuple[FloatArray, tuple[Share, ...]]:
    """Return the covariance to first order and what each source adds to it.

    Returns
    -------
    covariance
        Of ``problem.flat``'s coefficients, shape ``(n, n)``.
    shares
        Scatter by source, then each stated uncertainty that is not zero.
    """
    by_phasor, by_stated = slopes(problem, stated)
    rows, parts = np.arange(len(by_phasor)), []
    for k, run in enumerate(problem.runs):
        slope = by_phasor[:, k * PER_RUN : (k + 1) * PER_RUN]
        for source in _sources(run):
            own = slope @ source.root
            parts.append(Contribution(source.label, source.degrees_of_freedom, rows, own))
    for k, (name, spread) in enumerate(zip(STATED, stated.vector, strict=True)):
        if spread > 0.0:
            column = by_stated[:, k, None] * spread
            parts.append(Contribution(name, stated.freedom(name), rows, column))
    covariance = np.zeros((len(rows), len(rows)))
    shares = []
    for one in added(parts):
        product = one.parts @ one.parts.T
        covariance += product
        shares.append(Share(one.label, np.diagonal(product), one.degrees_of_freedom))
    return covariance, tuple(shares)


def freedom(shares: tuple[Share, ...], size: int) -> FloatArray:
    """Return the effective degrees of freedom (Welch and Satterthwaite), shape ``(size,)``."""
    total, loss = np.zeros(size), np.zeros(size)
    for share in shares:
        total += share.variance
        if share.degrees_of_freedom > 0.0:
            loss += share.variance**2 / share.degrees_of_freedom
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(loss > 0.0, total**2 / loss, np.inf))


def monte_carlo(
    problem: Problem, stated: Stated, *, trials: int, seed: int, level: float = 0.95
) -> Trials:
    """Draw phasors and stated quantities and solve each trial.

    Scatter with few degrees of freedom is drawn from Student's t, as its own kind of knowledge.
    """
    counts = [min(TRIALS_AT_ONCE, trials - start) for start in range(0, trials, TRIALS_AT_ONCE)]
    found = [draw(problem, stated, count, (seed, k)) for k, count in enumerate(counts)]
    values = np.concatenate(found)
    tail = (1.0 - level) / 2.0
    low, high = np.quantile(values, (tail, 1.0 - tail), axis=0)
    return Trials(
        trials,
        values.mean(axis=0),
        values.std(axis=0, ddof=1),
        np.cov(values, rowvar=False),
        low,
        high,
    )


def draw(problem: Problem, stated: Stated, count: int, seed: tuple[int, int]) -> FloatArray:
    """Return one block of trials, shape ``(count, n)``: the same wherever it is drawn.

    Parameters
    ----------
    seed
        Of the whole, and the number of the block.
    """
    generator = np.random.default_rng(np.random.SeedSequence(seed[0], spawn_key=(seed[1],)))
    parts = np.broadcast_to(problem.phasor_parts(), (count, len(problem.runs), PER_RUN)).copy()
    scatter = Scatter(count, generator)
    for k, run in enumerate(problem.runs):
        for source in _sources(run):
            parts[:, k] += scatter.of(source)
    deviations = stated.drawn(count, generator)
    pieces = range(0, count, _IN_CACHE)
    solved = [
        problem.solve(parts[k : k + _IN_CACHE], deviations[k : k + _IN_CACHE]) for k in pieces
    ]
    return problem.flat(np.concatenate(solved))


class Scatter:
    """Draws of the sources' scatter: runs that share a source get the same ones of it."""

    def __init__(self, count: int, generator: Generator) -> None:
        self._count, self._generator = count, generator
        self._deviates: dict[str, FloatArray] = {}

    def of(self, source: Source) -> FloatArray:
        """Return what a source adds, shape ``(count, 2 n)``: Student's t where that is known."""
        if source.label not in self._deviates:
            self._deviates[source.label] = self._drawn(source)
        return np.asarray(self._deviates[source.label] @ source.root.T)

    def _drawn(self, source: Source) -> FloatArray:
        normal = self._generator.standard_normal((self._count, source.root.shape[1]))
        nu = source.degrees_of_freedom
        if np.isfinite(nu) and nu > 0.0:
            normal *= np.sqrt(nu / self._generator.chisquare(nu, self._count))[:, None]
        return normal


def _sources(run: Run) -> tuple[Source, ...]:
    return run.phasors.select((*MOTIONS, *LOADS)).sources


def slopes(problem: Problem, stated: Stated) -> tuple[FloatArray, FloatArray]:
    """Return derivatives by phasors ``(n, 8 runs)`` and by stated quantities ``(n, stated)``."""
    parts = problem.phasor_parts()
    steps = np.concatenate((_steps(problem, parts).ravel(), _STATED_STEP * stated.vector))
    count = len(steps)
    shifts = np.concatenate((np.diag(steps), -np.diag(steps)))
    trial = parts[None] + shifts[:, : parts.size].reshape(2 * count, *parts.shape)
    solved = problem.flat(problem.solve(trial, shifts[:, parts.size :]))
    with np.errstate(invalid="ignore"):
        found = (solved[:count] - solved[count:]) / (2.0 * steps[:, None])
    found[steps == 0.0] = 0.0
    return found[: parts.size].T, found[parts.size :].T


def _steps(problem: Problem, parts: FloatArray) -> FloatArray:
    """Steps of each phasor's parts: a millionth of the run's motion or load."""
    half = np.array([run.half_spacing_m for run in problem.runs])
    size = np.abs(parts).reshape(len(half), 4, 2).max(axis=2)
    way = np.maximum(size[:, 0], size[:, 1] * half)
    load = np.maximum(size[:, 2], size[:, 3] / half)
    steps = _STEP * np.stack((way, way / half, load, load * half), axis=-1)
    return np.repeat(steps, 2, axis=1)
