"""The speed loop of a rig's shaft: as stated, as a test finds it, and as it could be set."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.speed_loop.identification import IdentifiedLoop, SpeedRecord, identified
from analysis.speed_loop.loop import ShaftLoop
from analysis.speed_loop.tuning import LARGEST_SENSITIVITY, proposed
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Servo
from pmm.plan.motion_peaks import omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.plan.shaft_load import ShaftLoad, motor_of, shaft_load


@dataclass(frozen=True)
class LoopSetting:
    """A setting of the loop, by its name: ``"stated"``, ``"found"``, ``"proposed"``."""

    name: str
    loop: ShaftLoop


@dataclass(frozen=True)
class RunRipple:
    """How a planned run's speed would vary over a turn: largest part of each setting, in order."""

    run: str
    relative: tuple[float, ...]


@dataclass(frozen=True)
class Tuning:
    """All that is told.

    Attributes
    ----------
    settings
        The present gains first, the proposed ones last.
    record, identified_loop
        Of the test on the rig; ``None`` where only the stated data were looked at.
    ripples
        Of a plan's runs.
    level
        Probability of the intervals.
    """

    settings: tuple[LoopSetting, ...]
    unit: str
    record: SpeedRecord | None = None
    identified_loop: IdentifiedLoop | None = None
    ripples: Sequence[RunRipple] = ()
    level: float = 0.95


def stated_loop(rig: RigFile, delay_s: float) -> ShaftLoop:
    """Return the loop as the rig's file states it.

    Raises
    ------
    ConfigurationError
        If it states no motor.
    """
    motor = motor_of(rig)
    if motor is None:
        raise ConfigurationError(
            f"{rig.path}: has no [campaign.drive.motor], so nothing is known of what turns the "
            "shaft; state its data as in docs/devices.md"
        )
    return ShaftLoop(motor, motor.loop, delay_s=delay_s)


def tuned(
    rig: RigFile,
    stated: ShaftLoop,
    record: SpeedRecord | None,
    sensitivity: float | None,
    runs: Sequence[RunPlan],
) -> Tuning:
    """Return what is told of the loop.

    Parameters
    ----------
    stated
        The loop as the rig's file states it.
    record
        Of the test on the rig; without it the stated data are all there is.
    sensitivity
        How near to instability the proposal may come.
    runs
        Whose loads the loop is to stand: their inertia counts for the proposal.

    Raises
    ------
    ConfigurationError
        If the record tells no loop, or no gains keep the margins.
    """
    identified_loop: IdentifiedLoop | None = None
    loops = {"stated": stated}
    if record is not None:
        identified_loop = identified(record, stated.motor, stated.delay_s)
        loops["found"] = identified_loop.loop
    last_loop = list(loops.values())[-1]
    loads = {run.name: (run, load) for run in runs if (load := shaft_load(run, rig, stated.motor))}
    added = [0.0, *(load.added_inertia_kg_m2 for _, load in loads.values())]
    ends = sorted(
        {last_loop.added_inertia_kg_m2 + min(added), last_loop.added_inertia_kg_m2 + max(added)}
    )
    most = LARGEST_SENSITIVITY if sensitivity is None else sensitivity
    best = proposed(last_loop.motor, ends, stated.delay_s, most)
    loops["proposed"] = ShaftLoop(
        last_loop.motor, best, last_loop.added_inertia_kg_m2, stated.delay_s
    )
    ripples = [
        RunRipple(name, tuple(_ripple(loop, load, run) for loop in loops.values()))
        for name, (run, load) in loads.items()
    ]
    named = tuple(LoopSetting(name, loop) for name, loop in loops.items())
    unit = "A s/rad and A/rad" if isinstance(stated.motor, Servo) else "V s/rad and V/rad"
    return Tuning(named, unit, record, identified_loop, ripples)


def _ripple(loop: ShaftLoop, load: ShaftLoad, run: RunPlan) -> float:
    """Return the largest part of a run's speed ripple, relative to its speed."""
    inertia = loop.added_inertia_kg_m2 + load.added_inertia_kg_m2
    laden = ShaftLoop(loop.motor, loop.controller, inertia, loop.delay_s)
    return float(np.abs(laden.ripple(load.torques_n_m, omega_of(run))).max())
