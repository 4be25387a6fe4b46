"""What peers look at: the residual of a case with coefficients fitted, in the project's own terms.

Peers get the same start as the diagnosis: recordings resolved into harmonics with uncertainties,
the nominal simulation taken off, and the coefficients fitted within their tolerances. What
they make of the remainder is theirs.
"""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis.gap.design.forecast import forecast, planned, with_further_runs
from analysis.gap.forward.free_numbers import free_numbers, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.observe.components import Component, GapRun, Stack
from hardware.description.arrays import FloatArray
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.gap.answer import harmonics
from pmm.gap.case import read_case
from pmm.gap.load import load_campaign


@dataclass(frozen=True, eq=False)
class Remainder:
    """Components of some runs, one after the other.

    Attributes
    ----------
    values
        What the nominal simulation with fitted coefficients leaves (fitting runs), or what it
        foretells (withheld runs), in SI; shape ``(components,)``.
    sigma
        One standard deviation of each.
    run
        Number of the run of each.
    """

    runs: tuple[GapRun, ...]
    components: tuple[Component, ...]
    run: NDArray[np.intp]
    values: FloatArray
    sigma: FloatArray


@dataclass(frozen=True, eq=False)
class Scene:
    """One case as a peer sees it."""

    case: str
    fitting: Remainder
    withheld: Remainder
    names: tuple[str, ...]

    def foretold(self, added: FloatArray | None = None) -> tuple[dict[str, Any], dict[str, Any]]:
        """Return ``before`` and ``after``, the latter with something added to the components."""
        stack = self.withheld
        before, after = (
            {
                name: harmonics(_as_stack(stack), stack.values + extra, number)
                for number, name in enumerate(self.names)
            }
            for extra in (0.0, 0.0 if added is None else added)
        )
        return before, after


def _as_stack(one: Remainder) -> Stack:
    return Stack(one.runs, one.components, one.run, one.values, one.sigma)


@lru_cache(maxsize=1)
def scene(folder: Path) -> Scene:
    """Return what a peer sees of a case; the last one is kept, as peers answer in turn."""
    loaded, case = load_campaign(folder), read_case(folder / CAMPAIGN_FILE)
    stack = Stack.of(pooled(loaded.runs, loaded.rig, case.tolerances))
    simulator = Simulator(loaded.rig, stack, (), loaded.reference_channel)
    free = free_numbers(loaded.rig, case.tolerances)
    nuisances = tolerated(simulator, free, case.tolerances)
    problem = Problem(simulator, nuisances)
    left = problem.residual - nuisances.columns @ nuisances.fitted(problem.residual)
    runs = [planned(problem, one.set_point, at) for at, one in enumerate(case.held_out)]
    there = with_further_runs(problem, runs, free, case.tolerances)
    values = forecast(problem, there, None).values(there)
    ahead = there.simulator.stack
    return Scene(
        folder.name,
        Remainder(stack.runs, stack.components, stack.run, left * stack.uncertainty,
                  stack.uncertainty),
        Remainder(ahead.runs, ahead.components, ahead.run, values, ahead.uncertainty),
        tuple(one.name for one in case.held_out),
    )  # fmt: skip
