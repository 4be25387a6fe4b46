"""Which run a fit of several runs does not agree with, and the coefficients without it.

A run is left out with all its numbers. What the weighted squares fall by then, over the numbers, is
held against what the other runs leave over (Fisher), and against the runs' own scatter: a run is
named only where it is beyond chance by both, so neither a scatter that is too small nor a form that
none of the runs has names one of them.
"""

import math
from collections.abc import Iterator

import numpy as np

from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.terms import LOAD_WORDS
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag

_DETERMINED = 1e6  # condition of scaled columns beyond which the others tell nothing


def run_flags(fit: CycleFit) -> Iterator[Flag]:
    """Yield ``data_disagree`` for each load with a run that stands out."""
    for row, _ in fit.problem.rows:
        agreement = run_agreement(fit, row)
        yield from (flag.of(*agreement.stands_out) for flag in agreement.flags())


def run_agreement(fit: CycleFit, row: int) -> Redundancy:
    """Return how the runs agree in one load: force (0), moment (1), surge force (2)."""
    from scipy.stats import chi2, f, norm

    problem = fit.problem
    columns = [k for k, term in enumerate(fit.terms) if term.row == row]
    design, loads = problem.nominal
    matrix = problem.weighted(design[..., columns], row)
    target = problem.weighted(loads[..., row, None], row)[..., 0]
    runs, each = len(problem.numbers.cycles), int(problem.real.sum())
    owner = np.repeat(np.arange(runs), len(target) // runs)
    freedom = int(fit.data[row]) - len(columns)
    chi_square = float(fit.chi_square[row])
    without = np.full((runs, len(columns)), np.nan)
    chance, departure = np.ones(runs), np.zeros(runs)
    for k in range(runs if freedom > each else 0):
        rest = owner != k
        solved = _solve(matrix[rest], target[rest])
        if solved is None:
            continue
        without[k] = solved
        remaining = float(((target[rest] - matrix[rest] @ solved) ** 2).sum())
        fall, spare = max(chi_square - remaining, 0.0), freedom - each
        by_others = f.sf(fall / each / max(remaining / spare, 1e-300), each, spare)
        chance[k] = max(float(by_others), float(chi2.sf(fall, each)))
        departure[k] = min(float(norm.isf(chance[k] / 2.0)), math.sqrt(fall))
    names = tuple(fit.names[k] for k in columns)
    data = tuple(cycle.name for cycle in problem.numbers.cycles)
    subject = f"{LOAD_WORDS[row]} of {len(data)} runs"
    values = fit.values[columns]
    return Redundancy(
        subject, names, data, values, without, departure, chance, chi_square, freedom, math.nan
    )


def _solve(matrix: FloatArray, target: FloatArray) -> FloatArray | None:
    """Return the coefficients, or ``None`` where these runs do not determine them."""
    size = np.linalg.norm(matrix, axis=0)
    if not (size > 0.0).all() or np.linalg.cond(matrix / size) > _DETERMINED:
        return None
    return np.asarray(np.linalg.lstsq(matrix / size, target, rcond=None)[0] / size)
