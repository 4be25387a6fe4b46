"""Scan, live values, moving, photocell and push test do on a simulated rig what was put into it."""

import math

import pytest

from hardware.bus import BusConfiguration
from hardware.command_limits import check_speed
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.errors import InterlockError, LimitError
from hardware.master import Master
from hardware.objects import MappedObjects
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.scan import Ear, scan
from pmm.devices.axis_move import NOTHING_MOVED, axis_of, look, move, turn
from pmm.devices.device_readings import Live
from pmm.devices.photocell_test import watch
from pmm.devices.push_session import GaugeReadings, direction, push_each
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.benches import (
    DRIVERS,
    WHOLE,
    Hosted,
    amplifier,
    by_word,
    in_process,
    read_rig,
)

GAUGES = {"forces": [amplifier(4, "force_aft", "force_fore")]}


def swapped():
    """The two channels' objects exchanged: the cables are in each other's socket."""
    table = amplifier(4, "force_aft", "force_fore")
    first, second = table["channels"]
    first["object"], second["object"] = second["object"], first["object"]
    first["status"], second["status"] = second["status"], first["status"]
    return table


def turned_round():
    table = amplifier(4, "force_aft", "force_fore")
    table["channels"][1]["scale"] *= -1.0
    return table


def push_test(rig, within_s: float = 30.0):
    gauges = GaugeReadings(rig)
    names = tuple(one.name for one in gauges.channels)
    return list(push_each(gauges, names, Plane.VERTICAL, within_s))


def test_every_gauge_is_named_with_its_sign() -> None:
    with in_process(GAUGES) as (rig, _):
        found = push_test(rig)
    assert [(one.push.channel, one.push.sign) for one in found] == [
        ("force_aft", 1),
        ("force_fore", 1),
    ]
    assert all(one.wrong == () for one in found)
    # The simulated operator pushes with a tenth of the full scale.
    assert [one.push.change for one in found] == pytest.approx([49.0] * 2, abs=0.5)


@pytest.mark.parametrize(
    ("wiring", "signs", "said"),
    [
        (swapped, [("force_fore", 1), ("force_aft", 1)], "cables are swapped"),
        (turned_round, [("force_aft", 1), ("force_fore", -1)], "turn the sign of its `scale`"),
    ],
)
def test_wrong_wiring_is_refused_with_its_fix(wiring, signs, said) -> None:
    """The world is wired right; the rig's file, and so the cable as it sees it, is not."""
    tables = {"forces": [amplifier(4, "force_aft", "force_fore")]}
    name = "wired-wrongly"
    bus = {"interface": "pmm-simulated", "channel": name, "receive_thread": False}
    right = read_rig({"bus": bus, **tables}, DRIVERS)
    wrong = read_rig({"bus": bus, "forces": [wiring()]}, DRIVERS)
    world = World(right, Scene(vertical_rig()))
    with running(name, world), Rig(wrong, lambda: world.time_s, FreeRunning(), nobody) as rig:
        rig.prepare()
        found = push_test(rig)
    assert [(one.push.channel, one.push.sign) for one in found] == signs
    assert any(said in text for one in found for text in one.wrong)


@pytest.mark.slow
@pytest.mark.parametrize("pull", [1.0, -1.0])
def test_a_push_in_another_process_is_seen_over_slcan(tmp_path, pull: float) -> None:
    host = Hosted(GAUGES, tmp_path, "slcan", real_time=True)
    try:
        with host.rig("forces") as rig:
            last = []

            def hand(question):
                if [question] != last:
                    last[:] = [question]
                    host.say(f"push {question.channel} {pull * question.value}")

            rig.prompt = hand
            found = push_test(rig, within_s=5.0)
    finally:
        host.close()
    assert [(one.push.channel, one.push.sign) for one in found] == [
        ("force_aft", pull),
        ("force_fore", pull),
    ]
    wrong = [text for one in found for text in one.wrong]
    assert [bool(wrong), len(wrong)] == ([False, 0] if pull > 0.0 else [True, 2])


