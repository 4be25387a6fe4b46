"""Oracle: the exact rig of ``tests/exact``, which moves points and solves their equilibrium."""

import math
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.typing import NDArray

from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.motor import Servo
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium
from sim import signals
from sim.drive.prescribed_drive import DriveSettings
from sim.model.mounting import Mounting
from sim.periodic import steady_state
from sim.solve.period import Period
from tests.exact.forces import at_rest
from tests.exact.rig import ExactRig
from tests.exact.run import cycle, readings
from tests.sim.exact import UNDER_WATER, exact, set_point, simulated

ORDERS = 3  # harmonics that an analysis uses
FORCES = (signals.FORCE_AFT.name, signals.FORCE_FORE.name, signals.FORCE_X.name)
ARRANGEMENTS = tuple(
    Arrangement(*one)
    for one in product((Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG), Pivot, Gauges, DriftBy)
)
LARGEST_RAD = {Plane.HORIZONTAL: math.radians(25.0), Plane.VERTICAL: math.radians(15.0)}
SPRINGS = Mounting(2e5, 300.0, 1e6, 4000.0)
EVERY = pytest.mark.parametrize(
    "arrangement", ARRANGEMENTS, ids=lambda one: "-".join(vars(one).values())
)


@pytest.mark.sample(11)
@EVERY
@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("medium", Medium)
def test_steady_state_is_the_exact_cycle(
    medium: Medium, plane: Plane, arrangement: Arrangement
) -> None:
    for part, drift_rad in ((0.04, 0.0), (0.4, 0.15), (1.0, 0.0), (1.0, -0.1)):
        point = set_point(arrangement, part * LARGEST_RAD[plane], medium)
        chain = simulated(plane, arrangement).chain(replace(point, drift_rad=drift_rad))
        found = steady_state(chain, Period(point.frequency_hz)).spectra
        expected = cycle(exact(plane, arrangement, point, drift_rad), ORDERS, tared=True)
        phasors = np.where(np.arange(ORDERS + 1)[:, None] > 0, -1j, 1.0) * expected
        size = np.abs(phasors[1, :2]).max()
        for name, column in zip(FORCES, phasors.T, strict=True):
            assert np.abs(found[name][: ORDERS + 1] - column).max() < 1e-6 * size


@pytest.mark.sample(13)
@EVERY
@pytest.mark.parametrize("plane", Plane)
def test_samples_are_the_exact_readings(plane: Plane, arrangement: Arrangement) -> None:
    point = set_point(arrangement, LARGEST_RAD[plane], Medium.WATER)
    for drift_rad in (0.0, 0.15):
        chain = simulated(plane, arrangement).chain(replace(point, drift_rad=drift_rad))
        _, run = chain.run(chain.start(50.0, 1), 200)
        rig = exact(plane, arrangement, point, drift_rad)
        expected = readings(rig, run[signals.SHAFT_ANGLE.name], tared=True)
        for name, row in zip(FORCES, expected, strict=True):
            assert np.abs(run[name] - row).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.sample(7)
@EVERY
def test_a_model_below_the_surface_weighs_more_than_its_water(arrangement: Arrangement) -> None:
    point = set_point(arrangement, LARGEST_RAD[Plane.VERTICAL], Medium.WATER)
    for medium, drift_rad in product(Medium, (0.0, 0.15)):
        point = replace(point, medium=medium, drift_rad=drift_rad)
        chain = simulated(Plane.VERTICAL, arrangement, UNDER_WATER).chain(point)
        _, run = chain.run(chain.start(50.0, 1), 200)
        rig = exact(Plane.VERTICAL, arrangement, point, drift_rad, UNDER_WATER)
        expected = readings(rig, run[signals.SHAFT_ANGLE.name], tared=True)
        for name, row in zip(FORCES, expected, strict=True):
            assert np.abs(run[name] - row).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("plane", Plane)
def test_another_speed_of_the_carriage_is_that_of_its_exact_rig(plane: Plane) -> None:
    arrangement = Arrangement(Joint.SLIDES_ON_RIG, Pivot.FORE, Gauges.RIG)
    point = set_point(arrangement, LARGEST_RAD[plane], Medium.WATER)
    chain = simulated(plane, arrangement).chain(replace(point, drift_rad=0.1))
    faster = 1.3 * point.carriage_speed_m_s
    _, run = chain.run(chain.start(50.0, 1), 200, {"carriage_speed": np.full(200, faster)})
    rig = replace(exact(plane, arrangement, point, 0.1), speed_m_s=faster)
    expected = readings(rig, run[signals.SHAFT_ANGLE.name], tared=True)
    for name, row in zip(FORCES, expected, strict=True):
        assert np.abs(run[name] - row).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.sample(13)
