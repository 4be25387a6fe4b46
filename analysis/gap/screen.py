"""Which effects are worth a costly look: those whose traces show in the recordings at all.

What does not repeat with the shaft has to be simulated in time, and a drive that feels its load to
be solved together with it. Both take some hundred times as long as the rest. Each leaves traces of
a kind of its own; where nothing of that kind is beyond u, it is not there to be found.
"""

from collections.abc import Mapping
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import STEADY_PARTS, Part
from analysis.gap.fit import Problem
from sim.effects.effect import Effect

BEYOND: Final = 3.0  # standard deviations of a kind's chi-square
_LONE: Final = 4.0  # sigma of a single component
_BESIDE: Final = frozenset({Part.BETWEEN, Part.LINE, Part.CYCLE_SCATTER})
_TRACES: Final[Mapping[str, frozenset[Part]]] = {
    "trigger-jitter": frozenset({Part.PERIOD_SCATTER, Part.CYCLE_SCATTER}),
    "missed-pulse": frozenset({Part.PULSES, Part.PERIOD_SCATTER}),
    "hum": _BESIDE,
    "carriage-fluctuation": _BESIDE,
    "residual-waves": _BESIDE,
    "zero-drift": frozenset({Part.TREND, Part.MEAN}),
    "campaign-drift": frozenset({Part.TREND, Part.MEAN}),
    **dict.fromkeys(
        ("torque-cogging", "speed-droop", "load-ripple", "gear-backlash", "free-play"),
        frozenset(STEADY_PARTS),
    ),
}


def shown(problem: Problem) -> frozenset[Part]:
    """Return the parts of which some component deviates, over all runs, by more than noise."""
    stack = problem.simulator.stack
    left = problem.nuisances.whiten(problem.residual[:, None])[:, 0]
    kinds: dict[object, list[int]] = {}
    for at, one in enumerate(stack.components):
        kinds.setdefault(one, []).append(at)
    return frozenset(
        stack.components[rows[0]].part for rows in kinds.values() if _deviates(left, rows)
    )


def _deviates(left: NDArray[np.float64], rows: list[int]) -> bool:
    own = left[rows]
    limit = len(rows) + BEYOND * (2.0 * len(rows)) ** 0.5
    return bool(own @ own > limit or np.abs(own).max() > _LONE)


def worth_a_look(kind: type[Effect], parts: frozenset[Part]) -> bool:
    """Tell whether an effect can be among what deviates; always so if a look at it is cheap."""
    if kind.name in _TRACES:
        return bool(_TRACES[kind.name] & parts)
    return kind.repeats or bool(parts)
