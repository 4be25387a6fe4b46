"""Every guard shown to work: each fault is seen within its cycles and raised as its own type."""

import threading
import time

import can
import pytest

from hardware.bus import Threaded
from hardware.dictionary import Entry
from hardware.errors import (
    BridgeSaturatedError,
    BusOffError,
    DeadReceiveThreadError,
    DriveFaultError,
    EmergencyError,
    ErrorFramesError,
    FollowingError,
    HeartbeatLostError,
    NodeStateError,
    NotReadyError,
    ProcessDataLostError,
    Reaction,
    SdoAbortError,
    SdoInCallbackError,
    SdoTimeoutError,
    SensorInvalidError,
    StuckSensorError,
    TransitionTimeoutError,
)
from tests.hardware.doubles import Amplifier, Drive, PumpedBus
from tests.hardware.rigs import ECCENTRICITY, FORCES, SHAFT, on_bus, two_drives


@pytest.fixture
def running():
    """A rig whose shaft turns; the eccentricity stands under power."""
    tables = {"shaft": SHAFT, "eccentricity": ECCENTRICITY}
    with on_bus(tables, two_drives) as (rig, drives):
        for axis in rig.powered():
            axis.enable()
        rig.run_until(lambda: all(one.enabled for one in rig.powered()), 20, "enable")
        rig.shaft.turn(1.0)
        rig.run_until(lambda: rig.shaft.at_speed, 20, "speed")
        yield rig, drives


def cycles_to(rig, kind, limit):
    """Return how many cycles it takes until an error of a kind is raised."""
    for count in range(1, limit + 2):
        try:
            rig.cycle()
        except kind:
            return count
    raise AssertionError(f"no {kind.__name__} within {limit} cycles")


def assert_stopped(rig, drives) -> None:
    for _ in range(3):
        rig.cycle()
    assert all(one.velocity == 0 for one in drives.values())
    assert not any(one.enabled for one in rig.powered())


def test_a_lost_heartbeat_stops_all_axes(running) -> None:
    rig, drives = running
    drives["eccentricity"].beating = False
    assert cycles_to(rig, HeartbeatLostError, 14) <= 10 + 3 + 1
    assert_stopped(rig, drives)


def test_missing_process_data_stops_all_axes_after_three_cycles(running) -> None:
    rig, drives = running
    drives["eccentricity"].silent = True
    assert cycles_to(rig, ProcessDataLostError, 5) == 4
    drives["eccentricity"].silent = False
    assert_stopped(rig, drives)


def test_a_node_that_boots_is_noticed(running) -> None:
    rig, drives = running
    drives["shaft"].network.send_message(0x701, b"\0")
    assert cycles_to(rig, NodeStateError, 1) == 1


def test_an_emergency_stops_all_axes_and_is_latched(running) -> None:
    rig, drives = running
    drives["eccentricity"].emergency(0x4210)
    assert cycles_to(rig, EmergencyError, 1) == 1
    assert_stopped(rig, drives)
    with pytest.raises(NotReadyError, match="4210"):
        rig.shaft.enable()
    rig.run_until(lambda: not any(one.moving for one in rig.powered()), 400, "rest")
    rig.reset()
    rig.shaft.enable()
    rig.run_until(lambda: rig.shaft.enabled, 20, "enable")


@pytest.mark.parametrize("way", ["emergency", "fault", "bit 13"])
def test_a_following_error_has_its_own_type_however_it_is_told(running, way: str) -> None:
    rig, drives = running
    drive = drives["shaft"]
    if way == "emergency":
        drive.emergency(0x8611)
    elif way == "fault":
        drive.fault(0x8611)
    else:
        drive.step = lambda: drive.set(0x6041, 0x2637)
    assert cycles_to(rig, FollowingError, 1) == 1
    drive.step = lambda: None
    assert_stopped(rig, drives)


