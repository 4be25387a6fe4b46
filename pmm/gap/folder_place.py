"""A campaign's folder as the place of a pursuit: others make the runs of the plans beside it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from analysis.gap.design.proposals import OSCILLATION, Proposal
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import Medium, SetPoint
from pmm.gap.causes import Standing, Suggestion
from pmm.gap.pursuit import pursued, take_in, write_round
from pmm.plan.plan_tables import Defaults
from pmm.plan.run_plan import RunPlan
from pmm.sequential.look import Look


@dataclass
class FolderPlace:
    """A campaign's folder whose runs are made by somebody else, or simulated."""

    folder: Path
    _offered: dict[SetPoint, Suggestion] = field(default_factory=dict)

    def standing(self) -> Standing:
        """Return what is there, recordings that have appeared taken in."""
        missing = take_in(pursued(self.folder))
        there = pursued(self.folder)
        made = there.campaign.runs
        return Standing(
            tuple(one.name for one in made),
            math.fsum(one.periods / one.frequency_hz for one in made),
            there.open,
            (),
            there.set_points,
            tuple(f"{name} is not there yet ({why})" for name, why in missing.items()),
        )

    def offered(self, worth: Sequence[Suggestion]) -> Sequence[tuple[Suggestion, RunPlan]]:
        """Return all of them."""
        self._offered = {one.set_point: one for one in worth}
        return [(one, _proposed(one.set_point)) for one in worth]

    def costs_s(self, runs: Sequence[RunPlan]) -> tuple[float, ...]:
        """Return how long the shaft turns in each."""
        return tuple(one.moving_s for one in runs)

    def plan(self, look: Look) -> tuple[str, ...]:
        """Write the plan of a round; return the names of the runs that are to be recorded."""
        if look.ending is not None:
            return ()
        there = pursued(self.folder)
        if look.proposed:
            chosen = (self._offered[one.set_point] for one in look.proposed)
            own = (
                Proposal(OSCILLATION, one.set_point, 0.0, one.gain, one.between) for one in chosen
            )
            write_round(there, list(own))
            there = pursued(self.folder)
        return tuple(one.name for one in there.open)


def _proposed(point: SetPoint) -> RunPlan:
    """Return a run as a plan without settings of its own makes it."""
    usual = Defaults()
    kind = RunKind.DRY if point.medium is Medium.AIR else RunKind.OSCILLATION
    return RunPlan(
        "", kind, Motion.PHASE, point, usual.periods, usual.settling_periods,
        max_periods=usual.periods,
    )  # fmt: skip
