"""Oracle: the same equations, written down anew, through scipy's integrator; and balances."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hardware.description.arrangement import Gauges
from hardware.description.arrays import FloatArray
from hardware.description.motor import Servo, ShuntMotor, SpeedLoop
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium, SetPoint
from sim.drive.motor import droop
from sim.drive.prescribed_drive import DriveSettings
from sim.model.friction import Coulomb
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic, Quadratic
from sim.model.mounting import Mounting
from sim.model.parameters import HullCoefficients
from sim.rig import SimulatedRig, vertical_rig
from sim.run import steady_run
from sim.signals import Signals
from sim.solve.compilation import follow_interpreted, follow_loop
from tests.exact.forces import state
from tests.exact.rig import ExactRig

RATE = 200.0
RIG = vertical_rig().ideal()
HEAVE = SetPoint(1.0, 0.03)
MASS = RIG.body.mass_kg + RIG.water.added_mass[0][0]
DAMPING = RIG.water.damping[0][0]
STIFFNESS = RIG.water.restoring[0][0]


def run(rig: SimulatedRig, set_point: SetPoint, count: int) -> Signals:
    chain = rig.chain(set_point)
    return chain.run(chain.start(RATE, 0), count)[1]


def integrate(rates: Any, start: list[float], count: int) -> FloatArray:
    time = np.arange(count) / RATE
    solved = solve_ivp(
        rates, (0.0, time[-1]), start, "DOP853", time, rtol=1e-11, atol=1e-13, max_step=0.02
    )
    found: FloatArray = solved.y
    return found


@pytest.mark.sample(1)
@pytest.mark.parametrize("loop", [SpeedLoop(), SpeedLoop(40.0, 200.0)], ids=["open", "closed"])
@pytest.mark.parametrize("medium", list(Medium))
def test_shunt_motor_that_feels_the_model(loop: SpeedLoop, medium: Medium) -> None:
    """Armature, gear and crank with a heaving model: (J + M y'^2) th'' = K i - load.

    In air the struts hold its weight, of which the gauges are tared, and the shaft lifts it.
    """
    motor, in_water = ShuntMotor(loop=loop), medium is Medium.WATER
    mass = MASS if in_water else RIG.body.mass_kg
    damping, stiffness = (DAMPING, STIFFNESS) if in_water else (0.0, 0.0)
    weight_n = 0.0 if in_water else 9.80665 * RIG.body.mass_kg
    rig = replace(RIG, drive=DriveSettings(start_ramp_s=1.5, motor=motor))
    omega, ramp, e = 2.0 * math.pi, 1.5, HEAVE.eccentricity_m
    constant, inertia = motor.constant_v_s * motor.gear_ratio, motor.shaft_inertia_kg_m2

    def rates(t: float, x: FloatArray) -> list[float]:
        angle, speed, current = x
        u = min(t / ramp, 1.0)
        told_speed = omega * u**3 * (10.0 + u * (6.0 * u - 15.0))
        told = -math.pi + omega * (ramp * u**4 * (2.5 + u * (u - 3.0)) + max(t - ramp, 0.0))
        lever, bend = e * math.cos(angle), -e * math.sin(angle)
        force = mass * bend * speed**2 + damping * lever * speed + stiffness * e * math.sin(angle)
        force -= weight_n
        voltage = constant * told_speed
        voltage -= loop.proportional * (speed - told_speed) + loop.integral * (angle - told)
        turn = (constant * current - force * lever) / (inertia + mass * lever**2)
        rise = (voltage - motor.resistance_ohm * current - constant * speed) / motor.inductance_h
        return [speed, turn, rise]

    expected = integrate(rates, [-math.pi, 0.0, 0.0], 1000)
    found = run(rig, replace(HEAVE, medium=medium), 1000)
    deviation = np.abs(expected[0] - found["shaft_angle"]).max()
    told = RIG.drive.__class__(start_ramp_s=1.5).commanded(1.0, np.arange(1000) / RATE).angle
    assert np.abs(expected[0] - told).max() > 3e-4  # there is something to see
    assert deviation < 1e-6
    np.testing.assert_allclose(found["shaft_speed"], expected[1], atol=3e-5)


def test_model_on_gauges_and_frame() -> None:
    """Pure heave: the model on two gauges in a row with the frame, with quadratic drag."""
    springs = Mounting(5e4, 200.0, 4e5, 3000.0, 300.0)
    rig = replace(
        RIG,
        drive=DriveSettings(start_ramp_s=1.5),
        body=replace(RIG.body, cg_x_m=0.0),
        water=replace(
            RIG.water,
            added_mass=((75.0, 0.0), (0.0, 22.0)),
            damping=((190.0, 0.0), (0.0, 55.0)),
            restoring=((6900.0, 0.0), (0.0, 2400.0)),
        ),
        mounting=springs,
        forces=(Acting(Quadratic(400.0)),),
    )
    e, omega, ramp = HEAVE.eccentricity_m, 2.0 * math.pi, 1.5
    k, c = 2.0 * 5e4, 2.0 * 200.0

    def strut(t: float) -> tuple[float, float]:
        u = min(t / ramp, 1.0)
        turned = ramp * u**4 * (2.5 + u * (u - 3.0)) + max(t - ramp, 0.0)
        angle = -math.pi + omega * turned
        speed = omega * u**3 * (10.0 + u * (6.0 * u - 15.0))
        return e * math.sin(angle), e * math.cos(angle) * speed

    def gauges(t: float, x: FloatArray) -> float:
        y, v = strut(t)
        return float(k * (y + x[2] - x[0]) + c * (v + x[3] - x[1]))

    def rates(t: float, x: FloatArray) -> list[float]:
        force = gauges(t, x)
        drag = DAMPING * x[1] + STIFFNESS * x[0] + 400.0 * abs(x[1]) * x[1]
        frame = (-force - 3000.0 * x[3] - 4e5 * x[2]) / 300.0
        return [x[1], (force - drag) / MASS, x[3], frame]

    expected = integrate(rates, [0.0, 0.0, 0.0, 0.0], 1000)
    force = np.array([gauges(n / RATE, x) for n, x in enumerate(expected.T)])
    found = run(rig, HEAVE, 1000)
    total = found["force_aft"] + found["force_fore"]
    rigid = run(replace(rig, mounting=Mounting()), HEAVE, 1000)
    assert np.abs(rigid["force_aft"] + rigid["force_fore"] - total).max() > 5.0
    np.testing.assert_allclose(total, force, atol=1e-5 * np.abs(force).max())


def test_droop_is_that_of_the_mean_load() -> None:
    """dw/w = -s T: mean torque B w a^2 / 2 of a heaving model through R / K^2."""
    motor = ShuntMotor()
    steady = steady_run(replace(RIG, drive=DriveSettings(motor=motor)), HEAVE)
    omega = steady.period.omega_rad_s
    torque = DAMPING * omega * HEAVE.eccentricity_m**2 / 2.0
    stiffness = (motor.constant_v_s * motor.gear_ratio) ** 2 / motor.resistance_ohm
    assert droop(motor) == pytest.approx(-1.0 / stiffness)
    assert omega - 2.0 * math.pi == pytest.approx(-torque / stiffness, rel=1e-3)
    held = steady_run(replace(RIG, drive=DriveSettings(motor=Servo())), HEAVE)
    assert held.period.frequency_hz == 1.0


def test_load_torque_ripple_makes_a_third_harmonic() -> None:
    """|y_3| = a^3 |Z_1| / (16 J w^2) for a motor whose inertia alone resists."""
    weak = ShuntMotor(resistance_ohm=1e4, inertia_kg_m2=0.1)
    set_point = SetPoint(1.0, 0.02)
    steady = steady_run(replace(RIG, drive=DriveSettings(motor=weak)), set_point)
    omega, e = steady.period.omega_rad_s, set_point.eccentricity_m
    impedance = abs(STIFFNESS - omega**2 * MASS + 1j * omega * DAMPING)
    third = e**3 * impedance / (16.0 * weak.shaft_inertia_kg_m2 * omega**2)
    assert abs(steady.spectra["displacement_aft"][3]) == pytest.approx(third, rel=2e-2)
    crossed = steady_run(
        replace(RIG, drive=DriveSettings(motor=weak), body=replace(RIG.body, cg_x_m=0.0)),
        replace(set_point, strut_phase_rad=math.pi / 2.0),
    )
    assert abs(crossed.spectra["load_torque"][2]) < 0.5 * abs(steady.spectra["load_torque"][2])


LAWS = (Acting(Quadratic(300.0)), Acting(Coulomb(2.0), Point.FORE), Acting(Cubic(90.0)))


SPRINGS = Mounting(2e5, 300.0, 1e6, 4000.0)


@pytest.mark.parametrize(
    ("motor", "springs"),
    [
        pytest.param(None, Mounting(), id="told"),
        pytest.param(ShuntMotor(), Mounting(), id="loaded"),
        pytest.param(None, SPRINGS, id="told on springs"),
        pytest.param(ShuntMotor(), SPRINGS, id="loaded on springs", marks=pytest.mark.slow),
    ],
)
def test_work_of_the_shaft_is_what_is_dissipated(motor: Any, springs: Mounting) -> None:
    """Work per cycle at the struts = work at the shaft = loss in water, laws and springs.

    Gauges that stay with the rig read what works; the water damps the exact motion in body axes.
    """
    rig = replace(
        RIG,
        oscillator=replace(RIG.oscillator, gauges=Gauges.RIG),
        water=HullCoefficients(damping=RIG.water.damping),
        drive=DriveSettings(motor=motor),
        mounting=springs,
        forces=LAWS[:1],
    )
    steady = steady_run(rig, SetPoint(0.7, 0.03, 0.4), orders=30, points=256)
    period, value = steady.period, {}
    for name in ("force_aft", "force_fore", "velocity_aft", "velocity_fore"):
        value[name] = period.values(steady.spectra[name])
    work = np.mean(
        value["force_aft"] * value["velocity_aft"] + value["force_fore"] * value["velocity_fore"]
    )
    if motor is not None:
        torque = period.values(steady.spectra["load_torque"])
        speed = period.values(steady.spectra["shaft_speed"])
        assert np.mean(torque * speed) == pytest.approx(work, rel=1e-9)
    # Where the model itself is, from the forces in the springs.
    s, lost = period.s, 0.0
    model = {one: steady.spectra[f"displacement_{one}"].copy() for one in ("aft", "fore")}
    if springs.gauge_stiffness_n_m is not None and springs.frame_stiffness_n_m is not None:
        both = steady.spectra["force_aft"] + steady.spectra["force_fore"]
        frame = -both / (springs.frame_mass_kg * s**2 + springs.frame_damping_n_s_m * s + 1e6)
        lost += springs.frame_damping_n_s_m * np.mean(period.values(s * frame) ** 2)
        for one in model:
            stretch = steady.spectra[f"force_{one}"] / (2e5 + 300.0 * s)
            lost += 300.0 * np.mean(period.values(s * stretch) ** 2)
            model[one] += frame - stretch
    translation = period.values(s * (model["aft"] + model["fore"])) / 2.0
    phasors = 1j * np.stack([model["aft"], model["fore"]], axis=1)
    exact = ExactRig(phasors, period.frequency_hz, plane=Plane.VERTICAL)
    motion = state(exact, period.omega_rad_s * period.time_s).motion
    q = np.array([motion["w"], motion["q"]])
    water = np.einsum("it,ij,jt->t", q, np.array(RIG.water.damping), q)
    lost += np.mean(water) + 300.0 * np.mean(np.abs(translation) ** 3)
    assert work == pytest.approx(lost, rel=1e-6)


def test_compiled_loop_and_its_stand_in_give_the_same_numbers() -> None:
    rng = np.random.default_rng(1)
    step, forcing = 0.4 * rng.normal(size=(5, 5)), rng.normal(size=(300, 5))
    ends = []
    for loop in (follow_interpreted, follow_loop):
        states = np.zeros((301, 5))
        loop(step, forcing, states)
        ends.append(states)
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12, atol=1e-12 * np.abs(ends[0]).max())
