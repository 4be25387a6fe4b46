"""What goes over the bus, byte for byte, after CiA 301, 402 and 404."""

import struct
from contextlib import contextmanager

import pytest

from hardware.errors import EmergencyError
from hardware.lines import LineKind, SerialLine, decode, encode
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from tests.hardware.doubles import Amplifier, Drive
from tests.hardware.rigs import ECCENTRICITY, FORCES, SHAFT, bench, bus_table, nobody, on_bus, still


@contextmanager
def logged(tables, build, **bus):
    """A rig with the log of its frames: identifier, bytes in hexadecimal."""
    log = []
    with bench("bytes") as network:
        double = build(network)
        configuration = read_rig({"bus": bus_table("bytes", "pumped", **bus), **tables}, DRIVERS)
        note = lambda frame: log.append((frame.arbitration_id, bytes(frame.data).hex()))  # noqa: E731
        with Rig(configuration, still, FreeRunning(), nobody, (note,)) as rig:
            rig.prepare()
            yield rig, double, log


def frames(log, identifier):
    return [data for one, data in log if one == identifier]


def test_the_communication_objects_are_written_as_cia_301_says() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (_, _double, log):
        requests = frames(log, 0x601)
    # 2F/2B/23: download of 1, 2 or 4 bytes; index little end first, sub-index, data.
    assert "23051000" + "80000000" in requests  # 1005: SYNC is 0x80
    assert "23061000" + "10270000" in requests  # 1006: 10 000 us
    watched = [one for one in requests if one.startswith("23161001")]
    # 1016:1: first nobody, so that monitoring begins anew, then node 127, 300 ms
    assert watched == ["23161001" + "00000000", "23161001" + "2c017f00"]
    assert "2b171000" + "64000000" in requests  # 1017: 100 ms
    assert "2f191000" + "f0000000" in requests  # 1019: counter to 240
    assert "2b076000" + "03000000" in requests  # 6007: quick stop
    mapping = [one for one in requests if one[2:6] in ("001a", "0018")]
    assert mapping[:7] == [
        "23001801" + "81010080",  # off
        "2f001802" + "01000000",  # with every SYNC
        "2f001a00" + "00000000",  # no entries
        "23001a01" + "10004160",  # 6041, 16 bits
        "23001a02" + "08006160",  # 6061, 8 bits
        "23001a03" + "20006460",  # 6064, 32 bits
        "2f001a00" + "03000000",
    ]
    assert mapping[7] == "23001801" + "81010000"  # on


def test_nodes_are_configured_before_they_are_started() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (_, _double, log):
        nmt = [i for i, (identifier, _) in enumerate(log) if identifier == 0]
        assert [log[i][1] for i in nmt] == ["8000", "0100"]
        assert nmt[0] < min(i for i, (one, _) in enumerate(log) if one == 0x601)
        assert nmt[1] > max(i for i, (one, _) in enumerate(log) if one == 0x601)


def test_sync_counts_from_one_to_its_overflow_and_begins_anew() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1), sync_overflow=3) as (rig, _, log):
        log.clear()
        for _ in range(5):
            rig.cycle()
        assert frames(log, 0x80) == ["01", "02", "03", "01", "02"]


def test_sync_without_a_counter_is_empty() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1), sync_overflow=0) as (rig, _, log):
        log.clear()
        rig.cycle()
        assert frames(log, 0x80) == [""]


def test_the_heartbeat_is_the_masters_every_tenth_cycle() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, _, log):
        for _ in range(100):
            rig.cycle()
        assert frames(log, 0x77F) == ["05"] * 10


