"""Each fault of the simulated rig is seen by the hardware layer in time, as its own type."""

from contextlib import suppress

import pytest

from hardware.cia402 import DriveState
from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry
from hardware.errors import (
    BridgeSaturatedError,
    BusOffError,
    DeadReceiveThreadError,
    DriveFaultError,
    DriveStateError,
    EmergencyError,
    ErrorFramesError,
    FollowingError,
    HardwareError,
    HeartbeatLostError,
    NodeStateError,
    PhotocellDeadError,
    PhotocellExtraError,
    PhotocellMissedError,
    ProcessDataLostError,
    SdoTimeoutError,
    SensorInvalidError,
    SilentPortError,
    StuckSensorError,
    UnpluggedError,
)
from sim.devices.faults import FAULTS, inject
from tests.sim.devices.benches import WHOLE, amplifier, by_word, in_process, ready, slotted, turning

STUCK_S = 0.3
# Homed where they stand, so that no test waits for axes.
SET = {
    "eccentricity": {**WHOLE["eccentricity"], "home_position": 0.02},
    "phase": {**WHOLE["phase"], "home_position": 0.5},
}
TABLES = {**WHOLE, "forces": [amplifier(4, "force_aft", "force_fore", stuck_s=STUCK_S)]}
A_SECOND, A_TURN = 100, 100  # cycles at 100 Hz and one turn a second


@pytest.fixture
def turned():
    """A rig whose shaft turns once a second."""
    start = {"eccentricity_m": 0.0199, "strut_phase_rad": 0.499}
    with in_process({**TABLES, **SET}, **start) as (rig, world):
        turning(rig, 0.02, 0.5, 1.0)
        yield rig, world


def cycles_to(rig, kind, limit: int) -> int:
    """Return how many cycles it takes until a fault of a kind is raised, or latched beside another.

    A fault may bring others with it: a drive in fault sends an emergency message too.
    """
    for count in range(1, limit + 1):
        try:
            rig.cycle()
        except HardwareError as error:
            if any(isinstance(one, kind) for one in (error, *rig.faults)):
                return count
    raise AssertionError(f"no {kind.__name__} within {limit} cycles")


@pytest.mark.sample(6)
@pytest.mark.parametrize(
    ("words", "kind", "limit"),
    [
        ("heartbeat phase", HeartbeatLostError, 10 + 3 + 1),
        ("silence eccentricity", ProcessDataLostError, 4),
        ("boot phase", NodeStateError, 1),
        ("emergency eccentricity 4210", EmergencyError, 1),
        ("emergency shaft 8611", FollowingError, 1),
        ("drive-fault phase 3210", DriveFaultError, 1),
        ("bus-off", BusOffError, 1),
        ("error-frame 17", ErrorFramesError, 1),
        ("deaf", DeadReceiveThreadError, 1),
        # The window of 0.1 turns takes 10 cycles at one turn a second, its time two more.
        ("block shaft", FollowingError, 10 + 2 + 2),
        ("push force_fore 480", BridgeSaturatedError, A_TURN),
        ("push force_aft -9000", BridgeSaturatedError, 1),
        ("broken force_aft", SensorInvalidError, 1),
        ("stuck force_aft", StuckSensorError, round(STUCK_S * 100) + 1),
        ("missed 1", PhotocellMissedError, round(2.5 * A_TURN) + 1),
        ("missed 9", PhotocellMissedError, round(1.5 * A_TURN) + A_TURN + 1),
    ],
)
def test_a_fault_is_seen_in_time(turned, words: str, kind, limit: int) -> None:
    rig, world = turned
    rig.photocell.expect(1.0)
    inject(world, words)
    assert cycles_to(rig, kind, limit) <= limit


def test_pulses_that_stay_away_are_a_dead_photocell(turned) -> None:
    rig, world = turned
    inject(world, "missed 9")
    assert (
        3 * A_TURN
        < cycles_to(rig, PhotocellMissedError, 300) + cycles_to(rig, PhotocellDeadError, 300)
        <= round(3.5 * A_TURN) + A_TURN + 1
    )


def test_an_extra_pulse_is_seen_when_it_comes(turned) -> None:
    rig, world = turned
    rig.run_until(lambda: bool(rig.photocell.take()), 200, "pulse")
    for _ in range(20):
        rig.cycle()
    inject(world, "extra")
    assert cycles_to(rig, PhotocellExtraError, 1) == 1


