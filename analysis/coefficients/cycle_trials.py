"""Monte Carlo of non-linear fits, beside their linear budget: the same function, drawn through."""

import numpy as np

from analysis.coefficients.campaign_result import TrialColumns
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.cycle_model import DESIGNS_AT_ONCE
from analysis.coefficients.phasors import FloatArray
from analysis.coefficients.uncertainty import Scatter

TRIALS_AT_ONCE = 500  # whole cycles are wide


def cycle_trials(fit: CycleFit, trials: int, seed: int, level: float = 0.95) -> TrialColumns:
    """Return standard deviation and interval of each coefficient of a fit.

    Weights stay those of the fit, as its budget has it.
    """
    counts = [min(TRIALS_AT_ONCE, trials - start) for start in range(0, trials, TRIALS_AT_ONCE)]
    drawn = np.concatenate([draw_cycles(fit, count, (seed, k)) for k, count in enumerate(counts)])
    tail = (1.0 - level) / 2.0
    low, high = np.quantile(drawn, (tail, 1.0 - tail), axis=0)
    return TrialColumns(trials, drawn.std(axis=0, ddof=1), low, high)


def draw_cycles(fit: CycleFit, count: int, seed: tuple[int, int]) -> FloatArray:
    """Return one block of trials, shape ``(count, n)``: the same wherever it is drawn.

    Parameters
    ----------
    seed
        Of the whole, and the number of the block.
    """
    generator = np.random.default_rng(np.random.SeedSequence(seed[0], spawn_key=(seed[1],)))
    problem = fit.problem
    parts = np.repeat(problem.parts()[None], count, axis=0)
    scatter = Scatter(count, generator)
    for k, cycle in enumerate(problem.cycles):
        to, places = problem.measured(cycle)
        for source in cycle.phasors.sources:
            parts[:, k, to] += scatter.of(source)[:, places]
    deviations = fit.stated.drawn(count, generator)
    pieces = np.array_split(np.arange(count), -(-count * len(problem.cycles) // DESIGNS_AT_ONCE))
    return np.concatenate([problem.solve(parts[some], deviations[some]) for some in pieces])
