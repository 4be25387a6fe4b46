"""What is always on in a good rig: no gap within its tolerance, named beyond it."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.always_on import hum_columns
from analysis.gap.forward.free_numbers import free_numbers, tolerated
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.locate.walk import TIMING, walk
from analysis.gap.observe.components import GapRun, Stack
from sim.effects.catalogue import build
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, problem_of, record

USUAL = Tolerances()


def test_a_load_ripple_is_that_of_a_simulated_motor(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """To first order: a drive that brings the mean back, and higher orders, are a tenth of it."""
    stack = Stack.of(pooled(clean, rig, USUAL))
    simulator = Simulator(rig, stack)
    heavy = build("load-ripple:inertia_kg_m2=1e4,hold_hz=0.001")
    change = (simulator.steady((heavy,)) - simulator.steady(())) / stack.uncertainty
    found = tolerated(simulator, free_numbers(rig, USUAL), Tolerances(load_ripple_1_kg_m2=1e-4))
    column = found.columns[:, found.names.index("load ripple")]
    assert np.linalg.norm(column - change) < 0.1 * np.linalg.norm(change)


@pytest.mark.slow
def test_drift_is_that_of_simulated_zeros(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    stack = Stack.of(pooled(clean, rig, USUAL))
    simulator = Simulator(rig, stack)
    drifting = build("zero-drift:aft_n_s=0.01,fore_n_s=0")
    change = (simulator.predict((drifting,)) - simulator.nominal) / stack.uncertainty
    found = tolerated(simulator, free_numbers(rig, USUAL), Tolerances(warming_n_s=0.01))
    column = found.columns[:, found.names.index("drift aft")]
    rows = column != 0.0
    np.testing.assert_allclose(change[rows], column[rows], rtol=0.05)


def test_hum_is_that_of_simulated_lines(rig: SimulatedRig) -> None:
    """50 Hz, sampled at 64 Hz, is a line at 14 Hz: at 0.5 Hz a harmonic."""
    points = [replace(POINTS[0], frequency_hz=one) for one in (0.5, 0.53, 1.13)]
    hum = build("hum:amplitude_n=0.4,frequency_hz=50")
    stack = Stack.of(record(rig, (hum,), 1, points))
    own = [column for name, column in hum_columns(stack, 0.4) if name.endswith("50 Hz")]
    told = np.sum(own, axis=0) * stack.uncertainty
    assert np.count_nonzero(told) == 6  # of two forces: nothing else is at the 28th harmonic
    lines = told > 0.0
    np.testing.assert_allclose(stack.values[lines], told[lines], rtol=0.02)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("effect", "name", "step"),
    [
        ("speed-ripple:relative={:g},order=1,phase_rad=0.7", "ripple 1", USUAL.ripple_1_relative),
        ("speed-ripple:relative={:g},order=2,phase_rad=2.0", "ripple 2", USUAL.ripple_2_relative),
        ("carriage-speed:relative={:g}", "carriage speed", USUAL.carriage_speed_relative),
    ],
)
def test_the_walk_names_what_is_ten_tolerances_off_and_not_what_is_one(
    rig: SimulatedRig, effect: str, name: str, step: float
) -> None:
    within = walk(problem_of(rig, record(rig, [build(effect.format(step))], 61)))
    for one in within.steps:
        if one.step != TIMING:  # its pulses scatter
            assert not one.is_beyond_noise
            assert not one.strained
    assert _off(rig, effect.format(10.0 * step), name) > 3.0


def _off(rig: SimulatedRig, effect: str, name: str) -> float:
    """Return by how many tolerances the walk says a number is off, all its phases together."""
    steps = walk(problem_of(rig, record(rig, [build(effect)], 62))).steps
    units = [unit for one in steps for key, unit in one.strained.items() if key.startswith(name)]
    return float(np.linalg.norm(units))
