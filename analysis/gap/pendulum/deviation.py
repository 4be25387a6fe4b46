"""What stands beside every hypothesis of a pendulum test: how large, and how alike.

A deviation changes with the amplitude, and is alike for records of one body in one set-up (under a
known force: of a like frequency) where their amplitudes are alike; a share of it is each record's
own. Light gates tell no amplitude:
what they see deviates throughout a record.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.inference.evidence import Background, Kind
from analysis.gap.inference.kernel import Kernel
from analysis.gap.inference.shapes import Shapes
from analysis.gap.pendulum.causes import DAMPED, LINES, READ, RESTORED
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.search.first_look import FirstLook, signatures
from hardware.description.arrays import BoolArray, FloatArray

_OWN: Final = 0.2  # share of a deviation's variance that is each record's own
_OCTAVE: Final = float(np.log(2.0))  # of amplitude, over which a deviation keeps its value
_FEWEST: Final = 3  # records, from which one of them may be odd
_WHENCE: Final[Mapping[str, tuple[str, ...]]] = {
    "decay": (DAMPED,),
    "period": (RESTORED, LINES),
    "mean": (READ,),
}
_DECAY, _PERIOD, _MEAN = (KINDS.index(kind) for kind in ("decay", "period", "mean"))


def background(problem: PendulumProblem, looked: Sequence[FirstLook]) -> Background:
    """Return what stands beside every hypothesis of a pendulum test.

    Parameters
    ----------
    looked
        First looks at the causes of the catalogue.
    """
    scale = units(problem) / problem.uncertainty
    columns = problem.nuisances.columns
    shown = signatures(looked)
    stages, everywhere = (
        tuple(dict.fromkeys(effect.stage for effect in shown)),
        np.ones_like(scale) > 0.0,
    )
    cells = [np.flatnonzero(problem.kind == kind) for kind in np.unique(problem.kind)]
    return Background(
        problem.residual,
        columns,
        np.zeros(columns.shape[1], dtype=bool),
        Kernel.of(cells, [_likeness(problem, rows) for rows in cells], scale),
        Shapes.of(shown, scale, problem.nuisances),
        _run_columns(problem, scale),
        dict.fromkeys(stages, everywhere),
        dict(_kinds(problem, stages)),
    )


def _kinds(problem: PendulumProblem, stages: tuple[str, ...]) -> Iterator[tuple[str, Kind]]:
    """Yield where something unknown may show: in one kind of observable, or in all."""
    for kind in np.unique(problem.kind):
        name = KINDS[kind]
        whence = tuple(stage for stage in _WHENCE.get(name, stages) if stage in stages)
        yield name, Kind(problem.kind == kind, whence or stages)
    yield "all", Kind(np.ones(len(problem.kind), dtype=bool), stages)


def units(problem: PendulumProblem) -> FloatArray:
    """Return how large a deviation of 1 is at each observation, in the observation's unit.

    Of the amplitude's logarithm what it is predicted to fall by over the record, an e-fold at
    least; of the phase all that was turned since the release, so that it is a share of the period,
    under a known force a radian; of the mean the predicted amplitude. A third harmonic is a share
    of the amplitude already; under a known force it is what a force of that order makes.
    """
    out = np.ones(len(problem.kind))
    for at, trial in enumerate(problem.trials):
        rows = problem.trial == at
        falls = problem.nominal[rows & (problem.kind == _DECAY)]
        turned = 1.0 if trial.driven else trial.windows.reference_rad_s * problem.centre_s
        out = np.where(rows & (problem.kind == _PERIOD), turned, out)
        out = np.where(rows & (problem.kind > _MEAN), trial.third_harmonic, out)
        if len(falls):
            out[rows & (problem.kind == _DECAY)] = max(float(np.ptp(falls)), 1.0)
            out[rows & (problem.kind == _MEAN)] = float(np.exp(falls.max()))
    return np.asarray(out, np.float64)


def _likeness(problem: PendulumProblem, rows: NDArray[np.intp]) -> FloatArray:
    """Return how alike a deviation is in some windows, shape ``(rows, rows)``."""
    record, size = problem.trial[rows], _log_size(problem)[rows]
    alike = np.array(
        [[trial.alike(partner) for partner in problem.trials] for trial in problem.trials]
    )
    shared = alike[np.ix_(record, record)] * np.exp(-0.5 * ((size[:, None] - size) / _OCTAVE) ** 2)
    is_same = record[:, None] == record
    return np.asarray((1.0 - _OWN) * shared + _OWN * is_same, np.float64)


def _log_size(problem: PendulumProblem) -> FloatArray:
    """Return the logarithm of each window's amplitude, its noise taken off by a parabola in time.

    Noise that stood here and in what is observed would be taken for a deviation.
    """
    log_sizes = np.zeros(len(problem.kind))
    for at, trial in enumerate(problem.trials):
        is_finite = np.isfinite(trial.observed[_DECAY])
        if not trial.scaled:
            time_s, rows = trial.windows.centres_s, problem.trial == at
            fell = np.polynomial.Polynomial.fit(
                time_s[is_finite], trial.observed[_DECAY, is_finite], 2
            )
            log_sizes[rows] = fell(problem.centre_s[rows])
    return log_sizes


def _run_columns(problem: PendulumProblem, scale: FloatArray) -> dict[str, FloatArray]:
    """Return by run what a gain, a period and a zero of its own change; none of very few.

    Each sensor of a run has its own, since a run that went wrong did so for all of them.
    """
    runs: dict[str, list[int]] = {}
    for at, trial in enumerate(problem.trials):
        runs.setdefault(trial.run or trial.name, []).append(at)
    if len(runs) < _FEWEST:
        return {}
    parts: list[BoolArray] = [problem.kind == kind for kind in (_DECAY, _PERIOD, _MEAN)]
    return {
        run: np.column_stack(
            [
                np.where(part & (problem.trial == at), scale, 0.0)
                for at in numbers
                for part in parts
                if part.any()
            ]
        )
        for run, numbers in runs.items()
    }
