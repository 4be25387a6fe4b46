"""Amplitude and phase, swing by swing: measured, simulated, and simulated with the causes.

Both simulations have the release and the tolerances that fit best, as in the diagnosis.
"""

from pathlib import Path

import numpy as np

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.swings import KINDS
from analysis.gap.pendulum.trial import Problem
from analysis.inertia.numeric import FloatArray

_LABELS = {"decay": "ln amplitude", "period": "phase to reference [rad]"}


def draw(found: Diagnosis, folder: Path) -> list[Path]:
    """Draw one figure a record as SVG; return where they are."""
    folder.mkdir(parents=True, exist_ok=True)
    return [_draw(found, at, folder) for at in range(len(found.problem.trials))]


def _draw(found: Diagnosis, at: int, folder: Path) -> Path:
    from matplotlib.figure import Figure

    problem = found.problem
    trial, nothing = problem.trials[at], np.zeros_like(problem.residual)
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    curves = [
        ("simulated", _told(problem, nothing)),
        ("with causes", _told(problem, found.best.signature)),
    ]
    for panel, (kind, label) in zip(axes, _LABELS.items(), strict=True):
        row = KINDS.index(kind)
        panel.plot(trial.windows.centres_s, trial.observed[row], "o", ms=3, label="measured")
        rows = (problem.trial == at) & (problem.kind == row)
        for name, values in curves:
            panel.plot(problem.centre_s[rows], values[rows], label=name)
        panel.set_ylabel(label)
    axes[0].legend()
    axes[0].set_title(trial.name)
    axes[1].set_xlabel("time after the start [s]")
    path = folder / f"gap-{at + 1}.svg"
    figure.savefig(path)
    return path


def _told(problem: Problem, signature: FloatArray) -> FloatArray:
    """Return the observations as causes have them, with the release and tolerances that fit."""
    nuisances = problem.nuisances
    free = nuisances.columns @ nuisances.fitted(problem.residual - signature)
    return problem.nominal + (signature + free) * problem.uncertainty
