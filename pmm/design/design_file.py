"""Reading ``design.toml``: a plan whose runs are to be chosen from a grid.

Its tables are those of a plan (what ``[[runs]]`` holds is made in any case) with ``[[grid]]``,
matrices of runs to choose from, and the tables of :mod:`pmm.design.design_tables`.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.names import PLACES, Form, name_of
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.terms import SURGE
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.noise import Noise
from hardware.description.errors import ConfigurationError
from pmm.campaign.model_uncertainty import take_uncertainty
from pmm.coefficients.stated_inputs import largest, of_gauges, of_model
from pmm.coefficients.steered_runs import usual_rate_hz
from pmm.configuration import Fault, as_error, limit_faults, read_toml, validate
from pmm.design.counted_runs import grid_faults, oscillates_in_water, uncounted_runs
from pmm.design.design_tables import DesignLimits, DesignTables, GapTable
from pmm.design.grid import RunGrid, between_s, grid_of
from pmm.design.targets import targets_of
from pmm.plan.duration import duration_rows
from pmm.plan.expansion import all_of, expand, single_entries
from pmm.plan.ordering import runs_of
from pmm.plan.plan import PlanReading, examine_plan
from pmm.plan.plan_tables import Defaults, PlanEntry, PlanTables
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

_OWN: Final = ("grid", "believed", "targets", "noise", "stated", "limits", "gap")


@dataclass(frozen=True, eq=False)
class DesignFile:
    """A design's file, read and checked.

    Attributes
    ----------
    name
        Of the campaign.
    plan_table
        Of a plan without the runs that are to be chosen, as it is written.
    rig_path
        Where the rig's file lies.
    channels
        The rig's force channels.
    fixed
        Runs that are made in any case, zero and control runs among them.
    made_runs
        Those of them that tell of the coefficients, or runs that were made before.
    uncounted
        Why other oscillations of them in water are not counted, by run.
    time_s
        That the runs to be chosen may take.
    cycles
        Of the runs that were made before, as they were measured; none where none was.
    gap
        How a cause is looked for; ``None`` where targets are to be met.
    """

    name: str
    path: Path
    plan_table: dict[str, Any]
    rig_path: Path
    rig: RigFile
    channels: tuple[str, ...]
    tables: PlanTables
    fixed: tuple[RunPlan, ...]
    made_runs: tuple[CandidateRun, ...]
    grid: RunGrid
    belief: Belief
    noise: Noise
    stated: StatedUncertainties
    targets: tuple[DesignTarget, ...]
    time_s: float
    cycles: tuple[BodyCycle, ...] = ()
    gap: GapTable | None = None
    uncounted: Mapping[str, str] = field(default_factory=dict)

    def tank_time_s(self, chosen: Sequence[Sequence[RunPlan]] = ()) -> float:
        """Return how long the plan takes with some entries behind what is made in any case.

        Parameters
        ----------
        chosen
            The runs of each entry.
        """
        runs = runs_of(self.tables, self.rig.oscillator, self.channels, chosen)
        return math.fsum(duration_rows(runs, self.rig))


def read_design(path: Path) -> DesignFile:
    """Read a design and the rig that it names.

    Raises
    ------
    ConfigurationError
        If a file cannot be read, or for all that is wrong in both: keys, types, runs that the rig
        does not have, targets that name no coefficient or are none, and a grid of which the rig
        can make no run.
    """
    original = read_toml(path)
    design_table: dict[str, Any] = {
        key: original[key] for key in _OWN if key in original and key != "grid"
    }
    plan_table = {key: value for key, value in original.items() if key not in _OWN}
    grid, places = _grid_entries(original.get("grid"))
    fixed = plan_table.get("runs", [])
    count = len(fixed) if isinstance(fixed, list) else 0
    full_table = {**plan_table, "runs": [*fixed, *grid] if isinstance(fixed, list) else fixed}
    reading = examine_plan(full_table, path)
    faults = [_placed(fault, count, places) for fault in reading.faults]
    if not grid:
        faults.append(Fault(("grid",), "is missing; add a table [[grid]] of runs to choose from"))
    faults += limit_faults(design_table)
    tables = validate(DesignTables, design_table, faults)
    rig = reading.rig.rig
    if faults or tables is None or rig is None or reading.tables is None:
        errors = [as_error(path, faults, original)] if faults else []
        errors += [reading.rig.error] if reading.rig.error is not None else []
        raise ConfigurationError("\n".join(map(str, errors)))
    return _design(path, plan_table, reading, rig, reading.tables, tables, count, original)


def _grid_entries(entries: Any) -> tuple[list[dict[str, Any]], list[int]]:
    """Return a table for each number of periods, and of which entry of the grid each is."""
    tables: list[dict[str, Any]] = []
    places: list[int] = []
    for number, entry in enumerate(entries if isinstance(entries, list) else []):
        periods = entry.get("periods") if isinstance(entry, dict) else None
        for period_count in periods if isinstance(periods, list) else [periods]:
            table = deepcopy(entry)
            tables.append(table | ({} if period_count is None else {"periods": period_count}))
            places.append(number)
    return tables, places


def _placed(fault: Fault, fixed: int, places: list[int]) -> Fault:
    """Return a fault where the design's file has it: an entry behind the fixed is the grid's."""
    place = fault.place
    if len(place) > 1 and place[0] == "runs" and isinstance(place[1], int) and place[1] >= fixed:
        return Fault(("grid", places[place[1] - fixed], *place[2:]), fault.message)
    return fault


def _design(
    path: Path,
    plan_table: dict[str, Any],
    reading: PlanReading,
    rig: RigFile,
    plan: PlanTables,
    tables: DesignTables,
    fixed_entries: int,
    original: dict[str, Any],
) -> DesignFile:
    entries = plan.runs
    fixed_plan = replace(plan, runs=entries[:fixed_entries])
    fixed = runs_of(fixed_plan, rig.oscillator, reading.channels)
    candidates = [
        pair
        for entry in entries[fixed_entries:]
        for pair in _singles(entry, plan.defaults, rig, reading.channels)
    ]
    faults = [*grid_faults([run for _, run in candidates]), *_limit_faults(tables.limits)]
    belief = _belief(tables, rig, faults)
    grid = grid_of(candidates, rig, tables.limits, between_s(fixed_plan, rig, reading.channels))
    if candidates and not grid.runs:
        reasons = ", ".join(f"{reason} ({count})" for reason, count in grid.left_out.items())
        faults.append(Fault(("grid",), f"has no run that may be made; left out for: {reasons}"))
    targets: tuple[DesignTarget, ...] = ()
    if belief is not None and not faults:
        points = [run.set_point for run in grid.runs]
        targets = targets_of(tables.targets, belief, points, faults)
    hours = tables.limits.time_h
    faults += _gap_faults(tables.gap)
    if not targets and hours is None and tables.gap is None and not faults:
        faults.append(Fault(("targets",), "are missing, and so is limits.time_h; give either"))
    if faults or belief is None:
        raise as_error(path, faults, original)
    uncounted = uncounted_runs(fixed, usual_rate_hz(grid.runs))
    made_runs = tuple(
        CandidateRun(run.set_point, run.periods, np.inf)
        for run in fixed
        if oscillates_in_water(run) and run.name not in uncounted
    )
    return DesignFile(
        plan.name or path.resolve().parent.name, path, plan_table, reading.rig_path, rig,
        tuple(reading.channels), fixed_plan, fixed, made_runs, grid, belief, _noise(tables, rig),
        _stated(tables, rig), targets, np.inf if hours is None else 3600.0 * hours, gap=tables.gap,
        uncounted=uncounted,
    )  # fmt: skip


def _singles(
    entry: PlanEntry, defaults: Defaults, rig: RigFile, channels: Sequence[str]
) -> Iterator[tuple[PlanEntry, RunPlan]]:
    """Return each run of an entry of the grid, with the entry that makes it alone."""
    runs = expand(entry, defaults, rig.oscillator, channels, all_of)
    return zip(single_entries(entry, defaults), runs, strict=True)


def _limit_faults(limits: DesignLimits) -> Iterator[Fault]:
    for key, value in vars(limits).items():
        if value is not None and not value > 0.0 and key != "advised":
            yield Fault(("limits", key), f"= {value:g} should be above 0")


def _gap_faults(gap: GapTable | None) -> Iterator[Fault]:
    if gap is not None and not 0.0 < gap.least_log_odds <= 20.0:
        yield Fault(("gap", "least_log_odds"), f"= {gap.least_log_odds:g} should be in (0, 20]")
    if gap is not None and not 1 <= gap.batch <= 5:
        yield Fault(("gap", "batch"), f"= {gap.batch} should be from 1 to 5")


def _belief(tables: DesignTables, rig: RigFile, faults: list[Fault]) -> Belief | None:
    """Return what is believed; faults are noted."""
    plane = rig.oscillator.plane
    if rig.model is None:
        faults.append(Fault((), "needs the model's mass and inertia: [model] of the rig's file"))
        return None
    values = dict(tables.believed)
    if not values and rig.hull is not None:
        kinds = (rig.hull.damping, rig.hull.added_mass)
        values = {
            name_of(place, plane, Form.MANOEUVRING): -kinds[place.inertial][place.row][place.column]
            for place in PLACES
        }
    if not values:
        faults.append(Fault(("believed",), "is missing, and the rig's file has no [hull]"))
        return None
    form = Form.SEAKEEPING if all(name[0] in "ab" for name in values) else Form.MANOEUVRING
    restoring = np.zeros((2, 2)) if rig.hull is None else np.array(rig.hull.restoring)
    belief = Belief(rig.oscillator, rig.model, values, form, restoring)
    try:
        surge = [n for n, term in zip(values, belief.terms, strict=True) if term.row == SURGE]
    except ConfigurationError as error:
        faults.append(Fault(("believed",), f"holds {error}"))
        return None
    if surge:
        text = f"holds {', '.join(surge)}; runs are chosen for force and moment, not for X"
        faults.append(Fault(("believed",), text))
    return belief


def _noise(tables: DesignTables, rig: RigFile) -> Noise:
    noise = tables.noise
    rate_hz = rig.sample_rate_hz if noise.sample_rate_hz is None else noise.sample_rate_hz
    return Noise(
        noise.force_n, rate_hz, noise.displacement_m, noise.corner_hz, noise.repeat_relative
    )


def _stated(tables: DesignTables, rig: RigFile) -> StatedUncertainties:
    """Return what is stated; where it says nothing, what the rig's file knows."""
    model = take_uncertainty(dict(rig.campaign), [])
    uncertainties = [StatedUncertainties()]
    uncertainties += [] if model is None else [of_model(model)]
    uncertainties += [] if rig.calibration is None else [of_gauges(rig.calibration)]
    by_file, stated = largest(uncertainties), tables.stated
    vector = np.where(stated.vector == 0.0, by_file.vector, stated.vector)
    freedom = (stated if stated.inertia_kg_m2 else by_file).inertia_degrees_of_freedom
    values = dict(zip(STATED, vector.tolist(), strict=True))
    return StatedUncertainties(**values, inertia_degrees_of_freedom=freedom)
