"""Effects of the water against closed forms, over frequency, amplitude, phase, speed, medium."""

from dataclasses import replace

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from hardware.description.motor import ShuntMotor
from hardware.description.setpoint import Medium, SetPoint
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.drive.gear import Gear
from sim.drive.prescribed_drive import DriveSettings
from sim.effects.campaign import in_order
from sim.effects.effect import Effect
from sim.effects.h1_added_mass_error import AddedMassError
from sim.effects.h2_damping_error import DampingError
from sim.effects.h3_quadratic_damping import QuadraticDamping
from sim.effects.h3b_quadratic_drift import QuadraticDrift
from sim.effects.h4_cubic_damping import CubicDamping
from sim.effects.h5_restoring import NonlinearRestoring
from sim.effects.h6_memory import Memory
from sim.effects.h7_tank_walls import TankWalls
from sim.effects.h8_surface_suction import SurfaceSuction
from sim.effects.h9_ground import GroundSuction
from sim.effects.h10_blockage import Blockage
from sim.effects.h11_carriage_speed import CarriageSpeedError
from sim.effects.h12_carriage_fluctuation import CarriageFluctuation
from sim.effects.h13_residual_waves import ResidualWaves
from sim.effects.h14_vortex_shedding import VortexShedding
from sim.effects.h15_dynamic_trim import DynamicTrim
from sim.effects.situation import STRUT_FORCES, Situation
from sim.model.force_law import LawInput
from sim.model.law_point import Acting, Point
from sim.model.laws import Quadratic
from sim.model.mounting import Mounting
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import at_small_angles, mismatch
from tests.sim.effects.in_time import between, in_time, lines

VERTICAL = vertical_rig().ideal()
HORIZONTAL = horizontal_rig().ideal()
CRANK = horizontal_rig(rod_length_m=1.5).ideal()
REMEMBERING = Memory().change(VERTICAL, SetPoint(1.0, 0.01))
MOTIONS = [
    (frequency, amplitude, phase)
    for frequency in (0.4, 0.9)
    for amplitude in (0.01, 0.03)
    for phase in (0.0, np.pi / 2.0, np.pi)
]
SET_POINTS = [SetPoint(*motion, speed) for motion in MOTIONS for speed in (0.0, 1.2, 2.0)]

# Exact: linear in the loads, or polynomials of a sine.
EXACT = [
    AddedMassError(0.2, -0.1),
    DampingError(0.3, -0.2),
    CubicDamping(500.0, 80.0),
    NonlinearRestoring(5000.0, 50000.0),
    NonlinearRestoring(5000.0, 50000.0, at_struts=0.0),
    Memory(200.0, 60.0, 5.0),
    TankWalls(),
    SurfaceSuction(5.0, 8.0),
    SurfaceSuction(5.0, 8.0, at_struts=0.3),
    GroundSuction(-5.0, 0.1),
    GroundSuction(-5.0, 0.1, at_struts=0.0),
    Blockage(0.02),
    CarriageSpeedError(0.01),
    VortexShedding(step_n=0.4),
    DynamicTrim(),
    DynamicTrim(at_struts=0.4),
]

# Of those, what depends on the motion through the water, and so on the model's angle.
THROUGH_WATER = ("H1", "H2", "H4", "H10", "H11")


@pytest.mark.sample(10)
@pytest.mark.parametrize("rig", [VERTICAL, HORIZONTAL, REMEMBERING])
@pytest.mark.parametrize("effect", EXACT, ids=lambda effect: effect.code)
def test_signature(effect: Effect, rig: SimulatedRig) -> None:
    compare = at_small_angles if effect.code in THROUGH_WATER else mismatch
    assert compare(effect, rig, SET_POINTS) < 1e-9


@pytest.mark.sample(3)
@pytest.mark.parametrize("rig", [VERTICAL, HORIZONTAL])
@pytest.mark.parametrize(
    "effect",
    [
        QuadraticDamping(300.0, 50.0),
        QuadraticDrift(300.0, 0.01),
        QuadraticDrift(300.0, -0.02),
        QuadraticDrift(300.0, 0.2),
    ],
)
def test_signature_of_squares(effect: Effect, rig: SimulatedRig) -> None:
    """Harmonics of v|v| above the period's 128 points fold back: some 1e-6."""
    assert at_small_angles(effect, rig, SET_POINTS) < 1e-5


