"""The walk along the chain against effects that were put in at a known stage of it."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.locate.measured_input import (
    MEASURED_MOTION,
    MEASURED_SHAFT,
    FedRemainder,
    fed_remainder,
)
from analysis.gap.locate.walk import (
    FORCE_BY_SHAFT,
    FORCE_FED,
    MOTION,
    MOTION_FED,
    SHAFT,
    Walk,
    walk,
)
from analysis.gap.observe.components import GapRun, Part
from hardware.description.channels import DISPLACEMENTS, FORCES, SHAFT_ANGLE
from hardware.description.motor import ShuntMotor
from sim.acquisition.amplifier import LowPass
from sim.acquisition.channels import Digitiser
from sim.drive.prescribed_drive import DriveSettings
from sim.effects.catalogue import build
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, problem_of, record

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
    return {one.step: one.is_beyond_noise for one in found.steps}


def strained(found: Walk, what: str) -> Mapping[str, float]:
    (step,) = (one for one in found.steps if one.step == what)
    return step.strained


def acquits(found: Walk, what: str) -> bool:
    """Tell whether a step that was fed a measured input has no gap, and would show one."""
    (step,) = (one for one in found.steps if one.step == what)
    return step.tells and not step.is_beyond_noise


@pytest.mark.slow
def test_a_ripple_of_the_shaft_goes_where_the_measured_shaft_is_fed(rig: SimulatedRig) -> None:
    found = walked(rig, RIPPLE)
    seen = beyond(found)
    assert "ripple 1 sine" in strained(found, SHAFT)
    assert not strained(found, MOTION)  # the same ripple: said once, where it comes in
    assert acquits(found, MOTION_FED)
    assert not seen[FORCE_FED]
    assert FORCE_BY_SHAFT not in seen


@pytest.mark.slow
def test_a_rod_in_place_of_a_yoke_stays_where_the_measured_shaft_is_fed(
    rig: SimulatedRig,
) -> None:
    found = walked(rig, "connecting-rod")
    seen = beyond(found)
    assert not seen[SHAFT]
    assert seen[MOTION_FED]
    assert not seen[FORCE_FED]


@pytest.mark.slow
def test_without_struts_sensors_the_measured_shaft_is_fed_to_the_forces(rig: SimulatedRig) -> None:
    ripple = walked(rig, RIPPLE, DISPLACEMENTS)
    assert strained(ripple, SHAFT)
    assert acquits(ripple, FORCE_BY_SHAFT)
    friction = walked(rig, "coulomb-friction:friction_n=0.3", DISPLACEMENTS)
    assert beyond(friction)[FORCE_BY_SHAFT]


@pytest.mark.slow
def test_without_an_encoder_nothing_stands_for_the_shaft(rig: SimulatedRig) -> None:
    found = walked(rig, RIPPLE, (SHAFT_ANGLE.name,))
    assert not {SHAFT, MOTION_FED, FORCE_BY_SHAFT} & beyond(found).keys()
    assert beyond(found)[MOTION] or strained(found, MOTION)


@pytest.mark.slow
def test_a_motor_that_feels_its_load_is_walked_too(rig: SimulatedRig) -> None:
    """What the shaft really did is fed: whether the motor is believed right does not matter."""
    weak = replace(rig, drive=DriveSettings(motor=ShuntMotor()))
    runs = record(weak, (), 42)
    for believed in (rig, weak):
        seen = beyond(walk(problem_of(believed, runs)))
        assert not seen[MOTION_FED]
        assert not seen[FORCE_FED]


def rms_of(found: FedRemainder) -> tuple[float, float]:
    """Return what is left with the measured input, and with the simulated one."""
    return tuple(
        float(np.sqrt(np.mean(one[found.rows] ** 2)))
        for one in (found.remainder, found.simulated_remainder)
    )


@pytest.mark.slow
def test_the_measured_frequency_takes_the_place_of_the_one_that_was_set(rig: SimulatedRig) -> None:
    """With no number free: inertia goes with the square of the frequency, stiffness does not."""
    runs = record(rig, [build("frequency-error:relative=0.004")], 43)
    whole = problem_of(rig, runs)
    fixed = replace(whole, nuisances=Nuisances(np.zeros((len(whole.residual), 0))))
    components = whole.simulator.stack.components
    parts = (Part.IN_PHASE, Part.QUADRATURE)
    forces = np.array([one.channel in FORCES and one.part in parts for one in components])
    found = fed_remainder(fixed, MEASURED_SHAFT, forces)
    assert found is not None
    left, unfed = rms_of(found)
    assert left < 1.5
    assert unfed > 10.0


@pytest.mark.sample(1)
@pytest.mark.parametrize("ripple", ["relative=0.03,phase_rad=1.57", "relative=0.01,order=2"])
def test_a_large_ripple_is_the_drives_wherever_it_puts_the_pulse(
    rig: SimulatedRig, ripple: str
) -> None:
    found = walked(rig, f"speed-ripple:{ripple}")
    assert strained(found, SHAFT) or beyond(found)[SHAFT]
    assert acquits(found, MOTION_FED)


@pytest.mark.slow
def test_a_force_as_phase_reference_is_that_of_the_fed_chain(rig: SimulatedRig) -> None:
    lines = replace(rig.acquisition, displacement_aft=None, displacement_fore=None)
    blind = replace(rig, photocell=None, acquisition=lines)
    points = [one for one in POINTS if not one.strut_phase_rad]
    runs = record(blind, [build(RIPPLE)], 44, points, FORCES[0])
    found = walk(problem_of(blind, runs, FORCES[0]))
    assert strained(found, SHAFT)
    assert not beyond(found)[FORCE_BY_SHAFT]


@pytest.mark.slow
def test_what_is_fed_is_what_the_channel_measures(rig: SimulatedRig) -> None:
    """A rig as it is believed has no gap, whatever is known of its displacement channels."""
    slow = Digitiser(noise_rms=5e-6, offset=1e-3, gain=1.01, low_pass=LowPass(10.0))
    lines = replace(rig.acquisition, displacement_aft=slow, displacement_fore=slow)
    known = replace(rig, acquisition=lines)
    seen = beyond(walk(problem_of(known, record(known, (), 45))))
    assert not seen[MOTION_FED]
    assert not seen[FORCE_FED]


@pytest.mark.slow
def test_a_run_without_a_channel_is_not_fed_with_nothing(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    (first,) = without(clean[:1], DISPLACEMENTS[1:])
    problem = problem_of(rig, (first, *clean[1:]))
    rows = np.array([one.channel in FORCES for one in problem.simulator.stack.components])
    found = fed_remainder(problem, MEASURED_MOTION, rows)
    assert found is not None
    assert not found.rows[problem.simulator.stack.run == 0].any()
    assert not beyond(walk(problem))[FORCE_FED]


@pytest.mark.slow
def test_nothing_is_acquitted_where_the_shafts_own_noise_would_hide_it(rig: SimulatedRig) -> None:
    """A long rod shows in the motion, but less than an encoder's steps make of it."""
    lines = replace(rig.acquisition, shaft_angle=Digitiser(resolution=2.0 * np.pi / 2**10))
    coarse = replace(rig, acquisition=lines)
    runs = record(coarse, [build("connecting-rod:rod_length_m=20.0")], 46)
    steps = {one.step: one for one in walk(problem_of(coarse, runs)).steps}
    assert steps[MOTION].is_beyond_noise
    assert not steps[MOTION_FED].is_beyond_noise
    assert not steps[MOTION_FED].tells
