"""The walk along the chain against effects that were put in at a known stage of it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from analysis.gap.components import GapRun, Part
from analysis.gap.fed import MEASURED_SHAFT, fed
from analysis.gap.observe import FORCES, STRUTS
from analysis.gap.where import (
    FORCE,
    FORCE_BY_SHAFT,
    FORCE_FED,
    MOTION,
    MOTION_FED,
    SHAFT,
    Walk,
    walk,
)
from hardware.description.channels import SHAFT_ANGLE
from sim.drive import DriveSettings
from sim.effects.catalogue import build
from sim.effects.effect import StageName
from sim.motor import ShuntMotor
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of, record

RIPPLE = "speed-ripple:relative=0.01"


def without(runs: Sequence[GapRun], channels: Sequence[str]) -> tuple[GapRun, ...]:
    """Return runs whose rig does not have some sensors."""
    left = []
    for run in runs:
        seen = run.observed
        kept = [at for at, one in enumerate(seen.components) if one.channel not in channels]
        parts = tuple(seen.components[at] for at in kept)
        quiet = {name: lines for name, lines in seen.quiet.items() if name not in channels}
        fewer = replace(
            seen,
            components=parts,
            values=seen.values[kept],
            uncertainty=seen.uncertainty[kept],
            quiet=quiet,
        )
        left.append(replace(run, observed=fewer))
    return tuple(left)


def walked(rig: SimulatedRig, put_in: str, missing: Sequence[str] = ()) -> Walk:
    runs = record(rig, [build(put_in)], 41)
    return walk(problem_of(rig, without(runs, missing)))


def beyond(found: Walk) -> Mapping[str, bool]:
    return {one.what: one.beyond for one in found.steps}


def test_a_ripple_of_the_shaft_goes_where_the_measured_shaft_is_fed(rig: SimulatedRig) -> None:
    found = walked(rig, RIPPLE)
    seen = beyond(found)
    assert seen[SHAFT]
    assert seen[MOTION]
    assert seen[FORCE]
    assert not seen[MOTION_FED]
    assert not seen[FORCE_FED]
    assert FORCE_BY_SHAFT not in seen
    assert found.stages == (StageName.DRIVE,)


def test_a_rod_in_place_of_a_yoke_stays_where_the_measured_shaft_is_fed(
    rig: SimulatedRig,
) -> None:
    found = walked(rig, "connecting-rod")
    seen = beyond(found)
    assert not seen[SHAFT]
    assert seen[MOTION_FED]
    assert not seen[FORCE_FED]
    assert StageName.MECHANISM in found.stages


def test_without_struts_sensors_the_measured_shaft_is_fed_to_the_forces(rig: SimulatedRig) -> None:
    ripple = walked(rig, RIPPLE, STRUTS)
    assert beyond(ripple)[FORCE]
    assert not beyond(ripple)[FORCE_BY_SHAFT]
    assert ripple.stages == (StageName.DRIVE,)
    friction = walked(rig, "coulomb-friction:friction_n=0.3", STRUTS)
    assert beyond(friction)[FORCE_BY_SHAFT]
    assert StageName.STRUCTURE in friction.stages


def test_without_an_encoder_nothing_stands_for_the_shaft(rig: SimulatedRig) -> None:
    found = walked(rig, RIPPLE, (SHAFT_ANGLE.name,))
    assert not {SHAFT, MOTION_FED, FORCE_BY_SHAFT} & beyond(found).keys()
    assert {StageName.DRIVE, StageName.MECHANISM} <= {*found.stages}


def test_a_motor_that_feels_its_load_is_walked_too(rig: SimulatedRig) -> None:
    """What the shaft really did is fed: whether the motor is believed right does not matter."""
    weak = replace(rig, drive=DriveSettings(motor=ShuntMotor()))
    runs = record(weak, (), 42)
    for believed in (rig, weak):
        seen = beyond(walk(problem_of(believed, runs)))
        assert not seen[MOTION_FED]
        assert not seen[FORCE_FED]


def test_the_measured_frequency_takes_the_place_of_the_one_that_was_set(rig: SimulatedRig) -> None:
    """Twice as much off as its tolerance: inertia goes with its square, stiffness does not."""
    runs = record(rig, [build("frequency-error:relative=0.004")], 43)
    problem = problem_of(rig, runs)
    stack = problem.simulator.stack
    parts = (Part.IN_PHASE, Part.QUADRATURE)
    rows = np.array([one.channel in FORCES and one.part in parts for one in stack.components])
    left = fed(problem, MEASURED_SHAFT, rows)
    assert left is not None
    assert np.sqrt(np.mean(left[rows] ** 2)) < 1.3
    assert not left[~rows].any()