def test_a_drive_fault_is_raised_with_its_code_and_stops_the_others(running) -> None:
    rig, drives = running
    drives["eccentricity"].fault(0x3210)
    with pytest.raises(DriveFaultError, match="0x3210"):
        rig.cycle()
    assert_stopped(rig, drives)
    rig.run_until(lambda: not any(one.moving for one in rig.powered()), 400, "rest")
    rig.reset()
    for _ in range(4):
        rig.cycle()
    assert drives["eccentricity"].state.name == "SWITCH_ON_DISABLED"


def test_a_drive_that_does_not_obey_runs_into_its_deadline() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, drive):
        drive.obeys = False
        rig.cycle()
        rig.shaft.enable()
        assert cycles_to(rig, TransitionTimeoutError, 60) <= 52


def test_bus_off_by_a_failing_send_silences_the_heartbeat(running) -> None:
    rig, _ = running
    bus = rig.master._bus
    bus.off = True
    assert cycles_to(rig, BusOffError, 1) == 1
    assert not rig.master.healthy
    with pytest.raises(BusOffError):
        rig.cycle()
    bus.off = False
    sent = []
    rig.master._observers = (lambda frame: sent.append(frame.arbitration_id),)
    for _ in range(30):
        rig.cycle()
    assert 0x77F not in sent
    assert rig.faults[0].reaction is Reaction.END_RUN


@pytest.mark.parametrize("way", ["error frame", "state"])
def test_bus_off_as_the_adapter_tells_it(running, monkeypatch, way: str) -> None:
    rig, drives = running
    if way == "state":
        monkeypatch.setattr(PumpedBus, "state", can.BusState.ERROR)
    else:
        frame = can.Message(is_error_frame=True, arbitration_id=0x40, data=bytes(8))
        drives["shaft"].network.sent.append(frame)
    assert cycles_to(rig, BusOffError, 1) == 1


def test_error_frames_are_counted_and_raised_when_they_outrun_the_cycles(running) -> None:
    rig, drives = running
    sent = drives["shaft"].network.sent
    for _ in range(10):
        sent.append(can.Message(is_error_frame=True, arbitration_id=0x08, data=bytes(8)))
    rig.cycle()
    assert rig.master.error_frames.total == 10
    sent.extend([can.Message(is_error_frame=True, arbitration_id=0x08, data=bytes(8))] * 8)
    assert cycles_to(rig, ErrorFramesError, 1) == 1


def test_a_dead_receive_thread_is_noticed_in_the_next_cycle() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1), "virtual") as (rig, _):
        rig.cycle()

        def broken(_timeout: float) -> None:
            raise can.CanOperationError("adapter gone")

        rig.master._bus.recv = broken
        deadline = time.monotonic() + 2.0
        while rig.master._receiver._thread.is_alive() and time.monotonic() < deadline:
            time.sleep(0.005)
        assert cycles_to(rig, DeadReceiveThreadError, 1) == 1
        assert not rig.master.healthy


def test_a_bus_that_fails_in_recv_is_noticed_when_pumped(running) -> None:
    rig, _ = running
    healthy = rig.master._bus.recv

    def broken(_timeout: float) -> None:
        raise OSError("no such device")

    rig.master._bus.recv = broken
    with pytest.raises(DeadReceiveThreadError, match="no such device"):
        rig.cycle()
    rig.master._bus.recv = healthy


def test_the_receive_thread_ends_with_the_receiver() -> None:
    bus = can.Bus(interface="virtual", channel="ends", ignore_config=True)
    receiver = Threaded(bus)
    receiver.close()
    bus.shutdown()
    assert not [one for one in threading.enumerate() if one.name == "bus receiver"]


def test_an_sdo_that_nobody_answers_times_out(running) -> None:
    rig, drives = running
    drives["shaft"].network.unsubscribe(0x601)
    with pytest.raises(SdoTimeoutError, match=r"shaft \(node 1\).*1000:0.*0.3 s"):
        rig.master.nodes[0].sdo.read(Entry(0x1000))