@pytest.mark.slow
def test_a_blocked_axis_faults_and_moves_again_after_a_reset() -> None:
    with in_process(TABLES) as (rig, world):
        ready(rig)
        rig.eccentricity.move_to(0.02)
        for _ in range(20):
            rig.cycle()
        inject(world, "block eccentricity")
        stood = world.nodes["eccentricity"].position
        # The window of 1 mm takes 20 cycles at 5 mm/s, its time two more.
        cycles_to(rig, FollowingError, 25)
        assert world.nodes["eccentricity"].position == stood
        inject(world, "free eccentricity")
        for _ in range(20):
            rig.cycle()
        rig.reset()
        for _ in range(5):
            rig.cycle()
        rig.eccentricity.enable()
        rig.run_until(lambda: rig.eccentricity.enabled, 50, "enable")
        rig.eccentricity.move_to(0.02)
        rig.run_until(lambda: rig.eccentricity.settled, 600, "move")
        assert rig.eccentricity.reading.value == pytest.approx(0.02, abs=1e-5)


def test_a_fault_stops_the_shaft_on_the_quick_stop_ramp(turned) -> None:
    rig, world = turned
    inject(world, "drive-fault shaft 2310")
    cycles_to(rig, DriveFaultError, 1)
    assert world.nodes["shaft"].state is DriveState.FAULT_REACTION_ACTIVE
    count = 1
    while world.plant.speed_rad_s:
        rig.cycle()
        count += 1
    assert count == pytest.approx(20, abs=2)  # 1 Hz at 5 Hz/s
    rig.cycle()
    assert world.nodes["shaft"].state is DriveState.FAULT


def test_a_controller_that_falls_silent_is_stopped_for(turned) -> None:
    rig, world = turned
    rig.master.healthy = False
    # 300 ms after the last beat, which was at most 10 cycles ago; then the ramp of 20 cycles.
    for _ in range(10 + 30 + 2 + 20):
        with suppress(EmergencyError, DriveStateError):
            rig.cycle()
    assert world.plant.speed_rad_s == 0.0
    assert any(isinstance(one, EmergencyError) and one.code == 0x8130 for one in rig.faults)


def test_a_node_without_power_answers_no_sdo(turned) -> None:
    rig, world = turned
    world.wire.unsubscribe(0x601)
    with pytest.raises(SdoTimeoutError, match="node 1"):
        rig.master.nodes[0].sdo.read(Entry(0x1000))


@pytest.fixture
def stamped():
    """A rig with a timestamper on a simulated port."""
    tables = {"shaft": WHOLE["shaft"], "photocell": {"driver": "timestamper"}}
    with in_process(tables, serial=("photocell",)) as (rig, world):
        slotted(rig, by_word(world))(1.0)
        rig.photocell.expect(1.0)
        for _ in range(50):
            rig.cycle()
        yield rig, world


@pytest.mark.parametrize(
    ("words", "kind", "limit"),
    [
        ("silence photocell", SilentPortError, 3 * A_SECOND + A_SECOND + 1),
        ("unplug photocell", UnpluggedError, 1),
        ("missed 1", PhotocellMissedError, round(1.5 * A_TURN) + 1),
        ("extra", PhotocellExtraError, 1 + A_TURN),
    ],
)
def test_a_fault_of_a_serial_device_is_seen_in_time(stamped, words, kind, limit: int) -> None:
    rig, world = stamped
    inject(world, words)
    assert cycles_to(rig, kind, limit) <= limit


def test_an_unplugged_port_is_plugged_in_and_reset(stamped) -> None:
    rig, world = stamped
    inject(world, "unplug photocell")
    cycles_to(rig, UnpluggedError, 1)
    inject(world, "plug photocell")
    rig.photocell.expect(None)
    rig.run_until(lambda: not rig.shaft.moving, 300, "rest")
    rig.reset()
    assert not rig.faults
    for _ in range(80):
        rig.cycle()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("", "no fault; there are heartbeat"),
        ("fire", "no fault"),
        ("heartbeat rudder", "no node 'rudder'; there are shaft"),
        ("stuck force_x", "no channel 'force_x'; there are force_aft, force_fore"),
        ("unplug photocell", "no serial device"),
        ("missed many", "cannot be done"),
        ("boot", "cannot be done"),
        ("block forces[0]", "is no drive"),
    ],
)
def test_wrong_words_are_refused(words: str, message: str) -> None:
    with (
        in_process(TABLES) as (_, world),
        pytest.raises(ConfigurationError, match=message.replace("[", r"\[")),
    ):
        inject(world, words)


def test_every_fault_says_what_it_is() -> None:
    assert all(one.__doc__ for one in FAULTS.values())
