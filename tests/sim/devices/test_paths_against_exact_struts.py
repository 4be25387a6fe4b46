"""Struts that follow paths on the simulated rig: purity by drawn geometry, following by solve_ivp.

The drawing knows points and distances; the following error is that of the drives' stated loop under
the force of the model, integrated by another integrator from the set-points that were sent.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.response.multisine import multisine
from analysis.response.pure_rotation import pure_rotation
from hardware.description.errors import ConfigurationError
from hardware.description.lines import struts_over_turn
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.errors import CycleJumpError, HardwareError, LimitError
from hardware.pacing import RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from sim.devices.plant import PlantConditions
from sim.devices.strut_drive import PositionLoop
from sim.devices.world import World
from sim.rig import horizontal_rig
from tests.exact.drawn_struts import drawn
from tests.hardware.contract import Bench, PositionAxisContract, ShaftContract
from tests.sim.devices.benches import amplifier, in_process, ready

STRUT = {
    "counts_per_unit": 1e7,
    "low": -0.35,
    "high": 0.35,
    "speed": 1.0,
    "acceleration": 10.0,
    "quick_stop": 5.0,
    "tolerance": 1e-4,
    "standard_uncertainty": 1e-5,
    "following_error": 2e-3,
    "homing_speed": 0.05,
}
PATHS = {
    "shaft": {
        "driver": "path-struts",
        "aft": {**STRUT, "node": 1},
        "fore": {**STRUT, "node": 2},
        "highest_frequency_hz": 2.0,
        "acceleration_hz_per_s": 1.5,
        "approach_speed": 0.8,
    },
    "eccentricity": {
        "driver": "path-setting",
        "low": 0.0,
        "high": 0.3,
        "standard_uncertainty": 1e-5,
    },
    "phase": {
        "driver": "path-setting",
        "unit": "rad",
        "low": -3.2,
        "high": 3.2,
        "standard_uncertainty": 1e-5,
    },
    "photocell": {"driver": "path-pulse"},
    "forces": [amplifier(4, "force_aft"), amplifier(5, "force_fore")],
}
RATE_HZ = 50.0
TABLES = {**PATHS, "bus": {"sync_rate_hz": RATE_HZ}}
BARE = replace(horizontal_rig().ideal(), photocell=None)
FREQUENCY_HZ, SPEED, AMPLITUDE = 0.5, 0.8, 0.2
PURE = pure_rotation(HORIZONTAL_1963, FREQUENCY_HZ, SPEED, AMPLITUDE)
# Of the bow's speed: what set-points of a micrometre leave, and what drives that lag by a
# hundredth of a period in the worst of their loops would make of the path.
TOLD_IMPURE, MOVED_IMPURE = 2e-5, 2e-3
COUNT_M = 1e-7
REST_CYCLES = 40  # 0.8 s: a quick stop from 1 m/s at 5 m/s2 takes 0.2 s


@pytest.fixture(scope="module")
def led() -> Iterator[tuple[Rig, World]]:
    """One rig for all tests: each begins with bringing it to where it wants it."""
    with in_process(TABLES, BARE, PlantConditions(SPEED)) as both:
        yield both


def without_power(rig: Rig) -> Bench:
    """As after the power came back: at rest, no path, nothing homed."""
    rig.stop()
    rig.run_until(lambda: not rig.shaft.moving and not rig.shaft.setting, 500, "rest")
    rig.reset()
    rig.shaft.disable()
    rig.run_until(lambda: not rig.shaft.enabled, 100, "power off")
    rig.shaft.aim(eccentricity_m=0.0, strut_phase_rad=0.0, lines=())
    for strut in rig.shaft.struts:
        strut.homed = False
    rig.eccentricity._inner._moved = False
    return Bench(rig)


def rehomed(rig: Rig) -> None:
    """Spare the homing: the simulated encoders have stayed."""
    for strut in rig.shaft.struts:
        strut.homed = True


class TestPathShaft(ShaftContract):
    @pytest.fixture
    def bench(self, led: tuple[Rig, World]) -> Bench:
        bench = without_power(led[0])
        rehomed(led[0])
        return bench

    def test_it_closes_twice(self) -> None:
        with in_process(TABLES, BARE) as (rig, _):  # the others go on with theirs
            super().test_it_closes_twice(Bench(rig))


class TestPathSetting(PositionAxisContract):
    @pytest.fixture
    def bench(self, led: tuple[Rig, World]) -> Bench:
        return without_power(led[0])


@pytest.fixture
def turning(led: tuple[Rig, World]) -> tuple[Rig, World]:
    rig, _ = led
    if rig.shaft.at_speed and rig.shaft.eccentricity_m == AMPLITUDE:
        return led
    without_power(rig)
    rehomed(rig)
    rig.shaft.enable()
    rig.run_until(lambda: rig.shaft.enabled, 100, "enable")
    rig.shaft.follow(PURE)
    rig.eccentricity.move_to(AMPLITUDE)
    rig.run_until(lambda: rig.eccentricity.settled, 1000, "the path's beginning")
    rig.shaft.turn(FREQUENCY_HZ)
    rig.run_until(lambda: rig.shaft.at_speed, 300, "speed")
    return led


def taken(rig: Rig) -> dict[str, np.ndarray]:
    values = np.concatenate([block.values for block in rig.shaft.take()], axis=1)
    return dict(zip([one.name for one in rig.shaft.channels], values, strict=True))


def test_yaw_without_sway_as_told_and_as_moved(turning: tuple[Rig, World]) -> None:
    rig, _ = turning
    rig.shaft.take()
    rig.photocell.take()
    pulses = []
    while len(pulses) < 2:
        rig.cycle()
        pulses += rig.photocell.take()
    got = taken(rig)
    assert pulses[1].time_s - pulses[0].time_s == pytest.approx(1.0 / FREQUENCY_HZ, abs=1e-9)
    at = pulses[1].time_s * RATE_HZ - (rig.number + 1 - len(got["shaft_angle"]))
    passed = np.interp(at, np.arange(len(got["shaft_angle"])), got["shaft_angle"])
    assert passed == pytest.approx(pulses[1].shaft_angle_rad, abs=1e-9)
    turn = slice(-round(RATE_HZ / FREQUENCY_HZ), None)
    angle = got["shaft_angle"][turn]
    assert np.diff(angle) == pytest.approx(2.0 * math.pi * FREQUENCY_HZ / RATE_HZ, rel=1e-9)
    for kind, allowed in (("command", TOLD_IMPURE), ("displacement", MOVED_IMPURE)):
        struts = np.array([got[f"{kind}_aft"][turn], got[f"{kind}_fore"][turn]])
        _, rate, across = drawn(HORIZONTAL_1963, SPEED, struts, FREQUENCY_HZ)
        bow = HORIZONTAL_1963.half_spacing_m * np.abs(rate).max()
        assert np.abs(across).max() < allowed * bow
        spectrum = np.abs(np.fft.rfft(rate))
        assert np.delete(spectrum, 1).max() < allowed * spectrum[1]


@pytest.mark.slow
def test_following_under_load_is_that_of_the_loop_integrated(led: tuple[Rig, World]) -> None:
    """From power on: standing, going to the path, running up, running."""
    rig, world = led
    without_power(rig)
    ready(rig)
    rig.shaft.take()
    first = rig.number + 1
    forces, begun = [], rig.shaft.struts[0].position
    rig.shaft.follow(PURE)
    rig.eccentricity.move_to(AMPLITUDE)
    for count in range(120):
        if count == 60:
            rig.shaft.turn(FREQUENCY_HZ)
        rig.cycle()
        forces.append(world.plant.value("force_aft"))
    got = taken(rig)
    assert len(got["displacement_aft"]) == rig.number - first + 1
    command, moved = got["command_aft"], got["displacement_aft"]
    assert np.abs(command).max() > 0.9 * AMPLITUDE
    assert np.abs(forces).max() > 50.0
    found = integrated(PositionLoop(), begun, command, np.array(forces))
    # In the first period the drive stands: it takes its first set-point with the second SYNC.
    assert moved[2:] == pytest.approx(found[2:], abs=1.5 * COUNT_M)
    assert np.abs(moved - command).max() > 200.0 * COUNT_M


def integrated(loop: PositionLoop, start: float, told: np.ndarray, force: np.ndarray) -> np.ndarray:
    period, state, places = 1.0 / RATE_HZ, np.array([start, 0.0, 0.0]), [start]
    before = told[0]
    for n in range(len(told) - 1):
        # The parabola through three set-points, by its values at -1, 0 and 1 periods.
        bend, slope, level = np.polyfit([-period, 0.0, period], [before, *told[n : n + 2]], 2)
        before = told[n]

        def rates(
            t: float,
            y: np.ndarray,
            n: int = n,
            bend: float = bend,
            slope: float = slope,
            level: float = level,
        ) -> list[float]:
            ahead = level + (slope + bend * t) * t - y[0]
            error = slope + 2.0 * bend * t + loop.position_per_s * ahead - y[1]
            pushed = loop.speed_per_s * error + loop.integral_per_s2 * y[2]
            return [y[1], pushed - force[n] / loop.moved_kg, error]

        state = solve_ivp(rates, (0.0, period), state, method="DOP853", rtol=1e-8, atol=1e-11).y[
            :, -1
        ]
        places.append(state[0])
    return np.array(places)


def fail(rig: Rig, cycles: int) -> list[str]:
    """Cycle on; return what was raised."""
    told = []
    for _ in range(cycles):
        try:
            rig.cycle()
        except HardwareError as error:
            told += [str(error), *getattr(error, "__notes__", [])]
    return told


def at_rest(rig: Rig, world: World) -> bool:
    drives = [world.nodes["shaft.aft"], world.nodes["shaft.fore"]]
    still = all(drive.speed == 0.0 and drive.standing for drive in drives)
    return still and not rig.shaft.moving and not rig.shaft.enabled


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ("lost-sync 3", "SYNC stayed away or came unevenly"),
        ("late-set-point shaft.aft 3", "a set-point came too late for its SYNC"),
    ],
)
def test_it_ends_at_rest(turning: tuple[Rig, World], words: str, sentence: str) -> None:
    rig, world = turning
    inject(world, words)
    told = fail(rig, REST_CYCLES)
    assert any(sentence in one for one in told)
    assert at_rest(rig, world)
    assert rig.faults


def test_a_clock_that_jumps_ends_at_rest(turning: tuple[Rig, World]) -> None:
    rig, world = turning
    now = [0.0]
    before = rig._pacer
    rig._pacer = RealTime(1.0 / RATE_HZ, lambda: now[0], lambda s: now.__setitem__(0, now[0] + s))
    assert fail(rig, 5) == []
    now[0] += 0.9 / RATE_HZ
    assert fail(rig, 5) == []  # late, and within a period
    now[0] += 5.0
    told = fail(rig, REST_CYCLES)
    rig._pacer = before
    assert any("set-points have lost their time" in one for one in told)
    assert any(isinstance(one, CycleJumpError) for one in rig.faults)
    assert at_rest(rig, world)


@pytest.mark.parametrize("words", ["lost-sync 1", "late-set-point shaft.fore 1"])
def test_one_is_bridged(turning: tuple[Rig, World], words: str) -> None:
    rig, world = turning
    inject(world, words)
    rig.shaft.take()
    assert fail(rig, 40) == []
    got = taken(rig)
    assert np.abs(got["displacement_fore"] - got["command_fore"])[-20:].max() < 1e-3


def test_a_blocked_strut_ends_at_rest_and_a_reset_lets_it_go_on(
    turning: tuple[Rig, World],
) -> None:
    rig, world = turning
    inject(world, "block shaft.aft")
    assert any("outside its window" in one for one in fail(rig, REST_CYCLES))
    assert at_rest(rig, world)
    inject(world, "free shaft.aft")
    rig.reset()
    rig.shaft.enable()
    rig.run_until(lambda: rig.shaft.enabled, 100, "enable")
    rig.shaft.turn(FREQUENCY_HZ)
    assert not rig.shaft.at_speed  # first to the path, at its own speed
    rig.run_until(lambda: rig.shaft.at_speed, 1000, "speed")
    assert fail(rig, 20) == []


def test_many_lines_are_followed_by_the_program_itself(led: tuple[Rig, World]) -> None:
    lines = multisine((1, 3, 5), np.array([1.0, 1 / 3, 1 / 5]), (0.0,))
    rig, _ = led
    without_power(rig)
    ready(rig)
    rig.shaft.follow(lines)
    rig.eccentricity.move_to(0.05)
    rig.run_until(lambda: rig.eccentricity.settled, 1000, "the path's beginning")
    rig.shaft.turn(0.5)
    rig.run_until(lambda: rig.shaft.at_speed, 300, "speed")
    rig.shaft.take()
    for _ in range(round(RATE_HZ)):
        rig.cycle()
    got = taken(rig)
    angle = got["shaft_angle"] % (2.0 * math.pi)
    places = 0.05 * struts_over_turn(lines, least=100_000)[0]
    near = places[np.round(angle / (2.0 * math.pi) * len(places)).astype(int) % len(places)]
    assert got["command_aft"] == pytest.approx(near, abs=1e-5)


@pytest.mark.parametrize(
    ("frequency_hz", "words"),
    [(0.9, "speed of 1.093 at 0.549 s"), (2.0, "of its period is beyond"), (3.0, "outside")],
)
def test_a_path_beyond_the_struts_is_refused_with_its_place(
    turning: tuple[Rig, World], frequency_hz: float, words: str
) -> None:
    rig, _ = turning
    rig.shaft.stop()
    rig.run_until(lambda: not rig.shaft.moving, 500, "stop")
    with pytest.raises(LimitError, match=words):
        rig.shaft.turn(frequency_hz)


def test_settings_need_struts_that_follow_paths() -> None:
    tables = {"eccentricity": PATHS["eccentricity"]}
    configuration = read_rig(tables, DRIVERS)
    with pytest.raises(ConfigurationError, match="path-struts"):
        Rig(configuration, lambda: 0.0, RealTime(0.01, lambda: 0.0, lambda _: None), lambda _: None)