@EVERY
@pytest.mark.parametrize("plane", Plane)
def test_what_gives_way_moves_the_exact_model(plane: Plane, arrangement: Arrangement) -> None:
    """The model on springs is where the forces in these put it; there it is the exact rig."""
    point = set_point(arrangement, 0.8 * LARGEST_RAD[plane], Medium.WATER)
    rig = replace(simulated(plane, arrangement), mounting=SPRINGS)
    orders, period = 24, Period(point.frequency_hz, 24, 256)
    found = steady_state(rig.chain(replace(point, drift_rad=0.1)), period).spectra
    s = period.s
    both = found["force_aft"] + found["force_fore"]
    frame = -both / (SPRINGS.frame_mass_kg * s**2 + 4000.0 * s + 1e6)
    model = [
        found[f"displacement_{one}"] + frame - found[f"force_{one}"] / (2e5 + 300.0 * s)
        for one in ("aft", "fore")
    ]
    turned = np.where(np.arange(orders + 1)[:, None] > 0, 1j, 1.0) * np.stack(model, axis=1)
    there = replace(exact(plane, arrangement, point, 0.1), coordinates=turned)
    whole = cycle(there, ORDERS) - _at_rest(exact(plane, arrangement, point, 0.1))
    phasors = np.where(np.arange(ORDERS + 1)[:, None] > 0, -1j, 1.0) * whole
    for name, column in zip(FORCES, phasors.T, strict=True):
        gap = np.abs(found[name][: ORDERS + 1] - column).max()
        assert gap < 1e-6 * np.abs(phasors[1, :2]).max()


def _at_rest(rig: ExactRig) -> NDArray[np.complex128]:
    """What a zero run takes off the mean of the readings, those of the struts at rest."""
    rest = np.zeros((ORDERS + 1, 3), dtype=np.complex128)
    rest[0] = at_rest(rig)
    return rest


@pytest.mark.parametrize("plane", Plane)
def test_samples_come_to_the_steady_state_on_springs_behind_a_motor(plane: Plane) -> None:
    """The march over samples, and the balance over harmonics, at the largest angle."""
    arrangement = Arrangement(Joint.SLIDES_ON_RIG, gauges=Gauges.RIG)
    point = set_point(arrangement, LARGEST_RAD[plane], Medium.WATER)
    rig = replace(
        simulated(plane, arrangement), mounting=SPRINGS, drive=DriveSettings(motor=Servo())
    )
    chain = rig.chain(replace(point, drift_rad=0.1))
    steady = steady_state(chain, Period(point.frequency_hz, 24, 256))
    rate = 512.0 * steady.period.frequency_hz
    _, run = chain.run(chain.start(rate, 1), 512 * 8)
    beyond = steady.spectra[signals.SHAFT_ANGLE.name]
    ramp = steady.period.omega_rad_s * np.arange(512) / rate
    late = np.mean(run[signals.SHAFT_ANGLE.name][-512:] - ramp)
    turned = np.exp(1j * late * np.arange(ORDERS + 1))
    assert np.abs(beyond[0]) < 1e-9
    for name in FORCES:
        harmonics = np.fft.rfft(run[name][-512:])[: ORDERS + 1] / 256.0
        harmonics[0] /= 2.0
        expected = steady.spectra[name][: ORDERS + 1] * turned
        size = np.abs(steady.spectra["force_aft"][1])
        assert np.abs(harmonics - expected).max() < 1e-5 * size


@pytest.mark.parametrize("plane", Plane)
def test_small_angles_are_the_linear_system_to_second_order(plane: Plane) -> None:
    rig = simulated(plane, Arrangement())
    rig = replace(rig, cross_flow=None, surge=None)
    gaps = []
    for angle_rad in (0.02, 0.01):
        point = set_point(Arrangement(), angle_rad, Medium.WATER)
        chain = rig.chain(point)
        found = steady_state(chain, Period(point.frequency_hz)).spectra
        system = chain.stage("hull").system  # type: ignore[attr-defined]
        struts = np.array([found["displacement_aft"][1], found["displacement_fore"][1]])
        s = 2j * np.pi * point.frequency_hz
        linear = (system.mass * s**2 + system.damping * s + system.stiffness) @ struts
        nearly = np.array([found["force_aft"][1], found["force_fore"][1]])
        gaps.append(np.abs(nearly - linear).max() / np.abs(linear).max())
    assert gaps[1] < 1e-3
    assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=1e-2)
