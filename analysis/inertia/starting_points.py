"""Where the iteration starts: from the spectrum, and from a user's guess beside it."""

from collections.abc import Sequence

import numpy as np

from analysis.inertia.projection import ProjectionProblem, columns, iterate, project
from analysis.inertia.spectrum import spectrum
from hardware.description.arrays import FloatArray

Start = tuple[FloatArray, FloatArray]

# Split of two modes that the spectrum shows as one, in cycles per record.
_SPLITS = (0.35, 0.8)
_MOST_SAMPLES = 2048  # starting values need no more


def starting_points(
    problem: ProjectionProblem, modes: int, guess_s: Sequence[float] | None = None
) -> list[Start]:
    """Return pairs of angular frequencies and decay rates, each of shape ``(modes,)``.

    The strongest line comes first; each further mode is the strongest line of what the fit so far
    leaves over, or, where the spectrum cannot tell two apart, a split of the first.
    """
    decay = np.full(modes, 0.5 / problem.span_s if problem.damped else 0.0)
    frequencies = _peeled(problem, modes)
    points = [(frequencies, decay)]
    if modes == 2:
        for split in _SPLITS:
            shift = 2.0 * np.pi * split / problem.span_s
            points.append((np.array([frequencies[0] - shift, frequencies[0] + shift]), decay))
    if guess_s is not None:
        points.append((2.0 * np.pi / np.asarray(guess_s, dtype=np.float64), decay))
    return [(np.maximum(omega, np.pi / problem.span_s), rates) for omega, rates in points]


def _peeled(problem: ProjectionProblem, modes: int) -> FloatArray:
    """Find one line after another in what the fit so far leaves over."""
    frequencies: list[float] = []
    residual = problem.values - problem.values.mean()
    for count in range(1, modes + 1):
        frequencies.append(2.0 * np.pi * _strongest_hz(problem.time_s, residual))
        if count == modes:
            break
        start = np.array(frequencies)
        rates = np.full(count, 0.5 / problem.span_s if problem.damped else 0.0)
        solution = iterate(problem, start, rates, 15)
        frequencies = list(solution.omega_rad_s)
        matrix = columns(problem, solution.omega_rad_s, solution.decay_1_s)
        residual = project(problem, matrix)[1]
    return np.array(frequencies)


def _strongest_hz(time_s: FloatArray, values: FloatArray) -> float:
    """Return the strongest line; uneven times are put on an even grid first."""
    step = float(np.median(np.diff(time_s)))
    grid = np.arange(time_s[0], time_s[-1] + 0.5 * step, step)
    even = np.interp(grid, time_s, values)
    slowest = 0.5 / (time_s[-1] - time_s[0])
    return spectrum(even, 1.0 / step, tapered=False).peak_hz(slowest)


def thinned(problem: ProjectionProblem) -> ProjectionProblem:
    """Average neighbouring samples, as far as the strongest line allows."""
    most = problem.time_s.size // _MOST_SAMPLES
    if most < 2:
        return problem
    step = float(np.median(np.diff(problem.time_s)))
    fastest = 16.0 * _strongest_hz(problem.time_s, problem.values - problem.values.mean())
    block = min(most, int(1.0 / (fastest * step)))
    if block < 2:
        return problem
    whole_blocks = problem.time_s.size // block * block

    def mean(rows: FloatArray) -> FloatArray:
        return np.asarray(
            rows[:whole_blocks].reshape(whole_blocks // block, block, *rows.shape[1:]).mean(axis=1)
        )

    return ProjectionProblem(
        mean(problem.time_s), mean(problem.values), mean(problem.base), problem.damped
    )
