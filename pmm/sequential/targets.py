"""Coefficients that are to be known within targets: what is known, and which runs are left to make.

After each run the coefficients are found from the campaign's folder and the rest of the plan is
designed anew. A plan stays unless the new one is better by more than is worth an operator's time.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from typing import Final

from analysis.design.candidate import CandidateRun
from analysis.design.expectation import ExpectedCoefficient
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.design.design_file import DesignFile
from pmm.design.measured_runs import (
    MeasuredRuns,
    continued_design,
    read_measured_runs,
    repeats_said,
)
from pmm.design.run_selection import Design, design, expected_after, shortest_s
from pmm.document.notation import clock
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan
from pmm.sequential.growing_plan import (
    GrowingPlan,
    check_design,
    planned,
    read_growing,
    times_left_s,
)
from pmm.sequential.look import Ending, KnownTarget, Look
from pmm.sequential.reading_cache import Remembering

_WORSE: Final = 0.05  # of a natural logarithm, summed over the targets: a plan stays within
_LONGER: Final = 1.1  # times the new plan's time
_UNKNOWN: Final = 50.0  # logarithm for a coefficient that the runs do not determine


@dataclass(frozen=True, eq=False)
class _Standing:
    """A campaign's folder as it is: its plan, what was measured, what cannot be used and why."""

    plan: GrowingPlan | None
    measurement: MeasuredRuns | None
    unusable: dict[str, str]

    @property
    def runs_left(self) -> tuple[RunPlan, ...]:
        return () if self.plan is None else self.plan.runs_left

    @property
    def names(self) -> tuple[str, ...]:
        """Oscillations that are complete."""
        made = () if self.plan is None else self.plan.complete_runs
        return tuple(run.name for run in made if run.oscillates)

    def repeats(self, stated: float) -> Iterator[str]:
        """Yield which scatter between repeats is counted on."""
        if self.measurement is not None and self.measurement.cycles:
            yield from filter(None, [repeats_said(self.measurement.cycles, stated)])


class TargetGoal:
    """The targets of a design's file, in a campaign's folder.

    Raises
    ------
    ConfigurationError
        If there are no targets, or the design asks for an order that cannot be.
    """

    def __init__(self, file: DesignFile, folder: Path) -> None:
        check_design(file)
        self._file, self._folder = file, folder
        self._executor = Remembering()

    def plan(self, look: Look) -> tuple[str, ...]:
        """Write the plan as it was decided; return the names of the runs to be made now."""
        return planned(self._folder, self._file, look)

    def look(self) -> Look:
        """Return what is known and what is to be made, from what the folder holds.

        Raises
        ------
        ConfigurationError
            If the folder's plan or campaign file is wrong.
        """
        standing = self._standing()
        file = self._going_on(standing)
        best_design = design(file)
        notes = (
            *(f"{name} cannot be used: {why}" for name, why in standing.unusable.items()),
            *best_design.beyond,
            *standing.repeats(self._file.noise.repeat_relative),
        )
        hopeless = len(best_design.targets) < len(file.targets)
        file = replace(file, targets=best_design.targets)
        made = () if standing.plan is None else standing.plan.complete_runs
        look = Look(
            standing.names,
            math.fsum(duration_rows(made, self._file.rig)),
            tuple(_known_targets(best_design.expected_now if file.cycles else ())),
            notes=notes,
        )
        has_fixed = (
            bool(self._file.fixed) if standing.plan is None else bool(standing.plan.given_left)
        )
        planned_runs = _offered(standing.runs_left, file)
        ending = _ending(best_design, file, planned_runs, hopeless=hopeless)
        if ending is not None and not has_fixed:
            return replace(look, ending=ending[0], remark=ending[1])
        return self._with_next_runs(look, best_design, file, planned_runs, standing.plan)

    def _with_next_runs(
        self,
        look: Look,
        best_design: Design,
        file: DesignFile,
        planned_runs: Sequence[RunPlan],
        plan: GrowingPlan | None,
    ) -> Look:
        """Return the look with the runs that follow: those that were planned, or others."""
        new = tuple(step.run for step in best_design.steps for _ in range(step.repeats))
        times_s, before_s = (times_left_s(self._file, plan, runs) for runs in (new, planned_runs))
        # The time is that of the chosen runs: what is made in any case has none of it.
        new_s, planned_s = times_s[-1] - times_s[0], before_s[-1] - before_s[0]
        why = self._why_new(best_design, file, planned_runs, new_s, planned_s)
        if not why or not new:
            return replace(look, kept_runs=tuple(planned_runs), left_s=before_s[-1])
        return replace(
            look,
            proposed=new,
            costs_s=tuple(after - before for before, after in pairwise(times_s)),
            left_s=times_s[-1],
            before=tuple(planned_runs),
            before_s=before_s[-1],
            remark=why,
        )

    def _why_new(
        self,
        best_design: Design,
        file: DesignFile,
        planned_runs: Sequence[RunPlan],
        new_s: float,
        left_s: float,
    ) -> str:
        """Return why the runs that are planned are not to stay; empty where they are."""
        if not planned_runs:
            return "the plan so far does not do" if file.cycles else "the first plan"
        candidates = [CandidateRun(run.set_point, run.periods, math.inf) for run in planned_runs]
        would = expected_after(file, candidates)
        best = list(best_design.in_reach(best_design.expected_coefficients))
        if _missing(would) > _missing(best) + _WORSE:
            worst = max(would, key=_short)
            return f"the runs that were planned would leave {_uncertainty_text(worst)}"
        if left_s > file.time_s:
            return f"the runs that were planned take longer than {clock(file.time_s)}, what is left"
        return f"saves {clock(left_s - new_s)}" if left_s > _LONGER * new_s else ""

    def _standing(self) -> _Standing:
        plan = read_growing(self._folder, self._file)
        if plan is None or not (self._folder / CAMPAIGN_FILE).is_file():
            return _Standing(plan, None, {})
        if not any(run.oscillates for run in plan.complete_runs):
            return _Standing(plan, None, {})
        measurement = read_measured_runs(self._file, self._folder, self._executor)
        places = [
            k for k, cycle in enumerate(measurement.cycles) if cycle.name in plan.complete_names
        ]
        measurement = replace(
            measurement,
            candidates=tuple(measurement.candidates[k] for k in places),
            cycles=tuple(measurement.cycles[k] for k in places),
        )
        usable = {cycle.name for cycle in measurement.cycles}
        unusable = {
            run.name: measurement.failed.get(run.name, "it is left out")
            for run in plan.chosen_runs
            if run.name in plan.complete_names and run.name not in usable
        }
        return _Standing(plan, measurement, unusable)

    def _going_on(self, standing: _Standing) -> DesignFile:
        """Return the design after what was made, with the time and the candidates that are left."""
        measurement, plan, file = standing.measurement, standing.plan, self._file
        if measurement is not None and measurement.cycles:
            file = continued_design(file, [measurement])
        if plan is None:
            return file
        made = [run for run in plan.chosen_runs if run.name in plan.complete_names]
        barred = {run.set_point for run in made if run.name in standing.unusable}
        places = [k for k, run in enumerate(file.grid.runs) if run.set_point not in barred]
        return replace(
            file,
            grid=file.grid.among(places),
            time_s=max(file.time_s - plan.chosen_s(file.rig), 0.0),
        )


