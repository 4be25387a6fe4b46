"""Oracle: the closed-form in-phase and quadrature forces of a linear model in forced motion.

Where the model turns these hold at small angles: there the struts move by micrometres, so that what
is of second order in the angle lies below the tolerance.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrangement import Gauges
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.struts import to_motion
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.model.hull import HullCoefficients
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.signals import Signals
from tests.exact.forces import state
from tests.exact.rig import ExactRig

RATE = 200.0
SMALL_M = 1e-6


def run(rig: SimulatedRig, set_point: SetPoint, samples: int = 1600) -> Signals:
    chain = rig.ideal().chain(set_point)
    return chain.run(chain.start(RATE, seed=0), samples)[1]


def sine_cosine(angle: FloatArray, values: FloatArray) -> FloatArray:
    """Least-squares amplitudes of sin and cos, beside a mean."""
    columns = np.column_stack([np.sin(angle), np.cos(angle), np.ones_like(angle)])
    found: FloatArray = np.linalg.lstsq(columns, values, rcond=None)[0]
    return found[:2]


def loads(rig: SimulatedRig, signals: Signals) -> tuple[FloatArray, FloatArray]:
    aft, fore, lever = signals["force_aft"], signals["force_fore"], rig.oscillator.half_spacing_m
    couple = aft - fore if rig.oscillator.plane is Plane.VERTICAL else fore - aft
    return aft + fore, couple * lever


@pytest.mark.parametrize("frequency_hz", [0.1, 0.73, 1.4])
def test_pure_heave(frequency_hz: float) -> None:
    """F_s = (c - w^2 (m + a)) x_a and F_c = b w x_a."""
    rig, x_a = vertical_rig(), 0.02
    signals = run(rig, SetPoint(frequency_hz, x_a))
    omega = 2.0 * math.pi * frequency_hz
    force, moment = loads(rig, signals)
    a, b, c = (np.array(m) for m in (rig.water.added_mass, rig.water.damping, rig.water.restoring))
    in_phase, quadrature = sine_cosine(signals["shaft_angle"], force)
    m = rig.body.mass_kg
    assert in_phase == pytest.approx((c[0, 0] - omega**2 * (m + a[0, 0])) * x_a, rel=1e-10)
    assert quadrature == pytest.approx(b[0, 0] * omega * x_a, rel=1e-10)
    in_phase, quadrature = sine_cosine(signals["shaft_angle"], moment)
    coupling = a[1, 0] - m * rig.body.cg_x_m
    assert in_phase == pytest.approx((c[1, 0] - omega**2 * coupling) * x_a, rel=1e-10)
    assert quadrature == pytest.approx(b[1, 0] * omega * x_a, rel=1e-10)


@pytest.mark.parametrize("plane", list(Plane))
@pytest.mark.parametrize("phase", [0.0, math.pi, 1.9])
def test_both_motions_against_the_complex_impedance(plane: Plane, phase: float) -> None:
    """Strut phasors -> motion -> Z = C + G - w^2 (M + A) + i w B -> loads, at zero speed."""
    rig = vertical_rig() if plane is Plane.VERTICAL else horizontal_rig()
    set_point = SetPoint(0.6, SMALL_M, strut_phase_rad=phase)
    signals, omega = run(rig, set_point), 2.0 * math.pi * 0.6
    strut = -1j * SMALL_M * np.array([1.0, np.exp(1j * phase)])  # values = Re(phasor exp(i th))
    q = np.array(to_motion(strut[0], strut[1], rig.oscillator.half_spacing_m, plane))
    body, sign = rig.body, -1.0 if plane is Plane.VERTICAL else 1.0
    x = sign * body.mass_kg * body.cg_x_m
    mass = np.array([[body.mass_kg, x], [x, body.inertia_kg_m2]])
    weight = np.zeros((2, 2))
    if plane is Plane.VERTICAL:
        weight[1, 1] = body.mass_kg * STANDARD_GRAVITY_M_S2 * body.cg_z_m
    z = (
        np.array(rig.water.restoring)
        + weight
        - omega**2 * (mass + np.array(rig.water.added_mass))
        + 1j * omega * np.array(rig.water.damping)
    )
    for expected, found in zip(z @ q, loads(rig, signals), strict=True):
        sine, cosine = sine_cosine(signals["shaft_angle"], found)
        assert cosine - 1j * sine == pytest.approx(expected, abs=1e-9 * np.abs(z @ q).max())


@pytest.mark.parametrize(("plane", "fore"), [(Plane.VERTICAL, -1.0), (Plane.HORIZONTAL, 1.0)])
def test_pure_rotation_loads_the_struts_in_opposition(plane: Plane, fore: float) -> None:
    """A moment alone: bow up presses the aft strut down, bow to starboard pushes the fore one.

    At any angle: the attachment that slides on the model is 2 l / cos(angle) from the other.
    """
    rig = vertical_rig() if plane is Plane.VERTICAL else horizontal_rig()
    rig = replace(
        rig,
        body=Body(mass_kg=0.0, inertia_kg_m2=0.0),
        water=HullCoefficients(restoring=((0.0, 0.0), (0.0, 100.0))),
    )
    signals = run(rig, SetPoint(0.5, 0.05, strut_phase_rad=math.pi))
    lever = rig.oscillator.half_spacing_m
    _, rotation = to_motion(signals["displacement_aft"], signals["displacement_fore"], lever, plane)
    angle = np.arctan(rotation)
    couple = 100.0 * angle * np.cos(angle) / (2.0 * lever)
    np.testing.assert_allclose(signals["force_fore"], fore * couple, atol=1e-12)
    np.testing.assert_allclose(signals["force_aft"], -fore * couple, atol=1e-12)


def test_model_in_air_carried_by_its_centre_of_gravity() -> None:
    """A point mass at the fore strut: that strut carries it alone, whatever the motion."""
    lever = vertical_rig().oscillator.half_spacing_m
    point = Body(mass_kg=10.0, inertia_kg_m2=10.0 * lever**2, cg_x_m=lever)
    for rig in (vertical_rig(), horizontal_rig()):
        set_point = SetPoint(1.0, SMALL_M, strut_phase_rad=1.3, medium=Medium.AIR)
        signals = run(replace(rig, body=point), set_point)
        inertia = 10.0 * signals["acceleration_fore"]
        least = 1e-6 * np.abs(inertia).max()
        np.testing.assert_allclose(signals["force_fore"], inertia, atol=least)
        np.testing.assert_allclose(signals["force_aft"], 0.0, atol=least)


@pytest.mark.parametrize("plane", list(Plane))
def test_zero_angle_of_attack_leaves_no_force_from_it(plane: Plane) -> None:
    """tan(phi/2) = w l / U: the midpoint moves along the model's axis, so w (or v) vanishes."""
    rig = vertical_rig() if plane is Plane.VERTICAL else horizontal_rig()
    rig = replace(
        rig,
        body=Body(mass_kg=0.0, inertia_kg_m2=0.0),
        water=HullCoefficients(
            added_mass=((60.0, 0.0), (0.0, 0.0)), damping=((150.0, 0.0), (0.0, 0.0))
        ),
    )
    omega, speed = 2.0 * math.pi * 0.4, 1.2
    phase = 2.0 * math.atan2(omega * rig.oscillator.half_spacing_m, speed)
    still = run(rig, SetPoint(0.4, SMALL_M, phase, carriage_speed_m_s=speed))
    off = run(rig, SetPoint(0.4, SMALL_M, phase + 0.1, carriage_speed_m_s=speed))
    assert np.abs(loads(rig, still)[0]).max() < 1e-5 * np.abs(loads(rig, off)[0]).max()
    assert np.abs(loads(rig, off)[0]).max() > 10.0 * SMALL_M


