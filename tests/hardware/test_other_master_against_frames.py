"""Another master on a bus, by raw frames of CiA 301: no start beside it, no run against it."""

from collections.abc import Callable

import can
import pytest

from hardware.errors import OtherMasterError, Reaction
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from tests.hardware.doubles import Drive, Network
from tests.hardware.rigs import SHAFT, bench, bus_table, nobody, on_bus, still

COMMANDS = {
    "NMT pre-operational to all nodes": (0x000, "8000"),
    "NMT start to node 5": (0x000, "0105"),
    "SYNC": (0x080, ""),
    "a heartbeat of node 127": (0x77F, "05"),
    "an SDO write to node 1": (0x601, "2b40600006000000"),
    "an SDO write to node 9": (0x609, "0000000000000000"),  # a segment
    "process data 0x201": (0x201, "0f00"),
    "an LSS command": (0x7E5, "0401000000000000"),
}
QUESTIONS = {"an SDO request to node 3": (0x603, "4000100000000000")}
HARMLESS = (
    (0x185, "0000"),  # another node's process data
    (0x705, "05"),  # its heartbeat
    (0x706, "00"),  # a boot-up message
    (0x085, "0010010000000000"),  # its emergency
    (0x585, "4300100000000000"),  # its answer to a question
    (0x100, "000000000000"),  # the time of day
)


def _frame(at: int, data: str) -> can.Message:
    return can.Message(arbitration_id=at, data=bytes.fromhex(data), is_extended_id=False)


def _started(*heard: can.Message) -> list[tuple[int, str]]:
    """Start a rig on a bus where frames are under way; return what it has sent."""
    sent: list[tuple[int, str]] = []

    def note(frame: can.Message) -> None:
        if not frame.is_rx:
            sent.append((frame.arbitration_id, bytes(frame.data).hex()))

    with bench("company") as network:
        Drive(network, 1)
        network.sent.extend(heard)
        tables = {"bus": bus_table("company", "pumped"), "shaft": SHAFT}
        try:
            with Rig(read_rig(tables, DRIVERS), still, FreeRunning(), nobody, (note,)) as rig:
                rig.prepare()
        except OtherMasterError:
            assert not sent, "something was sent beside another master"
            raise
    return sent


@pytest.mark.parametrize("said", [*COMMANDS, *QUESTIONS])
def test_a_start_beside_another_master_is_refused_and_nothing_is_sent(said: str) -> None:
    with pytest.raises(OtherMasterError, match="another controller is on it") as found:
        _started(_frame(*{**COMMANDS, **QUESTIONS}[said]))
    assert said in str(found.value)


def test_node_guarding_is_a_masters_question() -> None:
    asked = can.Message(arbitration_id=0x704, is_remote_frame=True, is_extended_id=False, dlc=1)
    with pytest.raises(OtherMasterError, match="node guarding of node 4"):
        _started(asked)


def test_what_nodes_say_by_themselves_is_no_master() -> None:
    extended = can.Message(arbitration_id=0x080, is_extended_id=True)
    sent = _started(*(_frame(*one) for one in HARMLESS), extended)
    assert (0x000, "0100") in sent


def _turning(network: Network) -> Drive:
    return Drive(network, 1)


@pytest.mark.parametrize("said", COMMANDS)
def test_a_command_of_another_stops_the_axes_and_the_heartbeat_until_a_reset(said: str) -> None:
    sent: list[tuple[int, str]] = []
    with on_bus({"shaft": SHAFT}, _turning) as (rig, drive):
        rig.master._observers = (
            lambda one: one.is_rx or sent.append((one.arbitration_id, bytes(one.data).hex())),
        )
        _run(rig, lambda: rig.shaft.enabled, rig.shaft.enable)
        _run(rig, lambda: rig.shaft.at_speed, lambda: rig.shaft.turn(0.5))
        drive.network.sent.append(_frame(*COMMANDS[said]))
        with pytest.raises(OtherMasterError, match="another controller sent") as found:
            rig.cycle()
        assert said in str(found.value)
        assert found.value.reaction is Reaction.END_RUN
        assert drive.velocity == 0  # the quick stop has come
        sent.clear()
        for _ in range(30):
            rig.cycle()  # told once
        assert 0x77F not in dict(sent)
        rig.reset()
        for _ in range(30):
            rig.cycle()
        assert 0x77F in dict(sent)


@pytest.mark.parametrize("said", QUESTIONS)
def test_who_only_asks_may_while_the_rig_runs(said: str) -> None:
    with on_bus({"shaft": SHAFT}, _turning) as (rig, drive):
        drive.network.sent.append(_frame(*QUESTIONS[said]))
        for _ in range(5):
            rig.cycle()
        assert not rig.faults


def test_who_has_met_another_leaves_without_a_command() -> None:
    sent: list[int] = []
    with on_bus({"shaft": SHAFT}, _turning) as (rig, drive):
        rig.master._observers = (lambda one: one.is_rx or sent.append(one.arbitration_id),)
        drive.network.sent.append(_frame(*COMMANDS["SYNC"]))
        with pytest.raises(OtherMasterError):
            rig.cycle()
    assert 0x000 not in sent


def _run(rig: Rig, until: Callable[[], bool], command: Callable[[], None]) -> None:
    command()
    rig.run_until(until, 100, "command")
