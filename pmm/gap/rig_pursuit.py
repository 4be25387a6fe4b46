"""A campaign that is pursued on its rig: its plan grows, and run control makes the runs.

Runs are proposed of the design's grid alone, so that its limits and the checks of plans hold.
"""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Final

from analysis.gap.design.proposals import Proposal
from hardware.description.errors import ConfigurationError
from pmm.design.design_file import DesignFile
from pmm.design.grid import costs_s
from pmm.gap.causes import CauseGoal, Found, Standing, found_of
from pmm.gap.examination import Options, examine
from pmm.gap.own_effects import chosen_effects
from pmm.parallel import LocalProcesses
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan
from pmm.sequential.course import CampaignGoal
from pmm.sequential.growing_plan import check_order, planned, read_growing
from pmm.sequential.look import Look
from pmm.sequential.targets import TargetGoal

_FEWEST: Final = 3  # runs that a diagnosis begins with


class RigPlace:
    """A design's campaign, recorded by run control.

    Raises
    ------
    ConfigurationError
        If the design asks for an order that cannot be, or begins with too few runs.
    """

    def __init__(self, file: DesignFile, folder: Path) -> None:
        check_order(file)
        first = sum(run.oscillates for run in file.fixed)
        if first < _FEWEST:
            raise ConfigurationError(
                f"{file.path}: begins with {first} oscillations; a cause is looked for from "
                f"{_FEWEST} on: add [[runs]] that are made first"
            )
        self._file, self._folder = file, folder
        self._last: RunPlan | None = None

    def standing(self) -> Standing:
        """Return what the folder holds."""
        plan, file = read_growing(self._folder, self._file), self._file
        if plan is None:
            given = tuple(run for run in file.fixed if run.oscillates)
            return Standing((), 0.0, given, (), frozenset(), time_left_s=file.time_s)
        made = plan.made
        self._last = made[-1] if made else None
        return Standing(
            tuple(run.name for run in made if run.oscillates),
            math.fsum(duration_rows(made, file.rig)),
            plan.given_left,
            plan.left,
            frozenset(run.set_point for run in plan.plan.runs if run.oscillates),
            time_left_s=file.time_s - plan.chosen_s(file.rig),
        )

    def offered(self, proposals: Sequence[Proposal]) -> Sequence[tuple[Proposal, RunPlan]]:
        """Return which of some proposals the grid has, each with its run."""
        runs = {run.set_point: run for run in reversed(self._file.grid.runs)}
        return [
            (one, runs[one.set_point])
            for one in proposals
            if one.set_point is not None and one.set_point in runs
        ]

    def costs_s(self, runs: Sequence[RunPlan]) -> tuple[float, ...]:
        """Return the tank time of each of some runs that are to follow."""
        return costs_s(runs, self._last, self._file.rig, self._file.tables.zero)

    def plan(self, look: Look) -> tuple[str, ...]:
        """Write the plan as it was decided; return the names of the runs to be made now."""
        return planned(self._folder, self._file, look)


def goal_of(file: DesignFile, folder: Path, *, apart: bool = True) -> CampaignGoal:
    """Return what a design's campaign is made for: its cause where it has ``[gap]``, else targets.

    Parameters
    ----------
    apart
        Whether a process of its own diagnoses, so that a loop beside it keeps its time.

    Raises
    ------
    ConfigurationError
        If the design asks for what cannot be, or has no end.
    """
    if file.gap is None:
        return TargetGoal(file, folder)
    points = tuple(dict.fromkeys(run.set_point for run in file.grid.runs))
    options = Options(file.gap.effects, runs=points)
    chosen_effects(options.effects, options.without)  # refuses names that nobody knows
    return CauseGoal(
        RigPlace(file, folder),
        partial(_elsewhere if apart else _diagnosed, folder, options),
        file.gap.least_log_odds,
        file.gap.batch,
    )


def _diagnosed(folder: Path, options: Options) -> Found:
    return found_of(examine(folder, options))


def _elsewhere(folder: Path, options: Options) -> Found:
    with LocalProcesses(1) as executor:
        return executor.submit(_diagnosed, folder, options).result()