@pytest.mark.slow
def test_an_sdo_times_out_in_real_time_too() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1), "virtual") as (rig, drive):
        drive.network.unsubscribe(0x601)
        begun = time.monotonic()
        with pytest.raises(SdoTimeoutError):
            rig.master.nodes[0].sdo.read(Entry(0x1000))
        assert 0.25 < time.monotonic() - begun < 0.6


def test_a_refused_sdo_carries_its_code(running) -> None:
    rig, _ = running
    with pytest.raises(SdoAbortError, match="read only") as caught:
        rig.master.nodes[0].sdo.write(Entry(0x6041), 0)
    assert caught.value.code == 0x06010002


def test_an_sdo_within_a_receive_callback_is_refused_instead_of_hanging(running) -> None:
    rig, _ = running
    sdo = rig.master.nodes[0].sdo
    rig.master._observers = (lambda _frame: sdo.read(Entry(0x1000)) if rig.master.delivering
                             else None,)  # fmt: skip
    with pytest.raises(SdoInCallbackError, match="between cycles"):
        rig.cycle()


def test_sdos_from_many_threads_do_not_mix() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1), "virtual") as (rig, _):
        sdo = rig.master.nodes[0].sdo
        wanted = {Entry(0x6502): 0xA5, Entry(0x1017): 100, Entry(0x6007): 3}
        wrong = []

        def ask(at: Entry) -> None:
            wrong.extend(value for _ in range(20) if (value := sdo.read(at)) != wanted[at])

        threads = [threading.Thread(target=ask, args=(at,)) for at in wanted]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        assert not wrong


def test_a_frame_of_the_wrong_length_is_no_data(running) -> None:
    rig, drives = running
    drives["shaft"].network.send_message(0x181, b"\x37\x02\x03")
    with pytest.raises(ProcessDataLostError, match=r"3 bytes .* has 7"):
        rig.cycle()


@pytest.mark.slow
def test_a_babbling_node_does_not_hold_the_loop(running) -> None:
    rig, _ = running
    noise = can.Message(arbitration_id=0x123, data=b"", is_extended_id=False)
    rig.master._bus.recv = lambda _timeout: noise
    for _ in range(2):
        rig.cycle()


@pytest.fixture
def measuring():
    table = {**FORCES, "tpdos": [["9130:1", "9130:2"], ["6150:1", "6150:2"]], "stuck_s": 0.5}
    with on_bus({"forces": [table]}, lambda n: Amplifier(n, 4)) as (rig, amplifier):
        rig.cycle()
        yield rig, amplifier


@pytest.mark.parametrize("raw", [49_000, -49_000])
def test_a_saturated_bridge_is_raised_in_its_cycle(measuring, raw: int) -> None:
    rig, amplifier = measuring
    amplifier.raw[1] = raw - (raw < 0)
    with pytest.raises(BridgeSaturatedError, match=r"force_fore = -?490.*full scale 490 N"):
        rig.cycle()


def test_an_overload_bit_counts_as_saturated_and_an_invalid_value_becomes_nan(measuring) -> None:
    rig, amplifier = measuring
    amplifier.set(0x6150, 0x02, 1)
    with pytest.raises(BridgeSaturatedError, match=r"force_aft.*0x02"):
        rig.cycle()
    amplifier.set(0x6150, 0x01, 1)
    rig.forces[0].take()
    with pytest.raises(SensorInvalidError, match="force_aft"):
        rig.cycle()
    (block,) = rig.forces[0].take()
    assert str(block.values[0, 0]) == "nan"
    assert block.values[1, 0] == pytest.approx(0.0, abs=0.02)


def test_a_stuck_sensor_is_noticed(measuring) -> None:
    rig, amplifier = measuring
    amplifier.step = lambda: None
    assert cycles_to(rig, StuckSensorError, 52) <= 52