def test_a_gauge_that_nobody_pushes_is_told_after_its_time() -> None:
    with in_process(GAUGES) as (rig, _):
        rig.prompt = lambda _question: None
        before = rig.number
        found = push_test(rig, within_s=2.0)
        cycles = rig.number - before
    assert all(one.push is None for one in found)
    assert all("push harder" in one.wrong[0] for one in found)
    assert all("waited 2 s" in one.wrong[0] for one in found)
    assert cycles < 2 * (100 + 200 + 50)


@pytest.mark.parametrize(
    ("channel", "plane", "way"),
    [
        ("force_aft", Plane.VERTICAL, "up"),
        ("force_fore", Plane.HORIZONTAL, "to port"),
        ("force_x", Plane.VERTICAL, "aft"),
        ("force_aft", None, "up (vertical oscillator) or to port (horizontal)"),
    ],
)
def test_the_model_is_pushed_against_the_struts_positive_force(channel, plane, way) -> None:
    assert direction(channel, plane) == way


def test_a_rig_without_gauges_has_no_push_test() -> None:
    refused = pytest.raises(ConfigurationError, match=r"needs a \[\[forces\]\] table")
    with in_process({"shaft": WHOLE["shaft"]}) as (rig, _), refused:
        GaugeReadings(rig)


@pytest.mark.slow
def test_an_axis_homes_and_moves_within_its_limits_only() -> None:
    with in_process({"eccentricity": WHOLE["eccentricity"]}) as (rig, world):
        axis = axis_of(rig, "eccentricity")
        with pytest.raises(LimitError, match=r"0\.07 m is outside 0 to 0\.06 m; nothing was moved"):
            move(rig, axis, 0.07)
        assert rig.number == 0
        reading = move(rig, axis, 0.02)
        assert reading.value == pytest.approx(0.02, abs=1e-5)
        assert world.plant.linkage[0] == pytest.approx(0.02, abs=1e-5)
        with pytest.raises(ConfigurationError, match=r"no axis 'phase'.*has eccentricity"):
            axis_of(rig, "phase")


def test_no_axis_moves_while_the_shaft_turns() -> None:
    with in_process(WHOLE) as (rig, world):
        turn(rig, rig.shaft, 0.5)
        with pytest.raises(InterlockError, match="eccentricity: cannot home while shaft moves"):
            move(rig, axis_of(rig, "eccentricity"), 0.02)
        assert world.plant.linkage[0] == 0.0


@pytest.mark.parametrize("frequency_hz", [0.0, 2.1, -1.0, math.nan])
def test_a_speed_beyond_the_shafts_limits_is_refused(frequency_hz: float) -> None:
    refused = pytest.raises(LimitError, match=r"outside 0 to 2 Hz \(and above 0\); nothing")
    with in_process({"shaft": WHOLE["shaft"]}) as (rig, _), refused:
        check_speed(rig.shaft, frequency_hz, remark=NOTHING_MOVED)


@pytest.mark.parametrize(
    ("words", "verdicts", "said"),
    [
        ("", ["", "", "", ""], False),
        ("missed 1", ["1 missing", "", "", ""], True),
        ("extra 1", ["one too many"], True),
    ],
)
def test_the_photocell_is_tested_with_the_shaft_turning(words, verdicts, said) -> None:
    seen = []

    def count(pulse) -> None:
        seen.append(pulse.number)
        if len(seen) == 1 and words:
            inject(words)

    with in_process({"shaft": WHOLE["shaft"], "photocell": WHOLE["photocell"]}) as (rig, world):
        inject = by_word(world)
        look(rig)
        turn(rig, rig.shaft, 1.0)
        found = watch(rig, 5, 20.0, count)
    assert [one.verdict for one in found.intervals][: len(verdicts)] == verdicts
    assert bool(found.driver_messages) is said
    assert found.good is not said
    assert seen == [one.number for one in found.pulses]


