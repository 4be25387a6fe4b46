"""Amplitude and phase, swing by swing: measured, simulated, and simulated with the causes."""

from pathlib import Path

import numpy as np

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.swings import KINDS

_LABELS = {"decay": "ln amplitude", "period": "phase to reference [rad]"}


def draw(found: Diagnosis, folder: Path) -> list[Path]:
    """Draw one figure a record as SVG; return where they are."""
    folder.mkdir(parents=True, exist_ok=True)
    return [_draw(found, at, folder) for at in range(len(found.problem.trials))]


def _draw(found: Diagnosis, at: int, folder: Path) -> Path:
    from matplotlib.figure import Figure

    trial = found.problem.trials[at]
    figure = Figure(figsize=(7.0, 5.0), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    curves = [("simulated", trial.simulate()), ("with causes", _cured(found, at))]
    for panel, (kind, label) in zip(axes, _LABELS.items(), strict=True):
        row = KINDS.index(kind)
        panel.plot(trial.windows.centres_s, trial.observed[row], "o", ms=3, label="measured")
        for name, values in curves:
            panel.plot(trial.windows.centres_s, values[row], label=name)
        panel.set_ylabel(label)
    axes[0].legend()
    axes[0].set_title(trial.name)
    axes[1].set_xlabel("time after the start [s]")
    path = folder / f"gap-{at + 1}.svg"
    figure.savefig(path)
    return path


def _cured(found: Diagnosis, at: int) -> np.ndarray:
    trial = found.problem.trials[at]
    return trial.simulate(found.best.effects(trial))
