"""The order of runs, and what comes between them: control conditions, zero runs, prompts."""

import random
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint
from pmm.plan.expansion import all_of, expand, snake
from pmm.plan.plan_tables import OrderTable, PlanEntry, PlanTables, Scheme, ZeroTable
from pmm.plan.run_plan import RunPlan

_ORDERED = (RunKind.OSCILLATION, *(kind for kind in RunKind if kind.towed))


def runs_of(
    tables: PlanTables,
    oscillator: Oscillator,
    channels: Sequence[str],
    further_entries: Sequence[Sequence[RunPlan]] = (),
) -> tuple[RunPlan, ...]:
    """Return all runs of a plan in the order in which they are made.

    Parameters
    ----------
    channels
        The rig's force channels, for loads on all of them.
    further_entries
        The runs of entries behind those of the tables.
    """

    def expanded(entry: PlanEntry) -> list[RunPlan]:
        turns = tables.order.scheme is Scheme.SNAKE and entry.kind in _ORDERED
        combine = snake if turns else all_of
        return expand(entry, tables.defaults, oscillator, channels, combine)

    entries = [*map(expanded, tables.runs), *further_entries]
    runs = in_order(entries, tables.order)
    if tables.control is not None:
        control = expanded(tables.control.entry())[0]
        runs = with_control(runs, control, tables.control.every)
    if tables.zero is not None:
        runs = with_zeros(runs, tables.zero)
    return tuple(with_prompts(run) for run in runs)


def in_order(entries: Sequence[Sequence[RunPlan]], order: OrderTable) -> list[RunPlan]:
    """Return the runs of all entries; neighbouring oscillations and tows in the random order.

    Calibrations, dry runs and the like keep their place.
    """
    chance = random.Random(order.seed)  # noqa: S311  # an order, not a secret
    runs: list[RunPlan] = []
    for ordered, block in groupby(entries, lambda entry: bool(entry) and entry[0].kind in _ORDERED):
        parts = [list(entry) for entry in block]
        if ordered and order.scheme is Scheme.RANDOM:
            if order.across_entries:
                parts = [[run for part in parts for run in part]]
            for part in parts:
                chance.shuffle(part)
        runs += [run for part in parts for run in part]
    return runs


def with_control(runs: Sequence[RunPlan], control: RunPlan, interval: int) -> list[RunPlan]:
    """Repeat the control condition before, after every so many, and after the last oscillation."""
    total = sum(run.kind is RunKind.OSCILLATION for run in runs)
    result: list[RunPlan] = []
    count = repeats = 0

    def repeat() -> None:
        nonlocal repeats
        repeats += 1
        result.append(replace(control, name=f"{control.name}-{repeats:02d}", repeat=repeats))

    for run in runs:
        if run.kind is not RunKind.OSCILLATION:
            result.append(run)
            continue
        if count == 0:
            repeat()
        result.append(run)
        count += 1
        if count % interval == 0 or count == total:
            repeat()
    return result


def with_zeros(runs: Sequence[RunPlan], zero: ZeroTable) -> list[RunPlan]:
    """Put zero runs before, between and after runs that want them, anew where the medium changes.

    The pause for calm water goes before the zero run; the run behind it follows at once.
    """
    result: list[RunPlan] = []
    count = 0
    for (wanted, *_), group in groupby(runs, _zero_group):
        part = list(group)
        if not wanted:
            result += part
            continue
        for first in range(0, len(part), zero.every):
            count += 1
            before, after = f"zero-{count:02d}", f"zero-{count + 1:02d}"
            some = part[first : first + zero.every]
            result.append(_zero_run(before, some[0], zero, some[0].prompts))
            result.append(replace(some[0], pause_before_s=0.0, prompts=()))
            result += some[1:]
            linked = len(some)
            result[-linked:] = [
                replace(run, zero_before=before, zero_after=after) for run in result[-linked:]
            ]
        count += 1
        result.append(_zero_run(f"zero-{count:02d}", part[-1], zero, ()))
    return result


def _zero_group(run: RunPlan) -> tuple[Any, ...]:
    return run.kind.wants_zeros, run.set_point.medium, run.known_mass, run.set_point.heel_rad


def _zero_run(name: str, like: RunPlan, zero: ZeroTable, prompts: tuple[str, ...]) -> RunPlan:
    """Return a record at rest with the settings of the run that it stands beside."""
    point = like.set_point
    return RunPlan(
        name=name,
        kind=RunKind.ZERO,
        motion=Motion.NONE,
        set_point=SetPoint(
            0.0,
            point.eccentricity_m,
            point.strut_phase_rad,
            medium=point.medium,
            drift_rad=point.drift_rad,
            heel_rad=point.heel_rad,
        ),
        duration_s=zero.duration_s,
        pause_before_s=like.pause_before_s,
        known_mass=like.known_mass,
        prompts=prompts,
        entry="zero",
    )


def with_prompts(run: RunPlan) -> RunPlan:
    """Tell the operator what to do by hand while a push or a pluck is recorded.

    What the settings of a run say by themselves (medium, drift, loads, masses, speed) is asked for
    where the run is made.
    """
    if run.kind is RunKind.PLUCK:
        text = "when the record runs, pluck the model once and let it ring down"
    elif run.kind is RunKind.PUSH and run.load is not None:
        text = (
            f"when the record runs, push at the strut of {run.load.channel} along its positive "
            f"direction with about {run.load.force_n:g} N, and let go"
        )
    else:
        return run
    return replace(run, prompts=(text, *run.prompts))