LINEAR = ("H1", "H2", "H6", "H7", "H10", "H11")


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    "effect", [one for one in EXACT if one.code in LINEAR], ids=lambda one: one.code
)
def test_signature_of_linear_effects_on_a_crank(effect: Effect) -> None:
    """Whose second harmonic they change as well."""
    assert at_small_angles(effect, CRANK, SET_POINTS) < 1e-9


@pytest.mark.parametrize("effect", [*EXACT, QuadraticDamping(), QuadraticDrift()])
def test_nothing_of_the_water_is_in_air(effect: Effect) -> None:
    for motion in MOTIONS[::3]:
        set_point = SetPoint(*motion, 2.0, medium=Medium.AIR)
        theory = effect.signature(Situation.of(VERTICAL, set_point))
        assert not any(value for (name, _), value in theory.items() if name in STRUT_FORCES)
        nominal = steady_run(VERTICAL, set_point)
        changed = steady_run(effect.change(VERTICAL, set_point), set_point)
        for name in STRUT_FORCES:
            np.testing.assert_array_equal(changed.spectra[name], nominal.spectra[name])


def test_the_bottom_is_not_touched() -> None:
    with pytest.raises(
        ConfigurationError, match=r"0\.03 reaches the bottom at clearance_m = 0\.02"
    ):
        GroundSuction(5.0, 0.02).change(VERTICAL, SetPoint(1.0, 0.03))


@pytest.mark.sample(7)
@pytest.mark.parametrize("rig", [VERTICAL, HORIZONTAL, REMEMBERING])
@pytest.mark.parametrize("motion", [MOTIONS[1], MOTIONS[5], MOTIONS[8], MOTIONS[10]])
@pytest.mark.parametrize("fluctuation", [0.23, 1.7])
def test_carriage_fluctuation_in_the_time_domain(
    rig: SimulatedRig, motion: tuple[float, float, float], fluctuation: float
) -> None:
    """Least squares on a difference with the two sidebands alone; 40 periods, the last 25 of them.

    At a thousandth of the amplitude, so that the angles are small: the lines grow with it.
    The memory's transient has died out by then; its load goes on by a cubic between the samples.
    """
    frequency, amplitude, phase = motion
    set_point = SetPoint(frequency, 1e-3 * amplitude, phase, 1.2)
    effect = CarriageFluctuation(0.004, fluctuation, 0.6)
    theory = effect.lines(Situation.of(rig, set_point))
    changed = in_time(effect.change(rig, set_point), set_point, 40, 200)
    nominal = in_time(rig, set_point, 40, 200)
    for name in ("force_aft", "force_fore", "recorded_carriage_speed"):
        own = {frequency: value for (one, frequency), value in theory.items() if one == name}
        found = lines(changed.less(nominal), name, list(own), first_s=15.0 / motion[0])
        gap = [found[frequency] - value for frequency, value in own.items()]
        assert np.linalg.norm(gap) < 1e-5 * np.linalg.norm(list(own.values()))


@pytest.mark.parametrize("motion", MOTIONS[1::5])
def test_residual_waves_in_the_time_domain(motion: tuple[float, float, float]) -> None:
    """Least squares with the stated decay, and half a lifetime of it."""
    set_point = SetPoint(*motion)
    effect = ResidualWaves(3.0, 60.0, 90.0, 0.63, 0.4)
    theory = effect.lines(Situation.of(VERTICAL, set_point))
    changed = in_time(effect.change(VERTICAL, set_point), set_point, 20, 100)
    nominal = in_time(VERTICAL, set_point, 20, 100)
    assert effect.left_n == pytest.approx(3.0 * np.exp(-1.5))
    for (name, frequency), value in theory.items():
        found = lines(changed.less(nominal), name, [frequency], decay_s=60.0)
        assert abs(found[frequency] - value) < 1e-9 * abs(value)


