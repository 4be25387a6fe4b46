"""Which effects are worth a costly look: those whose traces show in the recordings at all.

What does not repeat with the shaft has to be simulated in time, and a drive that feels its load to
be solved together with it. Both take some hundred times as long as the rest. Each leaves traces of
a kind of its own; where nothing of that kind is beyond u, it is not there to be found.
"""

from collections.abc import Iterable, Mapping, Set
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.forward.problem import Problem
from analysis.gap.locate.walk import left_by_step
from analysis.gap.observe.components import STEADY_PARTS, TRENDS, Part
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENTS, SHAFT_ANGLE
from sim.effects.effect import DeviationTrace, Effect

BEYOND: Final = 3.0  # standard deviations of a kind's chi-square
_LONE: Final = 4.0  # sigma of a single component
_PARTS: Final[Mapping[DeviationTrace, frozenset[Part]]] = {
    DeviationTrace.STEADY: frozenset(STEADY_PARTS),
    DeviationTrace.MEAN: frozenset({Part.MEAN}),
    DeviationTrace.TREND: frozenset(TRENDS),
    DeviationTrace.PULSES: frozenset({Part.PULSES}),
    DeviationTrace.PERIODS: frozenset({Part.PERIOD_SCATTER}),
    DeviationTrace.CYCLES: frozenset({Part.CYCLE_SCATTER}),
    DeviationTrace.BESIDE: frozenset({Part.BETWEEN, Part.LINE, Part.MAINS}),
}
# What a drive does, these do, and more of it than the forces show.
_CHANNELS: Final[Mapping[DeviationTrace, frozenset[str]]] = {
    DeviationTrace.MOTION: frozenset({SHAFT_ANGLE.name, *DISPLACEMENTS}),
    DeviationTrace.SHAFT: frozenset({SHAFT_ANGLE.name}),
}


def deviating_traces(problem: Problem) -> frozenset[DeviationTrace]:
    """Return what deviates over all runs, the motion judged without what comes after it.

    Where the shaft is not recorded, the struts speak for it, and forces where nothing else is.
    """
    stack = problem.simulator.stack
    # An effect may show in what every rig has a little of.
    bare = replace(problem, nuisances=problem.nuisances.without_always_on)
    remainder = left_by_step(bare, problem.residual)
    kinds = stack.rows_by_component
    deviating = [component for component, rows in kinds.items() if _deviates(remainder, rows)]
    traces = {
        trace
        for trace, parts in _PARTS.items()
        if any(component.part in parts for component in deviating)
    }
    steady = [component.channel for component in deviating if component.part in STEADY_PARTS]
    motion = _CHANNELS[DeviationTrace.MOTION] & {component.channel for component in kinds}
    for trace, channels in _CHANNELS.items():
        if _show(steady, channels & motion or motion):
            traces.add(trace)
    return frozenset(traces)


def _show(deviating: Iterable[str], channels: Set[str]) -> bool:
    """Tell whether any of these channels deviates, or the frequency; any at all where none is."""
    return any(channel in channels or not (channel and channels) for channel in deviating)


def _deviates(remainder: FloatArray, rows: NDArray[np.intp]) -> bool:
    values = remainder[rows]
    limit = len(rows) + BEYOND * (2.0 * len(rows)) ** 0.5
    return bool(values @ values > limit or np.abs(values).max() > _LONE)


def worth_a_look(kind: type[Effect], traces: Set[DeviationTrace]) -> bool:
    """Tell whether an effect can be among what deviates; always so if a look at it is cheap."""
    if kind.shows_in:
        return not traces.isdisjoint(kind.shows_in)
    return kind.repeats or bool(traces)
