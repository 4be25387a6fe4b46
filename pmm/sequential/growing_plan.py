"""The plan of a campaign that chooses its runs: what was made, and what is approved to be made.

It lies in the campaign's folder and is a plan as any other; each run that was chosen is an entry of
its own, behind the runs that are made in any case. Zero and control runs stand between them as the
design says.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from pmm.configuration import read_toml
from pmm.design.design_file import DesignFile
from pmm.design.plan_writer import plan_head, run_entry
from pmm.plan.duration import duration_rows
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.plan_tables import Scheme, ZeroTable
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.run.campaign_folder import done_runs
from pmm.sequential.look import Look
from pmm.toml_text import toml_table
from pmm.whole_file import write_whole

PLAN: Final = "plan.toml"
_FEWEST: Final = 3  # oscillations that a first diagnosis takes
_BETWEEN: Final = (RunKind.ZERO, RunKind.CONTROL)


@dataclass(frozen=True, eq=False)
class GrowingPlan:
    """A campaign's plan as its folder has it.

    Attributes
    ----------
    entries
        Behind those that are made in any case, as the file has them: one run each.
    complete_names
        Names of all runs that are complete.
    """

    plan: Plan
    entries: tuple[Mapping[str, Any], ...]
    complete_names: frozenset[str]

    @property
    def chosen_runs(self) -> tuple[RunPlan, ...]:
        """Runs that were chosen, in their order."""
        names = {entry["name"] for entry in self.entries}
        return tuple(
            run for run in self.plan.runs if run.kind is RunKind.OSCILLATION and run.entry in names
        )

    @property
    def complete_runs(self) -> tuple[RunPlan, ...]:
        """All runs that are complete, in the plan's order."""
        return tuple(run for run in self.plan.runs if run.name in self.complete_names)

    @property
    def open_runs(self) -> tuple[RunPlan, ...]:
        """All runs that are not complete."""
        return tuple(run for run in self.plan.runs if run.name not in self.complete_names)

    @property
    def runs_left(self) -> tuple[RunPlan, ...]:
        """Chosen runs that are not complete."""
        return tuple(run for run in self.chosen_runs if run.name not in self.complete_names)

    @property
    def given_left(self) -> tuple[RunPlan, ...]:
        """Runs that are made in any case and are not complete, zero and control runs apart."""
        apart = {run.name for run in self.chosen_runs}
        return tuple(
            run for run in self.open_runs if run.name not in apart and run.kind not in _BETWEEN
        )

    @property
    def due(self) -> tuple[RunPlan, ...]:
        """What is to be made before it is asked again: up to the next run that was chosen.

        In the end these are the closing zero runs. A closing control run is none of them: whatever
        is added later would find it in its way.
        """
        runs = self.open_runs
        upto = self.runs_left[:1] or self.given_left[-1:]
        if upto:
            return runs[: runs.index(upto[0]) + 1]
        return tuple(run for run in runs if run.kind is RunKind.ZERO)

    @property
    def closed(self) -> bool:
        """Whether the zero run behind the last run was made."""
        runs = self.plan.runs
        return bool(runs) and runs[-1].kind is RunKind.ZERO and runs[-1].name in self.complete_names

    def chosen_s(self, rig: RigFile) -> float:
        """Return the tank time of the chosen runs that were made, with what stands between them."""
        names = {run.name for run in self.chosen_runs}
        rows = zip(self.complete_runs, duration_rows(self.complete_runs, rig), strict=True)
        return math.fsum(
            time_s for run, time_s in rows if run.name in names or run.kind in _BETWEEN
        )

    @property
    def made_behind(self) -> tuple[RunPlan, ...]:
        """Runs that are complete, of entries behind those that are made in any case."""
        names = {entry["name"] for entry in self.entries}
        return tuple(run for run in self.complete_runs if run.entry in names)

    def made_entries(self) -> Iterator[Mapping[str, Any]]:
        """Yield the entries whose runs are complete."""
        names = {run.entry for run in self.complete_runs}
        yield from (entry for entry in self.entries if entry["name"] in names)