def test_the_shafts_rpdo_through_a_run() -> None:
    with logged({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, _, log):
        rig.cycle()
        rig.shaft.enable()
        rig.run_until(lambda: rig.shaft.enabled, 20, "enable")
        rig.shaft.turn(0.5)
        rig.cycle()
        rig.shaft.quick_stop()
        rig.cycle()
        seen = [one for one, before in _pairs(frames(log, 0x201)) if one != before]
    # Control word, mode 3, target velocity: 0.5 Hz of 10 000 counts is 5000 = 0x1388.
    # Until positions show rest, a drive that was left turning must not lose its power.
    assert seen == [
        "020003" + "00000000",
        "060003" + "00000000",
        "070003" + "00000000",
        "0f0003" + "00000000",
        "0f0003" + "88130000",
        "020003" + "00000000",
    ]


def test_the_axis_rpdo_through_homing_and_a_move() -> None:
    build = lambda n: Drive(n, 2)  # noqa: E731
    with logged({"eccentricity": ECCENTRICITY}, build) as (rig, _, log):
        axis = rig.eccentricity
        axis.enable()
        rig.run_until(lambda: axis.enabled, 20, "enable")
        log.clear()
        axis.home()
        rig.run_until(lambda: axis.homed and not axis.moving, 20, "home")
        axis.move_to(0.03)
        rig.run_until(lambda: axis.settled, 20, "move")
        rig.cycle()
        seen = [one for one, before in _pairs(frames(log, 0x202)) if one != before]
    # Control word, mode, target: 0.03 m of 1 000 000 counts is 30 000 = 0x7530.
    assert seen == [
        "0f0006" + "00000000",  # homing
        "1f0006" + "00000000",  # start
        "0f0006" + "00000000",  # attained
        "0f0001" + "30750000",  # profile position, target
        "3f0001" + "30750000",  # new set-point, change at once
        "0f0001" + "30750000",  # acknowledged
    ]


def _pairs(items):
    return list(zip(items, ["", *items], strict=False))


@pytest.mark.parametrize(
    ("index", "raw", "data"),
    [
        ("9130", -123456, struct.pack("<i", -123456)),
        ("7130", -12345, struct.pack("<h", -12345)),
        ("6130", 0.15625, bytes.fromhex("0000203e")),
    ],
)
def test_an_amplifiers_type_follows_its_eds_and_scale_its_configuration(index, raw, data) -> None:
    channel = {"name": "force_aft", "object": f"{index}:1", "scale": -2.0, "full_scale": 1e6}
    table = {**FORCES, "channels": [channel], "tpdos": [[f"{index}:1"]]}
    with logged({"forces": [table]}, lambda n: Amplifier(n, 4)) as (rig, double, log):
        double.step = lambda: double.set(int(index, 16), raw, 1)
        rig.cycle()
        assert frames(log, 0x184) == [data.hex()]
        (block,) = rig.forces[0].take()
        assert block.first == 1
        assert block.values == pytest.approx(-2.0 * raw)


@pytest.mark.parametrize(
    ("source", "written"),
    [
        (1, ["2bb8600000000000", "2bb8600013000000"]),
        # The drive is told its source by 60D0, and by bit 3 of the function to look there.
        (6, ["2bb8600000000000", "2bd0600106000000", "2bb860001b000000"]),
    ],
)
def test_the_touch_probe_is_armed_after_a_zero(source: int, written: list[str]) -> None:
    tables = {"shaft": SHAFT, "photocell": {"driver": "touch-probe", "source": source}}
    with logged(tables, lambda n: Drive(n, 1)) as (_, _double, log):
        probe = [one for one in frames(log, 0x601) if one[2:6] in ("b860", "d060")]
    assert probe == written


def test_an_emergency_carries_code_and_register() -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, double):
        rig.cycle()
        double.network.send_message(0x081, bytes.fromhex("2023" + "09" + "0102030405"))
        with pytest.raises(EmergencyError, match=r"0x2320.*0x09.*0102030405") as caught:
            rig.cycle()
        assert (caught.value.code, caught.value.register) == (0x2320, 0x09)


def test_lines_of_the_timestamper() -> None:
    line = SerialLine(LineKind.PULSE, 17, 4294967295, 3)
    assert encode(line) == b"P,17,4294967295,3*44\r\n"
    assert decode(b"P,17,4294967295,3*44\r", "cell") == line
