"""Figures of a pendulum's gap: swings, heat map, ranking, before and after."""

import math
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.gap.pendulum.diagnose import PendulumDiagnosis
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.remainder import as_stated, remainder
from analysis.gap.pendulum.search import cause_names
from analysis.gap.pendulum.swings import KINDS
from hardware.description.arrays import FloatArray
from pmm.document.labels import plain
from pmm.document.style import PALETTE, TRACE, new_figure
from pmm.gap.heat import AFTER, BEFORE, Dots, Grid, before_and_after, dotted, probability_bars
from pmm.gap.pendulum_conclusion import ranking

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LABELS: Final = {"decay": "ln amplitude", "period": "phase to reference (rad)"}
_EACH: Final = 5  # windows from one number on the map to the next


def heat_map(diagnosis: PendulumDiagnosis) -> "Figure":
    """Draw E/u of each kind of observable and record over its windows, as stated and after."""
    problem = diagnosis.problem
    pairs = sorted(set(zip(problem.trial.tolist(), problem.kind.tolist(), strict=True)))
    names = [f"{problem.trials[trial].name}: {problem.names[kind]}" for trial, kind in pairs]
    count = max(trial.windows.count for trial in problem.trials)
    columns = [str(at + 1) if at % _EACH == 0 else "" for at in range(count)]
    breaks = [at for at in range(1, len(pairs)) if pairs[at][0] != pairs[at - 1][0]]
    maps = [
        _map(problem, pairs, residual)
        for residual in (as_stated(problem), _remainder_after(diagnosis))
    ]
    titles = ("as stated", "with the best answer")
    grid = Grid(names, columns, breaks, titles, "window of the record")
    return before_and_after(grid, maps, "E/u")


def _remainder_after(diagnosis: PendulumDiagnosis) -> FloatArray:
    return remainder(diagnosis.settled.problem, diagnosis.settled.best)


def _map(
    problem: PendulumProblem, pairs: list[tuple[int, int]], residual: FloatArray
) -> FloatArray:
    """Return sizes by trial and kind over the windows; NaN where a record has none."""
    count = max(trial.windows.count for trial in problem.trials)
    values = np.full((len(pairs), count), np.nan)
    for row, (trial, kind) in enumerate(pairs):
        rows = (problem.trial == trial) & (problem.kind == kind)
        windows = problem.centre_s[rows] / problem.trials[trial].windows.length_s
        values[row, windows.astype(int)] = np.abs(residual[rows])
    return values


def ranking_figure(diagnosis: PendulumDiagnosis) -> "Figure":
    """Draw the answers' probabilities, the best one in its colour."""
    shown = dict(ranking(diagnosis.weighed.answers))
    return probability_bars(shown, list(shown)[:1], "probability; in blue the most probable")


def withheld_figure(diagnosis: PendulumDiagnosis) -> "Figure":
    """Draw the gap of each withheld regime without a cause, with the best set and the control."""
    rows = [regime.name for regime in diagnosis.regimes]
    best, control = cause_names(diagnosis.best), diagnosis.control
    series = [
        Dots(
            "without a cause",
            "o",
            BEFORE,
            [_clear(regime.before.gap) for regime in diagnosis.regimes],
        ),
        Dots("best answer", "s", AFTER, _gaps(diagnosis, best)),
    ]
    if control:
        series.append(
            Dots(f"wrong cause: {control[0]}", "^", PALETTE[3], _gaps(diagnosis, control))
        )
    return dotted(rows, series)


def _gaps(diagnosis: PendulumDiagnosis, names: tuple[str, ...]) -> list[float]:
    gaps = []
    for regime in diagnosis.regimes:
        regime_gaps = [
            _clear(foretold.gap) for foretold in regime.foretold if foretold.causes == names
        ]
        gaps.append(regime_gaps[0] if regime_gaps else math.nan)
    return gaps


def _clear(gap: float) -> float:
    """Return a gap in u without the noise's own 1."""
    return math.sqrt(max(gap**2 - 1.0, 0.0))


def swings_figure(diagnosis: PendulumDiagnosis, at: int) -> "Figure":
    """Draw one record's amplitude and phase over time: measured, simulated, and with the causes.

    Both simulations have the release and the tolerances that fit best, as in the diagnosis.
    """
    problem, after = diagnosis.problem, diagnosis.settled
    trial, nothing = problem.trials[at], np.zeros_like(problem.residual)
    curves = {
        "simulated": (_fitted_observations(problem, nothing), BEFORE),
        "with causes": (_fitted_observations(after.problem, after.best.signature), AFTER),
    }
    with new_figure(10.5, 5.0) as figure:
        axes = figure.subplots(2, 1, sharex=True)
        for panel, (kind, label) in zip(axes, _LABELS.items(), strict=True):
            row = KINDS.index(kind)
            points = trial.windows.centres_s, trial.observed[row]
            panel.plot(*points, "o", color=TRACE, markersize=3, label="measured")
            rows = (problem.trial == at) & (problem.kind == row)
            for name, (values, colour) in curves.items() if rows.any() else ():
                panel.plot(problem.centre_s[rows], values[rows], color=colour, label=name)
            panel.set_ylabel(label)
        axes[1].legend()
        axes[0].set_title(plain(trial.name), loc="left")
        axes[1].set_xlabel("time after the start (s)")
    return figure


def _fitted_observations(problem: PendulumProblem, signature: FloatArray) -> FloatArray:
    """Return the observations as causes have them, with the release and tolerances that fit."""
    nuisances = problem.nuisances
    free = nuisances.columns @ nuisances.fitted(problem.residual - signature)
    return problem.nominal + (signature + free) * problem.uncertainty
