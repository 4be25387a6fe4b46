"""What hum of the mains within its tolerance makes of the strongest line beside the harmonics."""

import math
from collections.abc import Iterator
from itertools import product
from typing import Final

import numpy as np

from analysis.gap.observe.bands import expected_highest, free_of_harmonics
from analysis.gap.observe.components import GapRun, Part, Stack
from analysis.gap.observe.observation import BANDS
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES

MAINS_HZ: Final = (50.0, 60.0)
_NEAR: Final = 1.0 / 3.0  # a line nearer to a harmonic than half a bin goes with its leakage
_FAR: Final = 2.0  # tolerances: a line grows with the logarithm of its size, so this is halved


def hum_columns(stack: Stack, hum_n: float) -> Iterator[tuple[str, FloatArray]]:
    """Yield names, and what a tolerance of hum changes in each force, in sigma.

    A line of amplitude a under a Hann taper has the power ``a^2/3`` where noise has what the band
    shows between its lines.
    """
    loud = {
        (run, component.channel, component.order): value
        for run, component, value in zip(
            stack.run.tolist(), stack.components, stack.values.tolist(), strict=True
        )
        if component.part is Part.BETWEEN
    }
    power = (_FAR * hum_n) ** 2 / 3.0
    for channel, mains_hz in product(FORCES, MAINS_HZ):
        column = np.zeros(len(stack.components))
        for at, component in enumerate(stack.components):
            run = int(stack.run[at])
            if component.part is Part.LINE and component.channel == channel:
                count = _lines(stack.runs[run], component.order, mains_hz)
                middle = loud.get((run, channel, component.order), math.inf)
                if count:
                    rise = (1.0 + power / math.exp(middle)) / expected_highest(count)
                    column[at] = math.log(max(rise, 1.0)) / _FAR
        yield f"hum {channel.removeprefix('force_')} {mains_hz:g} Hz", column / stack.uncertainty


def _lines(run: GapRun, number: int, mains_hz: float) -> float:
    """Return how many lines a band has that the mains fold into, beside harmonics; else 0."""
    low, high = (edge * run.set_point.frequency_hz for edge in BANDS[number])
    rate_hz, duration_s = run.sample_rate_hz, run.periods / run.set_point.frequency_hz
    folded = np.array([abs(mains_hz - rate_hz * round(mains_hz / rate_hz))])
    beside = free_of_harmonics(folded, run.set_point.frequency_hz, _NEAR / duration_s)
    is_inside = bool(beside[0]) and low < folded[0] < high
    return (min(high, 0.5 * rate_hz) - low) * duration_s if is_inside else 0.0
