"""What hum of the mains within its tolerance makes of the lines that it reaches."""

import math
from collections.abc import Iterator
from itertools import product
from typing import Final

import numpy as np

from analysis.gap.observe.bands import MAINS_HZ, OF_MAINS, expected_highest, folded_hz
from analysis.gap.observe.components import Component, GapRun, Part, Stack
from analysis.gap.observe.observation import BANDS
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES

_REACHED: Final = 3.0 * len(OF_MAINS)  # lines
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
        column, line = np.zeros(len(stack.components)), Component(channel, Part.MAINS, mains_hz)
        for at, component in enumerate(stack.components):
            if component == line:
                run = int(stack.run[at])
                number = _band(stack.runs[run], mains_hz)
                middle = loud.get((run, channel, number), math.inf)
                rise = (1.0 + power / math.exp(middle)) / expected_highest(_REACHED)
                column[at] = math.log(max(rise, 1.0)) / _FAR
        yield f"hum {channel.removeprefix('force_')} {mains_hz} Hz", column / stack.uncertainty


def _band(run: GapRun, mains_hz: float) -> int:
    """Return the number of the band that the mains fold into; 0 for none."""
    order = folded_hz(mains_hz, run.sample_rate_hz) / run.set_point.frequency_hz
    return next((number for number, (low, high) in BANDS.items() if low < order < high), 0)
