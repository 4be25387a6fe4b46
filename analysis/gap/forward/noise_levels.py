"""How loud each channel is, as columns: a rig that is noisier than believed has no gap for that."""

from collections.abc import Iterator
from typing import Final

import numpy as np

from analysis.gap.observe.components import Part, Stack
from analysis.gap.observe.spectrum import spread_about
from hardware.description.arrays import FloatArray

# One standard deviation of the logarithm of what no specification tells.
_LOUDNESS: Final = {
    Part.BETWEEN: 2.0,
    Part.LINE: 0.3,
    Part.CYCLE_SCATTER: 1.0,
    Part.PERIOD_SCATTER: 0.05,
}


# And of its change over e times the frequency: noise is louder where it is slow.
_COLOUR: Final = {Part.BETWEEN: 1.0, Part.CYCLE_SCATTER: 0.5}


# What a run's own level, a logarithm of power, adds to it.
_PER_LEVEL: Final = {Part.BETWEEN: 1.0, Part.CYCLE_SCATTER: 0.5}


def noise_levels(stack: Stack) -> Iterator[FloatArray]:
    """Yield columns for each kind of noise of each channel: the same in all runs, and its colour.

    What is compared lies at multiples of the shaft's frequency, and so moves with it. Where runs
    are not equally loud between the harmonics, each has a level of its own besides.
    """
    spreads = _spreads(stack)
    frequency = np.log([run.set_point.frequency_hz for run in stack.runs])[stack.run]
    for kind in dict.fromkeys(
        component for component in stack.components if component.part in _LOUDNESS
    ):
        column = np.array([component == kind for component in stack.components]) / stack.uncertainty
        yield _LOUDNESS[kind.part] * column
        if kind.part in _COLOUR:
            yield _COLOUR[kind.part] * column * (frequency - frequency.mean())
            # The cycles scatter as loud as it is among the harmonics: in the first band.
            band = kind.order if kind.part is Part.BETWEEN else 1
            spread = spreads.get((kind.channel, band), 0.0)
            yield from by_run(stack, _PER_LEVEL[kind.part] * spread * column) if spread else ()


def _spreads(stack: Stack) -> dict[tuple[str, int], float]:
    """Return by channel and band how much the runs' noise differs, as a logarithm of its power."""
    frequency = np.log([run.set_point.frequency_hz for run in stack.runs])[stack.run]
    spreads = {}
    for kind in dict.fromkeys(
        component for component in stack.components if component.part is Part.BETWEEN
    ):
        rows = [at for at, component in enumerate(stack.components) if component == kind]
        line = np.column_stack((np.ones(len(rows)), frequency[rows] - frequency.mean()))
        weight = 1.0 / stack.uncertainty[rows] ** 2
        spreads[kind.channel, kind.order] = spread_about(line, stack.values[rows], weight)
    return spreads


def by_run(stack: Stack, change: FloatArray) -> Iterator[FloatArray]:
    """Yield a change that is each run's own, a column for each run."""
    for number in range(len(stack.runs)):
        yield np.where(stack.run == number, change, 0.0)
