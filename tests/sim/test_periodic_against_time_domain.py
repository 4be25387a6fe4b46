"""Oracle: the time domain after its transient, for every kind of rig; and closed forms."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hardware.description.arrays import ComplexArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Cogging, Guides, Servo, ShuntMotor
from hardware.description.setpoint import SetPoint
from sim.acquisition.amplifier import BridgeCarrier, FilterKind, LowPass
from sim.acquisition.photocell import PhotocellStage
from sim.drive.carriage import CarriageSettings
from sim.drive.prescribed_drive import DriveSettings, SpeedRipple
from sim.mechanism.linkage import Setting
from sim.model.friction import Coulomb
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic, Quadratic, Spring, Tone
from sim.model.mounting import Mounting
from sim.model.water.radiation import Radiation
from sim.periodic import steady_state
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from sim.signals import Signals
from sim.solve.period import Period

SET_POINT = SetPoint(0.5, 0.03, 0.5, 1.0)
RATE = 200.0
MEMORY = Radiation(
    np.array([[40.0, 3.0], [3.0, 12.0]]),
    np.array([[-4.0, 9.0], [-9.0, -4.0]]),
    np.array([[10.0, 1.0], [0.0, 4.0]]),
    np.array([[10.0, 0.0], [1.0, 4.0]]),
)
SPRINGS = Mounting(2e5, 300.0, 1e6, 4000.0)
IDEAL = vertical_rig().ideal()


def harmonics_of(run: Signals, name: str, frequency_hz: float) -> ComplexArray:
    """Least-squares harmonics 0 to 12 of the record, time 0 where the mean angle is 0."""
    angle = run["shaft_angle"]
    turned = 2.0 * math.pi * frequency_hz / RATE * np.arange(angle.size)
    phase = turned + np.mean(angle - turned)
    orders = np.arange(1, 20)
    columns = np.hstack(
        [np.ones((angle.size, 1)), np.cos(np.outer(phase, orders)), np.sin(np.outer(phase, orders))]
    )
    found = np.linalg.lstsq(columns, run[name], rcond=None)[0]
    waves = found[1:20] - 1j * found[20:]
    return np.concatenate([[found[0]], waves[:12]])


def late(rig: SimulatedRig, set_point: SetPoint, settling_s: float) -> Signals:
    chain = rig.chain(set_point)
    state, _ = chain.run(chain.start(RATE, 0), int(settling_s * RATE))
    return chain.run(state, int(16 * RATE))[1]


LINEAR = {
    "constant coefficients": IDEAL,
    "crank": horizontal_rig(0.4).ideal(),
    "memory": replace(IDEAL, radiation=MEMORY),
    "gauges": replace(IDEAL, mounting=Mounting(2e5, 300.0)),
    "water on board": replace(
        IDEAL,
        radiation=MEMORY.joined(
            [[0.0, 1.0], [-20.0, -2.0]], np.eye(2), [[9.0, 4.0], [0.0, 5.0]], aboard=True
        ),
        mounting=SPRINGS,
    ),
    "frame": replace(IDEAL, mounting=Mounting(None, 0.0, 5e5, 2000.0)),
    "gauges, frame and memory": replace(IDEAL, radiation=MEMORY, mounting=SPRINGS),
    "linkage": replace(
        horizontal_rig(0.4).ideal(),
        linkage_aft=Setting(2e-4, 0.01, 0.02, 0.01),
        linkage_fore=Setting(-1e-4, -0.02, 0.0, 0.0),
    ),
    "ripple": replace(IDEAL, drive=DriveSettings(ripple=(SpeedRipple(1, 0.01, 0.7),))),
    "carriage": replace(IDEAL, carriage=CarriageSettings(speed_error=0.03)),
    "speed": replace(IDEAL, drive=DriveSettings(speed_error=0.01)),
}


@pytest.mark.parametrize("rig", LINEAR.values(), ids=LINEAR.keys())
def test_linear_parts_agree_to_1e_9(rig: SimulatedRig) -> None:
    steady, run = steady_run(rig, SET_POINT), late(rig, SET_POINT, 40.0)
    for name in ("displacement_aft", "velocity_fore", "force_aft", "recorded_force_fore"):
        found = harmonics_of(run, name, steady.period.frequency_hz)
        expected = steady.spectra[name]
        assert np.abs(found - expected).max() < 1e-9 * np.abs(expected).max(), name


LAWS = (
    Acting(Quadratic(300.0)),
    Acting(Cubic(500.0), Point.THROUGH_WATER),
    Acting(Spring(0.0, 1e4, 1e5), Point.AFT),
)
MOTOR = ShuntMotor(cogging=(Cogging(3, 0.5, 0.2),), guides=Guides(2.0, 5.0))
LOOSER = {
    # Harmonics of v|v| beyond the points fold: 3e-7. The torque's cubic between samples: 1e-8.
    "laws": (replace(IDEAL, forces=LAWS), 1e-6),
    "laws on springs": (replace(IDEAL, forces=LAWS, mounting=SPRINGS, radiation=MEMORY), 3e-6),
    # A force that jumps, seen through 200 samples a second; it makes the gauges ring (7 Hz).
    "friction on springs": (
        replace(IDEAL, forces=(Acting(Coulomb(1.0), Point.AFT),), mounting=SPRINGS),
        1e-4,
    ),
    "shunt motor": (replace(IDEAL, drive=DriveSettings(motor=ShuntMotor())), 1e-6),
    "servo": (replace(IDEAL, drive=DriveSettings(motor=Servo())), 1e-7),
    "motor, cogging, guides": (replace(IDEAL, drive=DriveSettings(motor=MOTOR)), 2e-4),
    "all": (
        replace(
            IDEAL,
            drive=DriveSettings(motor=ShuntMotor()),
            forces=LAWS,
            mounting=SPRINGS,
            radiation=MEMORY,
        ),
        1e-5,
    ),
}


@pytest.mark.parametrize(("rig", "tolerance"), LOOSER.values(), ids=LOOSER.keys())
def test_the_rest_agrees_within_a_stated_tolerance(rig: SimulatedRig, tolerance: float) -> None:
    steady = steady_run(rig, SET_POINT, orders=60, points=512)
    run = late(rig, SET_POINT, 40.0)
    for name in ("shaft_speed", "displacement_aft", "force_aft", "recorded_force_fore"):
        found = harmonics_of(run, name, steady.period.frequency_hz)
        expected = steady.spectra[name][:13]
        assert np.abs(found - expected).max() < tolerance * np.abs(expected).max(), name


def test_coefficients_put_in_come_out_to_1e_9_with_memory_and_filter() -> None:
    """Pure heave on springs: B(w), A(w) and the filter are taken off in closed form."""
    low_pass = LowPass(20.0, FilterKind.BESSEL, 4)
    acquisition = IDEAL.acquisition
    assert acquisition.force_aft is not None
    channel = replace(
        acquisition.force_aft, low_pass=low_pass, delay_s=0.002, carrier=BridgeCarrier()
    )
    rig = replace(
        IDEAL,
        radiation=MEMORY,
        acquisition=replace(acquisition, force_aft=channel, force_fore=channel),
    )
    steady = steady_run(rig, SetPoint(0.8, 0.02))
    omega = steady.period.omega_rad_s
    lag = low_pass.response(np.array([1j * omega]))[0] * np.exp(-1j * omega * 0.002)
    force = (steady.spectra["recorded_force_aft"] + steady.spectra["recorded_force_fore"])[1] / lag
    impedance = force / steady.spectra["displacement_aft"][1]
    added = (rig.water.restoring[0][0] - impedance.real) / omega**2 - rig.body.mass_kg
    expected = rig.water.added_mass[0][0] + MEMORY.added_mass(omega)[0, 0]
    assert added == pytest.approx(expected, rel=1e-9)
    damping = rig.water.damping[0][0] + MEMORY.damping(omega)[0, 0]
    assert impedance.imag / omega == pytest.approx(damping, rel=1e-9)


def test_photocell_turns_the_phases() -> None:
    """Angle alpha and delay t_d together: order n is turned by n (alpha + w t_d)."""
    rig = replace(IDEAL, photocell=PhotocellStage(mark_angle_rad=0.1, latency_s=0.003))
    straight, turned = steady_run(IDEAL, SET_POINT), steady_run(rig, SET_POINT)
    angle = 0.1 + straight.period.omega_rad_s * 0.003
    for name in ("force_aft", "displacement_fore"):
        expected = straight.spectra[name] * np.exp(1j * angle * np.arange(13))
        np.testing.assert_allclose(turned.referred(name), expected, atol=1e-12)
    rippled = replace(rig, drive=DriveSettings(ripple=(SpeedRipple(1, 0.05, 0.3),)))
    pulse = late(rippled, SET_POINT, 2.0)
    steady = steady_run(rippled, SET_POINT)
    period = 1.0 / SET_POINT.frequency_hz
    phase = (pulse["photocell_edge_time"] - steady.reference_s) % period
    np.testing.assert_allclose(phase, period / 2.0, atol=1e-9)  # the angle was -pi at time 0


def test_substituted_harmonics_feed_everything_behind_them() -> None:
    """By micrometres, so that twice the motion is twice the force."""
    small = replace(SET_POINT, eccentricity_m=1e-6)
    chain = IDEAL.chain(small)
    nominal = steady_state(chain, Period(0.5))
    twice = {
        f"{what}_{strut}": 2.0 * nominal.spectra[f"{what}_{strut}"]
        for what in ("displacement", "velocity", "acceleration")
        for strut in ("aft", "fore")
    }
    fed = steady_state(chain, Period(0.5), twice)
    expected = 2.0 * nominal.spectra["force_aft"]
    np.testing.assert_allclose(
        fed.spectra["force_aft"], expected, rtol=0.0, atol=1e-5 * np.abs(expected).max()
    )
    coupled = replace(IDEAL, drive=DriveSettings(motor=ShuntMotor())).chain(small)
    inside = steady_state(coupled, Period(0.5), twice)
    ratio = inside.spectra["load_torque"][2] / nominal_torque(coupled)
    assert abs(ratio) == pytest.approx(2.0, rel=1e-2)


def nominal_torque(chain: Any) -> complex:
    return complex(steady_state(chain, Period(0.5)).spectra["load_torque"][2])


def test_what_does_not_repeat_is_left_out() -> None:
    tone = replace(IDEAL, forces=(Acting(Tone(5.0, 3.3)),))
    one, other = steady_run(tone, SET_POINT), steady_run(IDEAL, SET_POINT)
    np.testing.assert_array_equal(one.spectra["force_aft"], other.spectra["force_aft"])


def test_bad_requests_are_refused() -> None:
    chain = IDEAL.chain(SET_POINT)
    with pytest.raises(ConfigurationError, match="points = 20"):
        steady_state(chain, Period(0.5, 12, 20))
    with pytest.raises(ConfigurationError, match="no signal 'force'"):
        steady_state(chain, Period(0.5), {"force": np.zeros(13, complex)})
    with pytest.raises(ConfigurationError, match=r"shape \(3,\)"):
        steady_state(chain, Period(0.5), {"force_aft": np.zeros(3, complex)})
