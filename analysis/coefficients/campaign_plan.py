"""Which runs of a campaign are solved together, and what is refused before anything is solved."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Final

from analysis.coefficients.alike import classes, frequency_classes, speed_classes
from analysis.coefficients.body_cycle import DRY_TAKEN_OFF, BodyCycle
from analysis.coefficients.cycle_checks import named_twice, other_geometry
from analysis.coefficients.identifiability import fundamental_velocities, identifiable_motions
from analysis.coefficients.line_cycles import names_of_lines
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.errors import ConfigurationError
from hardware.description.heel import RollConstraint
from hardware.description.setpoint import Medium

_SAME_AMPLITUDE = 2e-2
OWN_MODEL: Final = "own_model"  # flag of a run that was made with another model than the rest


@dataclass(frozen=True)
class Request:
    """Which coefficients of a campaign are asked for, and how they are to be determined.

    Attributes
    ----------
    wanted
        Coefficients that have to be determined; an error names the first that is not.
    level
        Of all intervals.
    trials, seed
        Of the Monte Carlo beside the linear budget; none by default.
    nonlinear
        Whether non-linear terms are sought where the runs have several amplitudes or drift.
    zero_frequency
        Whether coefficients are extrapolated to zero frequency.
    """

    form: Form = Form.MANOEUVRING
    stated: StatedUncertainties = field(default_factory=StatedUncertainties)
    wanted: tuple[str, ...] = ()
    level: float = 0.95
    trials: int = 0
    seed: int = 0
    nonlinear: bool = True
    zero_frequency: bool = True


class GroupKind(StrEnum):
    """The form of the equations by which a group of runs is solved."""

    LINEAR = "linear"
    NONLINEAR = "nonlinear"
    STATIC = "static"


@dataclass(frozen=True, eq=False)
class Group:
    """Runs of one speed or frequency that are solved together.

    Attributes
    ----------
    speed_m_s
        The median of all runs that count as one speed: what they tell stands at that.
    frequency_hz
        The same of the frequency; 0 of static runs, NaN where several are solved together.
    """

    kind: GroupKind
    cycles: tuple[BodyCycle, ...]
    speed_m_s: float
    frequency_hz: float


def check_campaign(cycles: Sequence[BodyCycle]) -> None:
    """Refuse a campaign whose runs cannot be of one rig and model.

    Raises
    ------
    ConfigurationError
        Naming all faults: names twice, inconsistent geometry, missing inertia, values that are not
        finite.
    """
    faults = named_twice(cycles)
    for cycle in cycles:
        faults += [*_other_rig(cycle, cycles[0]), *_missing_data(cycle)]
    faults += _other_bodies(cycles)
    if faults:
        raise ConfigurationError("the campaign cannot be solved: " + "; ".join(faults))


def _other_rig(cycle: BodyCycle, first: BodyCycle) -> Iterator[str]:
    if cycle.plane is not first.plane:
        yield f"{cycle.name} is {cycle.plane}, {first.name} {first.plane}; solve each plane alone"
    yield from other_geometry(cycle, first)


def _other_bodies(cycles: Sequence[BodyCycle]) -> Iterator[str]:
    """Yield runs with another body than the rest, but for those known to be made with it."""
    bodies = [
        (cycle.name, cycle.body)
        for cycle in cycles
        if cycle.body is not None and all(flag.code != OWN_MODEL for flag in cycle.flags)
    ]
    for name, body in bodies[1:]:
        first, usual = bodies[0]
        if body != usual:
            yield (
                f"{name} takes off another body ({body.mass_kg:g} kg) than {first} "
                f"({usual.mass_kg:g} kg): one campaign has one model"
            )


def _missing_data(cycle: BodyCycle) -> Iterator[str]:
    dry = any(flag.code == DRY_TAKEN_OFF for flag in cycle.flags)
    if cycle.medium is Medium.AIR:
        yield f"{cycle.name} was run in air; take it off as a dry run, or leave it out"
    elif cycle.body is None and cycle.turn_rate_rad_s:
        yield (
            f"{cycle.name} is a circle and has no inertia to take off, which no dry run tells: "
            "give the model's mass, centre of gravity and moment of inertia"
        )
    elif cycle.body is None and not dry and cycle.frequency_hz > 0.0:
        yield (
            f"{cycle.name} has no inertia to take off: give the model's mass, centre of gravity "
            "and moment of inertia (swing or bifilar test), or a dry run at "
            f"{cycle.frequency_hz:g} Hz"
        )
    if not all(math.isfinite(abs(value)) for value in cycle.phasors.values):
        yield f"{cycle.name} has values that are not finite; leave the run out"


def plan(
    cycles: Sequence[BodyCycle], request: Request, line_runs: Sequence[BodyCycle] = ()
) -> tuple[Group, ...]:
    """Return the groups: by speed, frequency and amplitude; all amplitudes together; static runs.

    Linear coefficients come from runs with one amplitude, so that what the amplitude does can be
    seen. Where one amplitude alone tells nothing apart (pitch about the midpoint at forward speed,
    with heave at another amplitude), all amplitudes of that frequency are solved as one.
    Runs of many lines, whole, are one more group of their speed, with the single sines there: the
    lines' products tell what is not linear, and all frequencies share it.

    Parameters
    ----------
    cycles
        Single sines, among them each line by itself, and static runs.
    line_runs
        Runs of many lines.
    """
    groups = []
    every = [*cycles, *(run for run in line_runs if request.nonlinear)]
    for alike, speed in speed_classes(every, lambda run: run.speed_m_s):
        lined = [run for run in alike if run.lines]
        single = [run for run in alike if not run.lines]
        static = [cycle for cycle in single if cycle.frequency_hz == 0.0]
        if static:
            groups.append(Group(GroupKind.STATIC, tuple(static), speed, 0.0))
        moving = [cycle for cycle in single if cycle.frequency_hz > 0.0]
        for together, hz in frequency_classes(moving, lambda run: run.frequency_hz):
            groups += [
                Group(kind, runs, speed, hz) for kind, runs in _by_amplitude(together, request)
            ]
        if lined:
            lines = {name for run in lined for name in names_of_lines(run)}
            sines = [
                cycle for cycle in moving if cycle.name not in lines and not set_heel_of(cycle)
            ]
            groups.append(Group(GroupKind.NONLINEAR, (*lined, *sines), speed, math.nan))
    return tuple(groups)


def _by_amplitude(
    cycles: Sequence[BodyCycle], request: Request
) -> list[tuple[GroupKind, tuple[BodyCycle, ...]]]:
    straight = [cycle for cycle in cycles if cycle.drift_rad == 0.0 and not set_heel_of(cycle)]
    amplitudes = [group for group, _ in classes(straight, strut_amplitude, _SAME_AMPLITUDE)]
    columns = [_determined_motions(group, request.form) for group in amplitudes]
    amplitude_groups = [
        group for group, motions in zip(amplitudes, columns, strict=True) if motions
    ]
    if (
        straight
        and {0, 1} != {column for motions in columns for column in motions}
        and () in columns
    ):
        amplitude_groups.append(tuple(straight))
    groups = [(GroupKind.LINEAR, group) for group in amplitude_groups]
    mixed = len(amplitudes) > 1 or len(straight) < len(cycles)
    if request.nonlinear and mixed:
        groups.append((GroupKind.NONLINEAR, tuple(cycles)))
    return groups


def set_heel_of(cycle: BodyCycle) -> float:
    """Return the heel at which a run's model was fixed; 0 where it is upright or free to roll."""
    fixed = cycle.heel is not None and cycle.heel.held is RollConstraint.SET
    return cycle.heel_rad if fixed else 0.0


def _determined_motions(cycles: Sequence[BodyCycle], form: Form) -> tuple[int, ...]:
    """Which motions' coefficients these runs determine."""
    return identifiable_motions(fundamental_velocities(cycles, form))


def strut_amplitude(cycle: BodyCycle) -> float:
    """Return the larger amplitude of both struts, m."""
    way, arm = cycle.at_struts
    return float(max(abs(way + arm), abs(way - arm)))
