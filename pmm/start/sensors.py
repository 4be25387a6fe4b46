"""What recordings tell of their sensors: the step of their numbers, and the noise at rest."""

from collections.abc import Iterable
from typing import Final

import numpy as np

from analysis.recording import Recording
from hardware.description.arrays import FloatArray

_FEWEST_LEVELS: Final = 4  # fewer tell nothing of a step
_SAME: Final = 1e-9  # of what the signal covers: values nearer to each other are one
_TRIED: Final = (0.1, 0.01, 0.0)  # quantiles of the gaps between levels that may be one step
_NEAR: Final = 0.2  # steps beside a whole number of them
_MOSTLY: Final = 0.95  # of the gaps so near: samples that were filled in lie between the steps


def step_of(values: FloatArray) -> float | None:
    """Return the step of numbers that lie on a grid, of a converter or of a file's digits.

    It is ``None`` where they lie on none, as those of full precision do, or are too few to tell.
    """
    levels = np.unique(values[np.isfinite(values)])
    if levels.size < _FEWEST_LEVELS:
        return None
    apart = np.diff(levels)
    apart = apart[apart > _SAME * (levels[-1] - levels[0])]
    if apart.size < _FEWEST_LEVELS - 1:
        return None
    steps = (_grid(apart, float(np.quantile(apart, at))) for at in _TRIED)
    return next((step for step in steps if step is not None), None)


def _grid(apart: FloatArray, about: float) -> float | None:
    """Return a step near to ``about`` that the gaps between levels are multiples of."""
    step = float(np.median(apart[(apart > 0.5 * about) & (apart < 1.5 * about)]))
    counts = np.rint(apart / step)
    near = np.abs(apart / step - counts) < _NEAR
    if np.mean(near & (counts > 0.0)) < _MOSTLY:
        return None
    return float(apart[near].sum() / counts[near].sum())


def smallest_step(steps: Iterable[float | None]) -> float | None:
    """Return the step that all recordings keep; ``None`` where one keeps none."""
    all_steps = list(steps)
    known_steps = [step for step in all_steps if step is not None]
    return min(known_steps) if known_steps and len(known_steps) == len(all_steps) else None


def noise_at_rest(recording: Recording, name: str) -> float:
    """Return the standard deviation of a channel's white noise while nothing moves.

    By the differences of neighbours, which what is slow leaves out.
    """
    values = recording.values(name)
    apart = np.diff(values)
    apart = apart[np.isfinite(apart)]
    return float(np.sqrt(np.mean(apart**2) / 2.0)) if apart.size else 0.0
