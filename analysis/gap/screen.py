"""Which effects are worth a costly look: those whose traces show in the recordings at all.

What does not repeat with the shaft has to be simulated in time, and a drive that feels its load to
be solved together with it. Both take some hundred times as long as the rest. Each leaves traces of
a kind of its own; where nothing of that kind is beyond u, it is not there to be found.
"""

from collections.abc import Iterable, Mapping, Set
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import STEADY_PARTS, Component, Part
from analysis.gap.fit import Problem
from analysis.gap.observe import STRUTS
from analysis.gap.where import left_by_step
from hardware.description.channels import SHAFT_ANGLE
from sim.effects.effect import Effect

BEYOND: Final = 3.0  # standard deviations of a kind's chi-square
_LONE: Final = 4.0  # sigma of a single component
_BESIDE: Final = frozenset({Part.BETWEEN, Part.LINE, Part.CYCLE_SCATTER})
_SLOW: Final = _BESIDE | {Part.TREND}  # a wave of few periods is a trend, too
_TRACES: Final[Mapping[str, frozenset[Part]]] = {
    "trigger-jitter": frozenset({Part.PERIOD_SCATTER, Part.CYCLE_SCATTER}),
    "missed-pulse": frozenset({Part.PULSES}),
    "hum": _BESIDE,
    "carriage-fluctuation": _SLOW,
    "residual-waves": _SLOW,
    "zero-drift": frozenset({Part.TREND, Part.MEAN}),
    "campaign-drift": frozenset({Part.TREND, Part.MEAN}),
    "free-play": frozenset(STEADY_PARTS),
}
# What they do, the shaft and the struts do, and more of it than the forces show. Impacts between
# teeth the shaft does before all else; they are the dearest to simulate.
_OF_THE_DRIVE: Final = frozenset({"speed-droop", "load-ripple"})
_OF_THE_SHAFT: Final = frozenset({"gear-backlash"})
_MOTION: Final = frozenset({SHAFT_ANGLE.name, *STRUTS})


@dataclass(frozen=True)
class Shown:
    """What of the recordings deviates by more than noise.

    Attributes
    ----------
    parts
        Of which some component does.
    moves
        Whether shaft or struts do, or the frequency; forces speak for them where nothing else is
        recorded.
    turns
        Whether the shaft does, or the frequency; where the shaft is not recorded, as ``moves``.
    """

    parts: frozenset[Part]
    moves: bool
    turns: bool


def shown(problem: Problem) -> Shown:
    """Return what deviates over all runs, the motion judged without what comes after it."""
    stack = problem.simulator.stack
    left = left_by_step(problem, problem.residual)
    kinds: dict[Component, list[int]] = {}
    for at, one in enumerate(stack.components):
        kinds.setdefault(one, []).append(at)
    seen = [one for one, rows in kinds.items() if _deviates(left, rows)]
    recorded = {one.channel for one in kinds}
    steady = [one.channel for one in seen if one.part in STEADY_PARTS]
    moves = _show(steady, _MOTION & recorded)
    turns = _show(steady, {SHAFT_ANGLE.name} & recorded or _MOTION & recorded)
    return Shown(frozenset(one.part for one in seen), moves, turns)


def _show(deviating: Iterable[str], channels: Set[str]) -> bool:
    """Tell whether any of these channels deviates, or the frequency; any at all where none is."""
    return any(one in channels or not (one and channels) for one in deviating)


def _deviates(left: NDArray[np.float64], rows: list[int]) -> bool:
    own = left[rows]
    limit = len(rows) + BEYOND * (2.0 * len(rows)) ** 0.5
    return bool(own @ own > limit or np.abs(own).max() > _LONE)


def worth_a_look(kind: type[Effect], seen: Shown) -> bool:
    """Tell whether an effect can be among what deviates; always so if a look at it is cheap."""
    if kind.name in _OF_THE_SHAFT:
        return seen.turns
    if kind.name in _OF_THE_DRIVE:
        return seen.moves
    if kind.name in _TRACES:
        return bool(_TRACES[kind.name] & seen.parts)
    return kind.repeats or bool(seen.parts)