def read_growing(folder: Path, design: DesignFile) -> GrowingPlan | None:
    """Return the plan that a campaign's folder holds; ``None`` where there is none yet.

    Raises
    ------
    ConfigurationError
        If it cannot be read, or its first runs are not those of the design.
    """
    path = folder / PLAN
    if not path.is_file():
        return None
    plan, _ = read_plan_and_rig(path)
    entries = read_toml(path)["runs"]
    design_entries = design.plan_table.get("runs", [])
    if entries[: len(design_entries)] != design_entries:
        raise ConfigurationError(
            f"{path}: begins with other [[runs]] than {design.path.name}; put them back, or record "
            "to another folder with --output"
        )
    chosen_entries = tuple(entries[len(design_entries) :])
    return GrowingPlan(plan, chosen_entries, frozenset(done_runs(folder, plan.runs)))


def times_left_s(
    design: DesignFile, plan: GrowingPlan | None, runs: Sequence[RunPlan]
) -> list[float]:
    """Return the tank time that is left without some runs that may follow, with the first, ....

    Parameters
    ----------
    plan
        As it is; ``None`` where there is none yet.
    """
    behind = [] if plan is None else [[run] for run in plan.made_behind]
    made = () if plan is None else plan.complete_runs
    made_s = math.fsum(duration_rows(made, design.rig))
    entries = [*behind, *([run] for run in runs)]
    upto = range(len(behind), len(entries) + 1)
    return [max(design.tank_time_s(entries[:count]) - made_s, 0.0) for count in upto]


def planned(folder: Path, design: DesignFile, look: Look) -> tuple[str, ...]:
    """Write the plan as it was decided; return the names of the runs to be made now."""
    before = read_growing(folder, design)
    if before is None and not look.proposed and not design.fixed:
        return ()
    if look.proposed or look.ending is not None or before is None:
        write_growing(folder, design, before, look.proposed)
    now = read_growing(folder, design)
    return () if now is None else tuple(run.name for run in now.due)


def write_growing(
    folder: Path, design: DesignFile, before: GrowingPlan | None, runs: Sequence[RunPlan]
) -> None:
    """Write the plan with the chosen runs that were made and those that are to follow.

    Parameters
    ----------
    before
        The plan so far.
    runs
        That follow, to be named.
    """
    target = folder / PLAN
    entries = [] if before is None else list(before.made_entries())
    if before is not None and before.closed and runs:
        entries.append(_separating_zero(design, len(entries)))
    first = 1 + sum("motion" in entry for entry in entries)
    entry_of = design.grid.entry_of
    entries += [run_entry(entry_of[run], run, number) for number, run in enumerate(runs, first)]
    tables = [*design.plan_table.get("runs", []), *entries]
    text = [
        *plan_head(design, target, grows=True),
        *(toml_table("runs", table, array=True) for table in tables),
    ]
    write_whole(target, "\n".join(text))


def _separating_zero(design: DesignFile, number: int) -> Mapping[str, Any]:
    """Return a record at rest that keeps runs apart from those that a zero run has closed."""
    zero = design.tables.zero or ZeroTable()
    return {"kind": "zero", "name": f"apart-{number:02d}", "duration_s": zero.duration_s}


def check_design(design: DesignFile) -> None:
    """Refuse a design whose campaign has no end, no beginning, or an order that cannot be.

    Raises
    ------
    ConfigurationError
        If there are no targets where there is no cause to be found, too few runs for a first
        diagnosis where there is, or entries are mixed: each run rests on those before it.
    """
    if design.gap is None and not design.targets:
        raise ConfigurationError(
            f"{design.path}: has no [targets]; nothing tells when enough is known"
        )
    first = sum(run.oscillates for run in design.fixed)
    if design.gap is not None and first < _FEWEST:
        raise ConfigurationError(
            f"{design.path}: begins with {first} oscillations; a cause is looked for from "
            f"{_FEWEST} on: add [[runs]] that are made first"
        )
    order = design.tables.order
    if order.scheme is Scheme.RANDOM and order.across_entries:
        raise ConfigurationError(
            f"{design.path}: order.across_entries mixes runs that are chosen one after the other; "
            "take it out"
        )
