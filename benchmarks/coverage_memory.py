"""Coverage of 95 % intervals where the noise remembers, and what that costs where it does not."""

from collections.abc import Callable, Iterator

import numpy as np

from analysis.resolver.harmonics import Harmonics
from benchmarks.noises import BEATS, MEMORIES, Noise
from benchmarks.outcome import Report, Row

GATES = (5, 10, 20, 40)
_JUDGED = (10, 20, 40)
_HAVE_A_MEAN = ("ar1 0.9", "ar1 0.99", "ar1 0.995", "flicker")
_NEAREST = ("1.05 w", "1.02 w, decays in 5", "1.02 w, decays in 15")

Readings = Callable[[Noise, int, int], Iterator[Harmonics]]
"""Readings of a noise alone, of so many periods, in so many trials."""


def rows(readings: Readings, trials: int, report: Report) -> list[Row]:
    """Draw trials of every noise with memory and every gate."""
    found: list[Row] = []
    for name, noise in (MEMORIES | BEATS).items():
        for periods in GATES:
            report(f"{name}, m = {periods}")
            found.append({"noise": name, "m": periods, **_row(readings(noise, periods, trials))})
    return found


def _row(readings: Iterator[Harmonics]) -> Row:
    """Return shares and widths of the intervals with the periods' memory and without."""
    held, alone, wider = [], [], []
    for found in readings:
        half, error = found.half_width(), np.abs(found.coefficients)
        held.append(error <= half)
        alone.append(error <= half / found.widening)
        wider.append(found.widening)
    inside, before = (np.concatenate(part).mean(axis=0) for part in (held, alone))
    widening = np.concatenate(wider)
    return {
        "mean, scatter alone": float(before[0]),
        "mean": float(inside[0]),
        "median widening": float(np.median(widening[:, 0])),
        "n = 1, scatter alone": float(before[1:3].mean()),
        "n = 1": float(inside[1:3].mean()),
        "median widening, n = 1": float(np.median(widening[:, 1:3])),
        "worst n": float(min(inside[k : k + 2].mean() for k in range(1, len(inside), 2))),
    }


def judged(found: list[Row]) -> dict[str, float]:
    """Pick what the thresholds judge."""

    def of(names: tuple[str, ...], column: str) -> list[float]:
        chosen = [row for row in found if row["m"] in _JUDGED and row["noise"] in names]
        return [float(row[column]) for row in chosen]

    white = ("white",)
    return {
        "memory": min(of(_HAVE_A_MEAN, "mean")),
        "beat": min(of(_NEAREST, "n = 1")),
        "white_not_too_often": max(of(white, "mean") + of(white, "n = 1")),
        "white_width_mean": max(of(white, "median widening")),
        "white_width": max(of(white, "median widening, n = 1")),
    }


def notes(trials: int) -> tuple[str, ...]:
    """Say what the table holds."""
    return (
        f"Under long memory and beats: {trials} trials of every row; waves have an amplitude of 1 "
        "in white noise of 0.2, a random walk has no mean to hold (its start counts as one). "
        "Every interval is given. 'Scatter alone' is the interval before the memory that the "
        "periods' sequence shows has widened it.",
    )