def _offered(planned_runs: Sequence[RunPlan], file: DesignFile) -> Sequence[RunPlan]:
    """Return the planned runs that are left; none where the grid does not have all of them now."""
    offered = {(run.set_point, run.periods) for run in file.grid.runs}
    return (
        planned_runs if all((run.set_point, run.periods) in offered for run in planned_runs) else ()
    )


def _ending(
    best_design: Design, file: DesignFile, planned_runs: Sequence[RunPlan], *, hopeless: bool
) -> tuple[Ending, str] | None:
    """Return why nothing more is to be made, and more of it; ``None`` where something is."""
    wanted = list(best_design.in_reach(best_design.expected_now))
    if file.cycles and wanted and all(row.met for row in wanted):
        return (Ending.EXHAUSTED, "all other targets are met") if hopeless else (Ending.MET, "")
    if best_design.steps or (planned_runs and not hopeless):
        return None
    rows = best_design.in_reach(best_design.expected_now or best_design.expected_coefficients)
    short = [_uncertainty_text(row) for row in rows if not row.met]
    if shortest_s(file) > file.time_s:
        left_of = f"{clock(file.time_s)} are left of limits.time_h, too little for any run"
        return Ending.TIME, "; ".join([f"{left_of} of the grid", *short])
    return Ending.EXHAUSTED, "; ".join(["no run of the grid helps", *short])


def _known_targets(rows: Sequence[ExpectedCoefficient]) -> Iterator[KnownTarget]:
    for row in rows:
        if math.isfinite(row.wanted):
            name = f"{row.name} at {row.where}" if row.where else row.name
            is_known = math.isfinite(row.standard_uncertainty)
            u, value = (row.standard_uncertainty, row.value) if is_known else (None, None)
            most = next(iter(row.shares.items()), None)
            mostly = "" if most is None else f"{most[0]}, {100.0 * most[1]:.0f} %"
            yield KnownTarget(name, row.unit, value, u, row.wanted, mostly)


def _short(row: ExpectedCoefficient) -> float:
    """Return by how much a coefficient misses its target, as a logarithm; 0 where it is met."""
    if not math.isfinite(row.wanted):
        return 0.0
    if not math.isfinite(row.standard_uncertainty):
        return _UNKNOWN
    return max(0.0, math.log(max(row.standard_uncertainty, 1e-300) / row.wanted))


def _missing(rows: Sequence[ExpectedCoefficient]) -> float:
    return math.fsum(map(_short, rows))


def _uncertainty_text(row: ExpectedCoefficient) -> str:
    where = f" at {row.where}" if row.where else ""
    if row.message:
        return f"{row.name}{where} unknown ({row.message})"
    return f"{row.name}{where} at {row.standard_uncertainty:.3g} {row.unit}, {row.wanted:.3g} asked"