def test_residual_waves_over_a_campaign() -> None:
    """The first run is calm, each later one has the frequency before it, or the tank's own."""
    set_points = [SetPoint(0.5, 0.02), SetPoint(0.8, 0.02), SetPoint(0.8, 0.03)]
    effect = ResidualWaves(3.0, 100.0)
    situation = Situation.of(VERTICAL, set_points[-1])
    sizes = []
    for waiting in (60.0, 300.0):
        runs = in_order(set_points, 120.0, waiting)
        first, second, third = (effect.at_run(run) for run in runs)
        assert not any(first.lines(situation).values())
        assert {frequency for _, frequency in second.lines(situation)} == {0.5}
        assert {frequency for _, frequency in third.lines(situation)} == {0.8}
        sizes.append(third.left_n)
        swaying = [replace(effect, tank_hz=0.37).at_run(run) for run in runs]
        assert not any(swaying[0].lines(situation).values())
        for one in swaying[1:]:
            assert {frequency for _, frequency in one.lines(situation)} == {0.37}
        assert swaying[2].left_n == third.left_n
    assert sizes[1] / sizes[0] == pytest.approx(np.exp(-2.4), rel=1e-12)


@pytest.mark.parametrize("speed", [0.0, 0.3, 1.1])
def test_vortices_without_a_width_in_the_time_domain(speed: float) -> None:
    set_point = SetPoint(0.9, 0.02, 1.0, speed)
    effect = VortexShedding(0.5, 0.04, 0.2, bandwidth=0.0)
    theory = effect.lines(Situation.of(VERTICAL, set_point))
    changed = in_time(effect.change(VERTICAL, set_point), set_point, 20, 100)
    nominal = in_time(VERTICAL, set_point, 20, 100)
    assert len(theory) == (2 if speed else 0)
    for (name, frequency), value in theory.items():
        assert frequency == pytest.approx(5.0 * speed)
        found = lines(changed.less(nominal), name, [frequency])
        assert abs(found[frequency] - value) < 1e-9 * abs(value)


def test_vortices_in_the_time_domain() -> None:
    """What a strut has more is the stated lines, and nothing else."""
    set_point = SetPoint(0.9, 0.02, 1.0, 1.1)
    effect = VortexShedding(bandwidth=0.2)
    changed = in_time(effect.change(VERTICAL, set_point), set_point, 20, 100)
    band = changed.less(in_time(VERTICAL, set_point, 20, 100))
    theory = effect.lines(Situation.of(VERTICAL, set_point))
    for strut in STRUT_FORCES:
        turned = [
            value * np.exp(2j * np.pi * frequency * band.time_s)
            for (name, frequency), value in theory.items()
            if name == strut
        ]
        assert len(turned) == 24
        np.testing.assert_allclose(band.signals[strut], np.sum(turned, axis=0).imag, atol=1e-10)


@pytest.mark.parametrize("bandwidth", [0.05, 0.1, 0.3])
def test_band_of_vortices_against_its_moments(bandwidth: float) -> None:
    """A record's power is (a U^2)^2/2, its middle St U/d, its width the bandwidth times that.

    A Hann window over 2000 s tells the lines apart; its own width, (1/T)/sqrt(3), adds 5e-7 to that
    of the narrowest band.
    """
    speed, duration_s, rate_hz = 1.2, 2000.0, 50.0
    effect = VortexShedding(0.5, 0.04, 0.2, bandwidth=bandwidth)
    changed = effect.change(VERTICAL, SetPoint(0.9, 0.02, 1.0, speed))
    laws = [one.law for one in changed.forces if one.point is Point.FORE]
    still, time_s = np.zeros(1), np.arange(duration_s * rate_hz) / rate_hz
    motion = LawInput(still, still, still, still, time_s, 1.0 / rate_hz, still)
    window = np.hanning(time_s.size)
    wave = window * np.sum([law.force(motion) for law in laws], axis=0)
    power = np.abs(np.fft.rfft(wave)) ** 2
    frequency = np.fft.rfftfreq(time_s.size, 1.0 / rate_hz)
    mean_square = np.sum(wave**2) / np.sum(window**2)
    middle = np.average(frequency, weights=power)
    width = np.sqrt(np.average((frequency - middle) ** 2, weights=power))
    assert mean_square == pytest.approx((0.5 * speed**2) ** 2 / 2.0, rel=1e-9)
    assert middle == pytest.approx(0.2 * speed / 0.04, rel=1e-9)
    assert width == pytest.approx(bandwidth * 6.0, rel=1e-6)


