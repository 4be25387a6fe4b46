"""The order of runs, and what comes between them: control conditions, zero runs, prompts."""

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.plan.expansion import all_of, expand, snake
from pmm.plan.kinds import Motion, RunKind
from pmm.plan.plan_tables import Entry, Order, PlanTables, Scheme, Zero
from pmm.plan.run_plan import LoadDirection, RunPlan

_ORDERED = (RunKind.OSCILLATION, RunKind.STATIC_DRIFT, RunKind.STRAIGHT_TOW)


def runs_of(
    tables: PlanTables, oscillator: Oscillator, channels: Sequence[str]
) -> tuple[RunPlan, ...]:
    """Return all runs of a plan in the order in which they are made."""

    def made(entry: Entry) -> list[RunPlan]:
        turns = tables.order.scheme is Scheme.SNAKE and entry.kind in _ORDERED
        combine = snake if turns else all_of
        return expand(entry, tables.defaults, oscillator, channels, combine)

    runs = in_order([made(one) for one in tables.runs], tables.order)
    if tables.control is not None:
        control = made(tables.control.entry())[0]
        runs = with_control(runs, control, tables.control.every)
    if tables.zero is not None:
        runs = with_zeros(runs, tables.zero)
    return tuple(with_prompts(runs))


def in_order(entries: Sequence[Sequence[RunPlan]], order: Order) -> list[RunPlan]:
    """Return the runs of all entries; neighbouring oscillations and tows in the random order.

    Calibrations, dry runs and the like keep their place.
    """
    chance = random.Random(order.seed)  # noqa: S311  # an order, not a secret
    runs: list[RunPlan] = []
    for ordered, block in groupby(entries, lambda one: bool(one) and one[0].kind in _ORDERED):
        parts = [list(one) for one in block]
        if ordered and order.scheme is Scheme.RANDOM:
            if order.across_entries:
                parts = [[run for part in parts for run in part]]
            for part in parts:
                chance.shuffle(part)
        runs += [run for part in parts for run in part]
    return runs


def with_control(runs: Sequence[RunPlan], control: RunPlan, every: int) -> list[RunPlan]:
    """Repeat the control condition before, after every so many, and after the last oscillation."""
    total = sum(one.kind is RunKind.OSCILLATION for one in runs)
    result: list[RunPlan] = []
    done = repeats = 0

    def repeat() -> None:
        nonlocal repeats
        repeats += 1
        result.append(replace(control, name=f"{control.name}-{repeats:02d}", repeat=repeats))

    for one in runs:
        if one.kind is not RunKind.OSCILLATION:
            result.append(one)
            continue
        if done == 0:
            repeat()
        result.append(one)
        done += 1
        if done % every == 0 or done == total:
            repeat()
    return result


def with_zeros(runs: Sequence[RunPlan], zero: Zero) -> list[RunPlan]:
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
                replace(one, zero_before=before, zero_after=after) for one in result[-linked:]
            ]
        count += 1
        result.append(_zero_run(f"zero-{count:02d}", part[-1], zero, ()))
    return result


def _zero_group(run: RunPlan) -> tuple[Any, ...]:
    return run.kind.wants_zeros, run.set_point.medium, run.known_mass


def _zero_run(name: str, like: RunPlan, zero: Zero, prompts: tuple[str, ...]) -> RunPlan:
    """Return a record at rest with the settings of the run that it stands beside."""
    point = like.set_point
    return RunPlan(
        name=name,
        kind=RunKind.ZERO,
        motion=Motion.NONE,
        set_point=SetPoint(0.0, point.eccentricity_m, point.strut_phase_rad, 0.0, point.medium),
        drift_rad=like.drift_rad,
        duration_s=zero.duration_s,
        pause_before_s=like.pause_before_s,
        known_mass=like.known_mass,
        prompts=prompts,
        entry="zero",
    )


def with_prompts(runs: Sequence[RunPlan]) -> Iterator[RunPlan]:
    """Tell the operator before each run what has changed since the one before.

    A campaign begins with the model in water, without drift, load or added mass.
    """
    before: RunPlan | None = None
    for one in runs:
        yield replace(one, prompts=(*_changes(before, one), *one.prompts))
        before = one


def _changes(before: RunPlan | None, run: RunPlan) -> Iterator[str]:
    medium = Medium.WATER if before is None else before.set_point.medium
    if run.set_point.medium is not medium:
        in_air = run.set_point.medium is Medium.AIR
        yield "hang the model in air" if in_air else "put the model into the water, at its draught"
    mass = None if before is None else before.known_mass
    if run.known_mass != mass:
        yield _mass_prompt(run)
    drift = 0.0 if before is None else before.drift_rad
    if run.drift_rad != drift:
        angle = math.degrees(run.drift_rad)
        yield f"turn the model to a drift of {angle:g} degrees, bow to starboard positive"
    yield from _unload_prompt(before, run)
    yield from _load_prompt(run)


def _mass_prompt(run: RunPlan) -> str:
    mass = run.known_mass
    if mass is None:
        return "take the known mass off the model"
    return f"fix {mass.mass_kg:g} kg to the model, {mass.x_m:g} m ahead of the midpoint"


def _unload_prompt(before: RunPlan | None, run: RunPlan) -> Iterator[str]:
    """Weights that hang on another gauge, or hang still when none are wanted, go first."""
    if before is None or before.kind is not RunKind.CHECK_WEIGHT or before.load is None:
        return
    same = run.load is not None and run.load.channel == before.load.channel
    if before.load.force_n and not (same and run.kind is RunKind.CHECK_WEIGHT):
        yield f"take all weights off {before.load.channel}"


def _load_prompt(run: RunPlan) -> Iterator[str]:
    load = run.load
    if run.kind is RunKind.PLUCK:
        yield "when the record runs, pluck the model once and let it ring down"
    elif run.kind is RunKind.PUSH and load is not None:
        yield (
            f"when the record runs, push at the strut of {load.channel} along its positive "
            f"direction with about {load.force_n:g} N, and let go"
        )
    elif load is not None and load.force_n == 0.0:
        yield f"let {load.channel} hang without weights"
    elif load is not None:
        way = "" if load.direction is LoadDirection.UP else ", taking weights off"
        yield f"load {load.channel} with {load.force_n:g} N{way}; wait until it hangs still"
