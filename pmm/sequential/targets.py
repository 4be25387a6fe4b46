"""Coefficients that are to be known within targets: what is known, and which runs are left to make.

After each run the coefficients are found from the campaign's folder and the rest of the plan is
designed anew. A plan stays unless the new one is better by more than is worth an operator's time.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from analysis.design.candidate import CandidateRun
from analysis.design.expectation import ExpectedCoefficient
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.design.design_file import DesignFile
from pmm.design.grid import costs_s
from pmm.design.measured_runs import Measured, after, measured, repeats_said
from pmm.design.run_selection import Design, beyond_runs, design, foreseen
from pmm.document.notation import clock
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan
from pmm.sequential.growing_plan import GrowingPlan, check_design, planned, read_growing
from pmm.sequential.look import Ending, KnownTarget, Look
from pmm.sequential.reading_cache import Remembering

_WORSE: Final = 0.05  # of a natural logarithm, summed over the targets: a plan stays within
_LONGER: Final = 1.1  # times the new plan's time
_UNKNOWN: Final = 50.0  # logarithm for a coefficient that the runs do not determine


@dataclass(frozen=True, eq=False)
class _Standing:
    """A campaign's folder as it is: its plan, what was measured, what cannot be used and why."""

    plan: GrowingPlan | None
    found: Measured | None
    unusable: dict[str, str]

    @property
    def left(self) -> tuple[RunPlan, ...]:
        return () if self.plan is None else self.plan.left

    @property
    def names(self) -> tuple[str, ...]:
        """Oscillations that are complete."""
        made = () if self.plan is None else self.plan.made
        return tuple(run.name for run in made if run.oscillates)

    def repeats(self, stated: float) -> Iterator[str]:
        """Yield which scatter between repeats is counted on."""
        if self.found is not None and self.found.cycles:
            yield from filter(None, [repeats_said(self.found.cycles, stated)])


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
        file, found, hopeless = _designed(self._going_on(standing))
        notes = (
            *(f"{name} cannot be used: {why}" for name, why in standing.unusable.items()),
            *(why for why, one in hopeless),
            *standing.repeats(self._file.noise.repeat_relative),
        )
        made = () if standing.plan is None else standing.plan.made
        look = Look(
            standing.names,
            math.fsum(duration_rows(made, self._file.rig)),
            tuple(_known([*found.now, *(one for _, one in hopeless)] if file.cycles else [])),
            notes=notes,
        )
        given = bool(self._file.fixed) if standing.plan is None else bool(standing.plan.given_left)
        left = _offered(standing.left, file)
        ending = _ending(found, file, left, hopeless=bool(hopeless))
        if ending is not None and not given:
            return replace(look, ending=ending[0], remark=ending[1])
        return self._next(look, found, file, left, made)

    def _next(
        self,
        look: Look,
        found: Design,
        file: DesignFile,
        left: Sequence[RunPlan],
        made: Sequence[RunPlan],
    ) -> Look:
        """Return the look with the runs that follow: those that were planned, or others."""
        new = tuple(step.run for step in found.steps for _ in range(step.repeats))
        each_s, left_s = self._costs_s(new, made), math.fsum(self._costs_s(left, made))
        new_s = math.fsum(each_s)
        why = self._why_new(found, file, left, new_s, left_s)
        if not why or not new:
            return replace(look, kept=tuple(left), left_s=left_s)
        return replace(
            look,
            proposed=new,
            costs_s=each_s,
            left_s=new_s,
            before=tuple(left),
            before_s=left_s,
            remark=why,
        )

    def _why_new(
        self, found: Design, file: DesignFile, left: Sequence[RunPlan], new_s: float, left_s: float
    ) -> str:
        """Return why the runs that are planned are not to stay; empty where they are."""
        if not left:
            return "the plan so far does not do" if file.cycles else "the first plan"
        candidates = [CandidateRun(run.set_point, run.periods, math.inf) for run in left]
        would = foreseen(file, candidates)
        if _missing(would) > _missing(found.known) + _WORSE:
            worst = max(would, key=_short)
            return f"the runs that were planned would leave {_said(worst)}"
        if left_s > file.time_s:
            return f"the runs that were planned take longer than {clock(file.time_s)}, what is left"
        return f"saves {clock(left_s - new_s)}" if left_s > _LONGER * new_s else ""

    def _standing(self) -> _Standing:
        plan = read_growing(self._folder, self._file)
        if plan is None or not (self._folder / CAMPAIGN_FILE).is_file():
            return _Standing(plan, None, {})
        if not any(run.oscillates for run in plan.made):
            return _Standing(plan, None, {})
        found = measured(self._file, self._folder, self._executor)
        kept = [k for k, one in enumerate(found.cycles) if one.name in plan.done]
        found = replace(
            found,
            candidates=tuple(found.candidates[k] for k in kept),
            cycles=tuple(found.cycles[k] for k in kept),
        )
        usable = {one.name for one in found.cycles}
        unusable = {
            run.name: found.failed.get(run.name, "it is left out")
            for run in plan.chosen
            if run.name in plan.done and run.name not in usable
        }
        return _Standing(plan, found, unusable)

    def _going_on(self, standing: _Standing) -> DesignFile:
        """Return the design after what was made, with the time and the candidates that are left."""
        found, plan, file = standing.found, standing.plan, self._file
        if found is not None and found.cycles:
            file = after(file, [found])
        if plan is None:
            return file
        made = [run for run in plan.chosen if run.name in plan.done]
        barred = {run.set_point for run in made if run.name in standing.unusable}
        places = [k for k, run in enumerate(file.grid.runs) if run.set_point not in barred]
        grid = replace(
            file.grid,
            runs=tuple(file.grid.runs[k] for k in places),
            candidates=tuple(file.grid.candidates[k] for k in places),
        )
        return replace(file, grid=grid, time_s=max(file.time_s - plan.chosen_s(file.rig), 0.0))

    def _costs_s(self, runs: Sequence[RunPlan], made: Sequence[RunPlan]) -> tuple[float, ...]:
        """Return the tank time of each of some runs that follow those that were made."""
        file = self._file
        before = made[-1] if made else None
        return costs_s(runs, before, file.rig, file.tables.zero)