@pytest.mark.parametrize("phase", [0.0, math.pi, 0.9])
def test_work_per_cycle_is_what_the_damping_dissipates(phase: float) -> None:
    """Work of both struts, across the rig, against the integral of q' B q' in body axes."""
    rig = vertical_rig()
    damping = HullCoefficients(damping=rig.water.damping)
    rig = replace(rig, oscillator=replace(rig.oscillator, gauges=Gauges.RIG), water=damping)
    signals = run(rig, SetPoint(0.5, 0.04, strut_phase_rad=phase), samples=400)  # one period
    power = (
        signals["force_aft"] * signals["velocity_aft"]
        + signals["force_fore"] * signals["velocity_fore"]
    )
    struts = np.array([[0.0, 0.0], [0.04, 0.04 * np.exp(1j * phase)]])
    exact = ExactRig(struts, 0.5, plane=Plane.VERTICAL)
    motion = state(exact, signals["shaft_angle"]).motion
    velocity = np.array([motion["w"], motion["q"]])
    dissipated = np.einsum("it,ij,jt->", velocity, np.array(rig.water.damping), velocity) / RATE
    assert power.sum() / RATE == pytest.approx(dissipated, rel=1e-12)
    assert dissipated > 0.0


def test_quadrature_gives_the_work_per_cycle() -> None:
    """Pure heave: work = pi F_c x_a = pi b w x_a^2."""
    rig, x_a, omega = vertical_rig(), 0.03, 2.0 * math.pi * 0.5
    signals = run(rig, SetPoint(0.5, x_a), samples=400)
    force, _ = loads(rig, signals)
    work = np.sum(force * signals["velocity_aft"]) / RATE
    quadrature = sine_cosine(signals["shaft_angle"], force)[1]
    assert work == pytest.approx(math.pi * quadrature * x_a, rel=1e-12)
    assert work == pytest.approx(math.pi * rig.water.damping[0][0] * omega * x_a**2, rel=1e-12)
