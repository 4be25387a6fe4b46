"""A condition repeated through a campaign, as a chart of individuals that catches a step change.

The limits come from the moving range: it sees the scatter from repeat to repeat, and a step in it
only once (Shewhart; Montgomery, Introduction to Statistical Quality Control, individuals chart).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from pmm.evaluation.run_results import RunResult

_SIGMAS: Final = 3.0
_MEDIAN_RANGE: Final = 0.9538725524  # median range of two normal values, in standard deviations
# Of the largest of all places where a step may be: docs/run-control.md has the false alarms.
_STEP_SIGMAS: Final = 4.5
LEAST: Final = 4


@dataclass(frozen=True, eq=False)
class Chart:
    """One quantity over the repeats.

    Attributes
    ----------
    values
        In the order in which they were measured.
    centre, low, high
        Median of the values, and three standard deviations about it.
    outside
        Numbers of the values beyond the limits.
    step_at
        Before which value the mean changed, and by how much it did; ``None`` where no step stands
        out of the scatter.
    """

    quantity: str
    unit: str
    runs: tuple[str, ...]
    values: FloatArray
    centre: float
    low: float
    high: float
    outside: tuple[int, ...]
    step_at: tuple[int, float] | None

    @property
    def in_control(self) -> bool:
        """Whether no point is outside the limits and no step is seen."""
        return not self.outside and self.step_at is None


def chart(quantity: str, unit: str, runs: Sequence[str], values: FloatArray) -> Chart:
    """Return the chart of a quantity.

    The limits lie about the median: a step in the middle of a campaign moves it least.

    Raises
    ------
    DataError
        For fewer than four values: there is no scatter to speak of.
    """
    if values.size < LEAST:
        raise DataError(
            f"{quantity}: {values.size} repeats of the control condition; a chart needs {LEAST}"
        )
    sigma = float(np.median(np.abs(np.diff(values)))) / _MEDIAN_RANGE
    centre = float(np.median(values))
    low, high = centre - _SIGMAS * sigma, centre + _SIGMAS * sigma
    outside = tuple(np.flatnonzero((values < low) | (values > high)).tolist())
    return Chart(
        quantity, unit, tuple(runs), values, centre, low, high, outside, _step(values, sigma)
    )


def control_charts(runs: Sequence[RunResult]) -> tuple[Chart, ...]:
    """Return amplitude and phase of each force channel over the control runs."""
    names = [run.name for run in runs]
    charts = []
    for channel in runs[0].forces if runs else ():
        first = np.array([run.first[channel] for run in runs])
        phases = np.unwrap(np.angle(first))
        charts.append(chart(f"{channel} amplitude", "N", names, np.abs(first)))
        charts.append(chart(f"{channel} phase", "rad", names, phases))
    return tuple(charts)


def _step(values: FloatArray, sigma: float) -> tuple[int, float] | None:
    """Return where the means before and after differ most, if by more than their scatter tells."""
    if not sigma > 0.0:
        return None
    best: tuple[float, int, float] = (0.0, 0, 0.0)
    for k in range(1, values.size):
        change = float(values[k:].mean() - values[:k].mean())
        times = abs(change) / (sigma * np.sqrt(1.0 / k + 1.0 / (values.size - k)))
        best = max(best, (times, k, change))
    return (best[1], best[2]) if best[0] > _STEP_SIGMAS else None