def test_vortices_differ_from_strut_to_strut_and_run_to_run() -> None:
    set_points = [SetPoint(0.5, 0.02, 0.0, 1.0)] * 2
    first, second = (VortexShedding().at_run(run) for run in in_order(set_points, 60.0, 60.0))
    phases = [
        [one.tone_phase_rad for one in effect.tones(1.0, strut)]
        for effect in (first, second)
        for strut in (0, 1)
    ]
    assert np.abs(np.corrcoef(phases) - np.eye(4)).max() < 0.5
    assert first.tones(1.0, 0) == VortexShedding().tones(1.0, 0)
    still = SetPoint(0.5, 0.02)
    assert VortexShedding().change(VERTICAL, still).forces == VERTICAL.forces
    assert not VortexShedding().lines(Situation.of(VERTICAL, still))


SPRINGS = replace(VERTICAL, mounting=Mounting(2e6, 3000.0), forces=(Acting(Quadratic(100.0)),))
ECHOING = {
    "on a yoke": VERTICAL,
    "on a crank, in a memory": replace(REMEMBERING, oscillator=CRANK.oscillator),
    "on springs, with a law": SPRINGS,
    "with a motor": replace(VERTICAL, drive=DriveSettings(motor=ShuntMotor())),
    "behind a gear": replace(VERTICAL, drive=DriveSettings(gear=Gear(1e-3))),
}


@pytest.mark.parametrize("rig", ECHOING.values(), ids=ECHOING.keys())
def test_walls_are_silent_until_their_echo_is_back(rig: SimulatedRig) -> None:
    """Until W/c_g, of a tank so deep that c_g = g/(2 w), nothing; soon after it, something."""
    set_point = SetPoint(0.8, 0.02, 1.0, 0.5)
    effect = TankWalls(4.2, 20.0)
    changed = in_time(effect.change(rig, set_point), set_point, 10, 100)
    walls = changed.less(in_time(rig, set_point, 10, 100))
    arrival_s = 4.2 * 2.0 * (2.0 * np.pi * 0.8) / STANDARD_GRAVITY_M_S2
    for name in STRUT_FORCES:
        size = np.abs(changed.signals[name]).max()
        echo = np.abs(walls.signals[name]) / size
        assert echo[walls.time_s <= arrival_s].max() < 1e-9
        assert echo[walls.time_s > arrival_s + 0.3].max() > 1e-3


@pytest.mark.parametrize("rig", [VERTICAL, SPRINGS])
def test_walls_come_to_their_periodic_steady_state(rig: SimulatedRig) -> None:
    """The last of 80 cycles, when modes of a tenth of the critical damping have settled."""
    set_point = SetPoint(0.8, 0.02, 1.0, 0.5)
    rig = TankWalls(damping_ratio=0.1).change(rig, set_point)
    late = in_time(rig, set_point, 80, 400)
    spectra = steady_run(rig, set_point).spectra
    for name in STRUT_FORCES:
        found = between(late, name, *late.edges[-2:], 1.0)[1]
        steady = spectra[name][1]
        assert abs(found - complex(-steady.imag, steady.real)) < 1e-5 * abs(steady)


def test_blockage_leaves_the_recorded_speed() -> None:
    set_point = SetPoint(0.9, 0.02, 1.0, 1.2)
    blocked = steady_run(Blockage(0.04).change(VERTICAL, set_point), set_point)
    error = CarriageSpeedError(0.04 / 0.96)
    faster = steady_run(error.change(VERTICAL, set_point), set_point)
    for name in STRUT_FORCES:
        np.testing.assert_allclose(blocked.spectra[name], faster.spectra[name], rtol=0, atol=1e-11)
    assert blocked.spectra["recorded_carriage_speed"][0].real == 1.2
    assert faster.spectra["recorded_carriage_speed"][0].real == pytest.approx(1.2 / 0.96)