def test_a_photocell_without_pulses_is_not_good() -> None:
    with in_process({"shaft": WHOLE["shaft"], "photocell": WHOLE["photocell"]}) as (rig, _):
        found = watch(rig, 5, 2.0, lambda _: None)
    assert not found.enough
    assert not found.good


def test_live_values_are_those_of_the_world() -> None:
    with in_process({**WHOLE, "forces": GAUGES["forces"]}, eccentricity_m=0.01) as (rig, world):
        by_word(world)("push force_aft 100")
        live = Live(rig)
        live.run(0.2)
        turn(rig, rig.shaft, 1.0)
        live.run(3.0)
        rows = {(one.device, one.what): one for one in live.rows()}
    assert rows["shaft", "state"].value == "operation enabled"
    assert rows["eccentricity", "state"].value == "switch on disabled"
    assert rows["shaft", "frequency"].value == pytest.approx(1.0, rel=0.02)
    assert rows["eccentricity", "homed"].value == "no"
    assert math.isnan(rows["eccentricity", "position"].value)
    assert rows["photocell", "pulses"].value in (3.0, 4.0)
    assert rows["bus", "error frames"].value == 0.0
    # Three whole turns: what the motion does to the mean is small beside the push.
    assert rows["forces[0]", "force_aft"].value == pytest.approx(100.0, abs=5.0)
    assert rows["forces[0]", "force_aft"].unit == "N"


def test_live_values_go_on_after_a_fault_and_name_it() -> None:
    with in_process(WHOLE) as (rig, world):
        live = Live(rig)
        live.run(0.1)
        by_word(world)("heartbeat eccentricity")
        live.run(1.0)
        assert len(live.said) == 1
        assert "eccentricity: no heartbeat of node 2" in live.said[0]
        assert live.rows()


def scanned(world, channel: str):
    ear = Ear()
    bus = BusConfiguration("pmm-simulated", channel, receive_thread=False)
    master = Master(bus, lambda: world.time_s, (ear,))
    return master, ear


def test_a_scan_names_every_node_and_changes_none() -> None:
    with in_process(WHOLE) as (rig, world):
        for _ in range(20):
            rig.cycle()
        before = [(one.name, one.operational, one.wire.number) for one in world.nodes.values()]
        channel = rig.configuration.bus.channel
        master, ear = scanned(world, channel)
        found = scan(master, ear)
        master.close()
        after = [(one.name, one.operational, one.wire.number) for one in world.nodes.values()]
    assert after == before
    assert [one.node_id for one in found] == [1, 2, 3, 4, 5]
    assert [one.profile for one in found] == [402, 402, 402, 404, 404]
    assert {one.state for one in found} == {"operational"}
    assert {one.heartbeat_ms for one in found} == {100}
    shaft, amplifier_aft = found[0], found[3]
    assert [str(at) for at in shaft.tpdos[0].entries] == ["6041:0", "6061:0", "6064:0"]
    assert shaft.tpdos[0].bits == (16, 8, 32)
    assert (shaft.tpdos[0].cob_id, shaft.tpdos[0].transmission) == (0x181, 1)
    assert (shaft.rpdos[0].cob_id, shaft.rpdos[0].transmission) == (0x201, 255)
    assert (shaft.vendor, shaft.product, shaft.revision, shaft.serial) == (0, 0, 1, 0)
    assert [str(at) for at in amplifier_aft.tpdos[0].entries] == ["9130:1", "9130:2"]


def test_a_node_without_heartbeat_tells_its_state_when_it_is_asked() -> None:
    with in_process(WHOLE) as (rig, world):
        master, ear = scanned(world, rig.configuration.bus.channel)
        by_word(world)("boot shaft")  # heartbeats off, pre-operational
        found = scan(master, ear)
        values = MappedObjects(master, found[:1]).read()
        master.close()
    assert (found[0].state, found[0].heartbeat_ms) == ("pre-operational", 0)
    named = {one.name: one.value for one in values}
    assert named["6041:0 Statusword"] == 0x0250
    assert named["60D5:0 Touch probe 1 positive edge counter"] == 0
