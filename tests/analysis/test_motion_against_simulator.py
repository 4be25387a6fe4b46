"""The closed-form phasors and the simulator were written apart; each is the other's oracle."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.ideal_rig import rod_series, strut_displacements
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.struts import to_motion, to_strut_forces
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.analysis.ideal_run import LinearHull, derivative, ideal_run, motion, through_water
from tests.sim.effects.against_theory import STRETCH, small_angles

RATE_HZ = 200.0
values = st.floats(-1e3, 1e3)
planes = st.sampled_from(list(Plane))


def water(rig: SimulatedRig) -> LinearHull:
    return LinearHull(
        added_mass=np.array(rig.water.added_mass),
        damping=np.array(rig.water.damping),
        restoring=np.array(rig.water.restoring),
    )


def sampled(phasors: np.ndarray, theta: np.ndarray) -> np.ndarray:
    orders = np.arange(len(phasors))
    waves = np.exp(1j * np.outer(theta, orders)) @ phasors
    return np.asarray(waves.imag)


@pytest.mark.parametrize("medium", list(Medium))
@pytest.mark.parametrize("phase", [0.0, math.pi, 1.9])
@pytest.mark.parametrize(
    "rig",
    [vertical_rig(), horizontal_rig(), horizontal_rig(rod_length_m=0.5)],
    ids=["vertical", "horizontal", "horizontal with rods"],
)
def test_forces_and_displacements_of_both_struts(
    rig: SimulatedRig, phase: float, medium: Medium
) -> None:
    """With struts so far apart that angles, and what a pitching weight adds, are below 1e-8."""
    rig = small_angles(rig)
    set_point = SetPoint(0.6, 0.04, phase, carriage_speed_m_s=1.3 * STRETCH, medium=medium)
    ideal = ideal_run(rig.oscillator, set_point, rig.body, water(rig), orders=24)
    chain = rig.ideal().chain(set_point)
    run = chain.run(chain.start(RATE_HZ, seed=0), 700)[1]
    theta = run["shaft_angle"]
    for name, column in (("aft", 0), ("fore", 1)):
        for signal, phasors in (("displacement", ideal.displacements), ("force", ideal.forces)):
            expected = sampled(phasors, theta)[:, column]
            size = np.abs(expected).max()
            np.testing.assert_allclose(run[f"{signal}_{name}"], expected, atol=1e-8 * size)


@pytest.mark.parametrize("ratio", [0.01, 0.3, 0.6, 0.95])
def test_rod_series_is_the_transform_of_the_rod(ratio: float) -> None:
    psi = 2.0 * math.pi * np.arange(4096) / 4096
    shape = np.sqrt(1.0 - (ratio * np.cos(psi)) ** 2) - 1.0
    transform = np.fft.rfft(shape).real / 4096
    expected = np.append(transform[0], 2.0 * transform[2:16:2])
    np.testing.assert_allclose(rod_series(ratio, 1.0, 7), expected, atol=1e-14)


def test_rod_series_begins_as_the_expansion_does() -> None:
    """-(e^2/(4L)) (1 + cos 2 theta) to first order, equations.md section 1."""
    e, length = 0.01, 5.0
    first = -(e**2) / (4.0 * length)
    np.testing.assert_allclose(rod_series(e, length, 1), [first, first], rtol=1e-5)


def test_a_rod_that_cannot_turn_and_no_orders_are_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"rod_length_m = 0\.1 must exceed"):
        rod_series(0.2, 0.1, 1)
    with pytest.raises(ConfigurationError, match="orders = 0"):
        strut_displacements(VERTICAL_1963, SetPoint(1.0, 0.01), 0)


@pytest.mark.parametrize("oscillator", [VERTICAL_1963, HORIZONTAL_1963], ids=lambda o: o.plane)
def test_the_incidence_vanishes_at_the_strut_phase_for_it(oscillator) -> None:  # type: ignore[no-untyped-def]
    speed, frequency = 1.2, 0.4
    phase = 2.0 * math.atan(2.0 * math.pi * frequency * oscillator.half_spacing_m / speed)
    struts = strut_displacements(oscillator, SetPoint(frequency, 0.05, phase, speed))
    moved = motion(struts, oscillator.half_spacing_m, oscillator.plane)
    velocity = through_water(moved, frequency, speed, oscillator.plane)
    assert abs(velocity[1, 0]) < 1e-15
    assert abs(velocity[1, 1]) > 0.01
    np.testing.assert_allclose(derivative(moved, frequency, 2), derivative(
        derivative(moved, frequency), frequency), rtol=1e-14)  # fmt: skip


@given(values, values, values, values, st.floats(0.05, 5.0), planes)
def test_the_pairs_are_dual(
    v_aft: float, v_fore: float, force: float, moment: float, half: float, plane: Plane
) -> None:
    """The struts' power is the loads' power: no sign or lever can be wrong in one pair alone."""
    velocity = to_motion(v_aft, v_fore, half, plane)
    forces = to_strut_forces(force, moment, half, plane)
    power = v_aft * forces[0] + v_fore * forces[1]
    size = (abs(v_aft) + abs(v_fore)) * (abs(forces[0]) + abs(forces[1])) + 1.0
    assert velocity[0] * force + velocity[1] * moment == pytest.approx(power, abs=1e-12 * size)


def test_a_hull_in_air_is_mass_and_weight_alone() -> None:
    rig = vertical_rig()
    set_point = SetPoint(0.8, 0.02, medium=Medium.AIR)
    load = ideal_run(rig.oscillator, set_point, rig.body, water(rig)).loads[1]
    omega = 2.0 * math.pi * 0.8
    assert load[0] == pytest.approx(-(omega**2) * 70.0 * 0.02)
    assert load[1] == pytest.approx(-(omega**2) * 70.0 * 0.02 * 0.02)
