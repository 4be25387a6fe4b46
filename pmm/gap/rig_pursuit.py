"""A campaign that is pursued on its rig: its plan grows, and run control makes the runs.

Runs are proposed of the design's grid alone, so that its limits and the checks of plans hold.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from hardware.description.setpoint import SetPoint
from pmm.design.design_file import DesignFile
from pmm.gap.causes import CauseDiagnosis, CauseGoal, Standing, Suggestion
from pmm.parallel import LocalProcesses
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan
from pmm.sequential.course import CampaignGoal
from pmm.sequential.growing_plan import (
    GrowingPlan,
    check_design,
    planned,
    read_growing,
    times_left_s,
)
from pmm.sequential.look import Look
from pmm.sequential.targets import TargetGoal


class RigPlace:
    """A design's campaign, recorded by run control."""

    def __init__(self, file: DesignFile, folder: Path) -> None:
        self._file, self._folder = file, folder
        self._plan: GrowingPlan | None = None

    def standing(self) -> Standing:
        """Return what the folder holds."""
        plan, file = read_growing(self._folder, self._file), self._file
        self._plan = plan
        if plan is None:
            fixed_runs = tuple(run for run in file.fixed if run.oscillates)
            return Standing((), 0.0, fixed_runs, (), frozenset(), time_left_s=file.time_s)
        made = plan.complete_runs
        return Standing(
            tuple(run.name for run in made if run.oscillates),
            math.fsum(duration_rows(made, file.rig)),
            plan.given_left,
            plan.runs_left,
            frozenset(run.set_point for run in plan.plan.runs if run.oscillates),
            time_left_s=file.time_s - plan.chosen_s(file.rig),
        )

    def offered(self, worth: Sequence[Suggestion]) -> Sequence[tuple[Suggestion, RunPlan]]:
        """Return which of some runs the grid has."""
        runs = {run.set_point: run for run in reversed(self._file.grid.runs)}
        return [
            (suggestion, runs[suggestion.set_point])
            for suggestion in worth
            if suggestion.set_point in runs
        ]

    def times_left_s(self, runs: Sequence[RunPlan]) -> Sequence[float]:
        """Return the tank time that is left without some runs, with the first, ...."""
        return times_left_s(self._file, self._plan, runs)

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
    check_design(file)
    if file.gap.effects:
        from pmm.gap.own_effects import chosen_effects

        chosen_effects(file.gap.effects, ())  # refuses names that nobody knows
    points = tuple(dict.fromkeys(run.set_point for run in file.grid.runs))
    asked = _Asked(folder, file.gap.effects, points, file.gap.batch)
    work = partial(_diagnose_in_process if apart else _diagnose, asked)
    return CauseGoal(RigPlace(file, folder), work, file.gap.least_log_odds, file.gap.batch)


@dataclass(frozen=True)
class _Asked:
    """What a process of its own is asked to diagnose: this one imports no diagnosis."""

    folder: Path
    effects: tuple[str, ...]
    runs: tuple[SetPoint, ...]
    batch: int


def _diagnose(asked: _Asked) -> CauseDiagnosis:
    from pmm.gap.examination import Options
    from pmm.gap.found_cause import diagnosed

    return diagnosed(asked.folder, Options(asked.effects, runs=asked.runs, batch=asked.batch))


def _diagnose_in_process(asked: _Asked) -> CauseDiagnosis:
    with LocalProcesses(1) as executor:
        return executor.submit(_diagnose, asked).result()