def _offered(left: Sequence[RunPlan], file: DesignFile) -> Sequence[RunPlan]:
    """Return the planned runs that are left; none where the grid does not have all of them now."""
    offered = {(run.set_point, run.periods) for run in file.grid.runs}
    return left if all((run.set_point, run.periods) in offered for run in left) else ()


def _designed(
    file: DesignFile,
) -> tuple[DesignFile, Design, list[tuple[str, ExpectedCoefficient]]]:
    """Return the file with the targets that runs can meet, its design, and why not the others."""
    hopeless: list[tuple[str, ExpectedCoefficient]] = []
    while True:
        found = design(file)
        short = zip([one for one in found.known if not one.met], found.why, strict=True)
        bad = [(why, one) for one, why in short if math.isfinite(one.wanted) and beyond_runs(one)]
        if not bad:
            return file, found, hopeless
        now = {(one.name, one.where): one for one in found.now}
        hopeless += [(why, now.get((one.name, one.where), one)) for why, one in bad]
        names = {one.name for _, one in bad}
        targets = tuple(one for one in file.targets if one.name not in names)
        if not targets:
            return file, Design((), (), (), ()), hopeless
        file = replace(file, targets=targets)


def _ending(
    found: Design, file: DesignFile, left: Sequence[RunPlan], *, hopeless: bool
) -> tuple[Ending, str] | None:
    """Return why nothing more is to be made, and more of it; ``None`` where something is."""
    wanted = [one for one in found.now if math.isfinite(one.wanted)]
    if file.cycles and wanted and all(one.met for one in wanted):
        return (Ending.EXHAUSTED, "all other targets are met") if hopeless else (Ending.MET, "")
    if found.steps or (left and not hopeless):
        return None
    short = [_said(one) for one in wanted if file.cycles and not one.met]
    cheapest_s = min((one.cost_s + one.setting_s for one in file.grid.candidates), default=math.inf)
    if cheapest_s > file.time_s:
        left_of = f"{clock(file.time_s)} are left of limits.time_h, too little for any run"
        return Ending.TIME, "; ".join([f"{left_of} of the grid", *short])
    return Ending.EXHAUSTED, "; ".join(["no run of the grid helps", *short])


def _known(rows: Sequence[ExpectedCoefficient]) -> Iterator[KnownTarget]:
    for one in rows:
        if math.isfinite(one.wanted):
            name = f"{one.name} at {one.where}" if one.where else one.name
            told = math.isfinite(one.standard_uncertainty)
            u, value = (one.standard_uncertainty, one.value) if told else (None, None)
            most = next(iter(one.shares.items()), None)
            mostly = "" if most is None else f"{most[0]}, {100.0 * most[1]:.0f} %"
            yield KnownTarget(name, one.unit, value, u, one.wanted, mostly)


def _short(one: ExpectedCoefficient) -> float:
    """Return by how much a coefficient misses its target, as a logarithm; 0 where it is met."""
    if not math.isfinite(one.wanted):
        return 0.0
    if not math.isfinite(one.standard_uncertainty):
        return _UNKNOWN
    return max(0.0, math.log(max(one.standard_uncertainty, 1e-300) / one.wanted))


def _missing(rows: Sequence[ExpectedCoefficient]) -> float:
    return math.fsum(map(_short, rows))


def _said(one: ExpectedCoefficient) -> str:
    where = f" at {one.where}" if one.where else ""
    if one.message:
        return f"{one.name}{where} unknown ({one.message})"
    return f"{one.name}{where} at {one.standard_uncertainty:.3g} {one.unit}, {one.wanted:.3g} asked"
