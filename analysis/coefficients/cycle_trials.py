"""Monte Carlo of fits, beside their linear budget: all that is uncertain, drawn through the fit."""

import numpy as np
from numpy.random import Generator

from analysis.coefficients.campaign_result import TrialColumns
from analysis.coefficients.cycle_fit import CycleFit
from analysis.uncertainty.values import Contribution
from hardware.description.arrays import FloatArray

TRIALS_AT_ONCE = 5_000
_DESIGNS_AT_ONCE = 4_000  # of one cycle: some 100 MB


def cycle_trials(fit: CycleFit, trials: int, seed: int, level: float = 0.95) -> TrialColumns:
    """Return standard deviation and interval of each coefficient of a fit.

    Weights stay those of the fit, as its budget has it.
    """
    counts = block_sizes(trials)
    drawn = [draw_cycles(fit, count, (seed, k)) for k, count in enumerate(counts)]
    return columns(np.concatenate(drawn), level)


def block_sizes(trials: int) -> list[int]:
    """Return how many trials each block draws."""
    return [min(TRIALS_AT_ONCE, trials - start) for start in range(0, trials, TRIALS_AT_ONCE)]


def columns(values: FloatArray, level: float) -> TrialColumns:
    """Return what a campaign's table holds of trials, shape ``(trials, n)``."""
    tail = (1.0 - level) / 2.0
    low, high = np.quantile(values, (tail, 1.0 - tail), axis=0)
    return TrialColumns(len(values), values.std(axis=0, ddof=1), low, high)


def draw_cycles(fit: CycleFit, count: int, seed: tuple[int, int]) -> FloatArray:
    """Return one block of trials, shape ``(count, n)``: the same wherever it is drawn.

    Parameters
    ----------
    seed
        Of the whole, and the number of the block.
    """
    generator = np.random.default_rng(np.random.SeedSequence(seed[0], spawn_key=(seed[1],)))
    problem, numbers = fit.problem, fit.problem.numbers
    scatter = DeviateDraws(count, generator)
    deviations = fit.stated.draw(count, generator)
    ways = []
    for cycle in numbers.cycles:
        cycle_ways = [
            (scatter.of(source), numbers.scatter(cycle, source).T)
            for source in cycle.hull.phasors.real.contributions
        ]
        ways.append([*cycle_ways, (deviations, numbers.sensitivity(cycle).T)])
    pieces = -(-count * len(numbers.cycles) // _DESIGNS_AT_ONCE)
    cycles = []
    for trials in np.array_split(np.arange(count), pieces):
        parts = [
            nominal + sum(deviates[trials] @ way for deviates, way in cycle_ways)
            for nominal, cycle_ways in zip(numbers.parts, ways, strict=True)
        ]
        cycles.append(problem.solve(np.stack(parts, axis=1)))
    return np.concatenate(cycles)


class DeviateDraws:
    """Draws of the sources' deviates: runs that share a source get the same ones of it."""

    def __init__(self, count: int, generator: Generator) -> None:
        self._count, self._generator = count, generator
        self._deviates: dict[str, FloatArray] = {}

    def of(self, source: Contribution) -> FloatArray:
        """Return the deviates, shape ``(count, k)``: Student's t where that is known."""
        if source.label not in self._deviates:
            normal = self._generator.standard_normal((self._count, source.parts.shape[1]))
            self._deviates[source.label] = source.deviates(normal.T, self._generator).T
        return self._deviates[source.label]
