"""What an encoder's steps leave of an even turn, against a turn that is rounded."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.noise import ENCODER_RAD, encoder_floor_rad
from analysis.gap.observe.sensors import as_recorded
from hardware.description.arrays import FloatArray
from sim.acquisition.channels import Digitiser
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of, record

STEP = 1e-4
SAMPLES = 20_000


@pytest.mark.parametrize("dither", [0.0, 0.1, 0.3])
def test_the_largest_line_of_the_rounding_error(dither: float) -> None:
    within = (np.arange(SAMPLES) + 0.5) / SAMPLES  # of a step, seen evenly
    error = (_rounded(within, dither) - within) * STEP
    line = 2.0 * abs(np.mean(error * np.exp(-2j * np.pi * within)))
    floor = encoder_floor_rad(Digitiser(noise_rms=dither * STEP, resolution=STEP))
    assert line == pytest.approx(floor, rel=1e-3)


@pytest.mark.parametrize("dither", [0.2, 0.35, 0.5])
def test_the_noise_is_the_one_that_the_records_hold(dither: float) -> None:
    """Whatever share of it was taken for white: a pole beyond the lines looks like white noise."""
    turn = np.linspace(0.0, 777.3, SAMPLES)  # steps
    noisy = turn + dither * np.random.default_rng(26).standard_normal(SAMPLES)
    recorded = float(np.std(np.round(noisy) - turn)) * STEP
    encoder = Digitiser(noise_rms=0.0, walk_per_sqrt_s=1.0, resolution=STEP)
    true_floor = encoder_floor_rad(Digitiser(noise_rms=dither * STEP, resolution=STEP))
    assert encoder_floor_rad(encoder, recorded) == pytest.approx(true_floor, rel=0.15)
    assert encoder_floor_rad(encoder, STEP / math.sqrt(12.0)) == pytest.approx(STEP / math.pi)


@pytest.mark.parametrize("seed", [2, 13])
def test_a_shaft_is_known_alike_whatever_its_noise_is_taken_for(
    rig: SimulatedRig, seed: int
) -> None:
    """The first seed's flat noise is fitted as white, the second's with a pole beyond the lines."""
    encoder = Digitiser(noise_rms=0.5 * STEP, resolution=STEP)
    believed = replace(rig, acquisition=replace(rig.acquisition, shaft_angle=encoder))
    runs = record(believed, (), seed)
    stack = problem_of(as_recorded(believed, runs, None), runs).simulator.stack
    known = [
        sigma
        for component, sigma in zip(stack.components, stack.uncertainty, strict=True)
        if component.channel == "shaft_angle" and component.order
    ]
    assert 1.5e-6 < np.median(known) < 4e-6


def _rounded(values: FloatArray, dither: float) -> FloatArray:
    """Return what rounding to whole numbers gives on average under normal noise."""
    if not dither:
        return np.round(values)
    passed = [
        0.5 * (1.0 + np.vectorize(math.erf)((values - step - 0.5) / (dither * math.sqrt(2.0))))
        for step in range(-4, 5)
    ]
    return np.sum(passed, axis=0) - 4.0


def test_steps_that_nobody_stated_are_taken_as_usual_ones() -> None:
    assert encoder_floor_rad(None) == ENCODER_RAD
    assert encoder_floor_rad(Digitiser(noise_rms=1e-5)) == ENCODER_RAD
