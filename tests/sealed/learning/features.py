"""Features of a campaign that do not depend on how many runs it has: moments and regressions.

Of each cell (a channel's mean, trend, or part of a harmonic, say), over the runs that have it: the
mean and the rms of what is off, in sigma, and the slopes of a least-squares plane over set-points.
"""

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from hardware.description.arrays import FloatArray
from tests.sealed.learning.campaigns import Numbers
from tests.sealed.learning.seen import Seen

SETTINGS = ("frequency", "eccentricity", "phase", "speed", "water")
RIDGE = 1e-9
"""Of the plane's normal equations, relative: slopes that the runs do not tell are shared out."""


def of_components(numbers: Numbers) -> dict[str, float]:
    """Return the features of a remainder by name; numbers off are compressed by asinh."""
    seen = Seen.of(numbers)
    cells = np.array(seen.cell)
    found = {f"runs|{name}": value for name, value in _spread(seen.settings)}
    for cell in dict.fromkeys(seen.cell):
        rows = np.flatnonzero(cells == cell)
        for name, value in moments(seen.off[rows], seen.settings[seen.run[rows]]).items():
            found[f"{cell}|{name}"] = math.asinh(value)
    return found


def of_hypotheses(numbers: Numbers) -> dict[str, float]:
    """Return the features of our diagnosis' hypotheses; evidence and size are compressed."""
    return {name: value if name.endswith(("share", "overlap")) else math.asinh(value)
            for name, value in numbers.items()}  # fmt: skip


def moments(off: FloatArray, settings: FloatArray) -> dict[str, float]:
    """Return mean, rms, and the slope over each setting.

    Parameters
    ----------
    off
        Of each run that has the cell, shape ``(runs,)``.
    settings
        Of these runs, shape ``(runs, 5)``. One that does not vary among them has slope 0.
    """
    centred = settings - settings.mean(axis=0)
    normal = centred.T @ centred
    weight = RIDGE * max(float(np.trace(normal)), 1e-30)
    slopes = np.linalg.solve(normal + weight * np.eye(len(normal)), centred.T @ off)
    return {
        "mean": float(off.mean()),
        "rms": float(np.sqrt(np.mean(off**2))),
        **{name: float(slope) for name, slope in zip(SETTINGS, slopes, strict=True)},
    }


def _spread(settings: FloatArray) -> Iterator[tuple[str, float]]:
    for name, values in zip(SETTINGS, settings.T, strict=True):
        yield f"mean {name}", float(values.mean())
        yield f"spread {name}", float(values.std())


def as_matrix(rows: Sequence[Mapping[str, float]], names: Sequence[str]) -> FloatArray:
    """Return rows of features by name, NaN where one has none; shape ``(rows, names)``."""
    return np.array([[row.get(name, math.nan) for name in names] for row in rows], np.float64)
