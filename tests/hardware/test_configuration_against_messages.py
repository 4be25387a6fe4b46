"""A wrong rig is refused before anything is opened: object, value, limit, all errors at once."""

import pytest

from hardware.bus import BusConfiguration, bus_load, frame_bits, open_bus
from hardware.description.errors import ConfigurationError
from hardware.dictionary import entry
from hardware.driver import find_driver
from hardware.errors import BusOpenError
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from tests.hardware.doubles import Drive
from tests.hardware.rigs import ECCENTRICITY, FORCES, PHASE, SHAFT, bus_table, on_bus

BUS = bus_table("nowhere", "pumped")


def refused(tables) -> str:
    with pytest.raises(ConfigurationError) as caught:
        read_rig(tables, DRIVERS)
    return str(caught.value)


def test_a_node_id_twice_is_named_with_both_owners() -> None:
    tables = {"bus": BUS, "shaft": SHAFT, "eccentricity": {**ECCENTRICITY, "node": 1}}
    assert "eccentricity.node = 1 is taken by shaft" in refused(tables)
    tables = {"bus": BUS, "shaft": {**SHAFT, "node": 127}}
    assert "shaft.node = 127 is taken by the controller" in refused(tables)
    assert "a node id is 1 to 127" in refused({"bus": BUS, "shaft": {**SHAFT, "node": 128}})


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"tpdos": [["9130:2"]]}, "object 9130:1 is in no TPDO; mapped are 9130:2"),
        ({"tpdos": [["9130:1", "9130:9"]]}, "object 9130:9 is not in the EDS"),
        ({"tpdos": [["9130:1", "6110:1"]]}, "6110:1 (AI sensor type 1) cannot be mapped"),
        ({"tpdos": [["9130:1", "9130:2", "6150:1"]]}, "take 9 bytes; the limit of a PDO is 8"),
        ({"tpdos": [["9130:1"]] * 5}, "5 tpdos; the limit is 4"),
        ({"tpdos": [["force"]]}, "'force' is no object"),
        ({"eds": "hbk.eds"}, "eds = 'hbk.eds': no such file; give a path, or one of cia401"),
        ({"nod": 3}, "forces[0].nod is not a known key; did you mean node?"),
        ({"node": "4"}, "forces[0].node = '4'"),
        ({"channels": [{"name": "force_aft"}]}, "forces[0].channels.0.object: Field required"),
    ],
)
def test_an_amplifier_that_does_not_fit(change, message: str) -> None:
    channel = {"name": "force_aft", "object": "9130:1", "scale": 1.0, "full_scale": 490.0}
    table = {**FORCES, "channels": [channel], **change}
    assert message in refused({"bus": BUS, "forces": [table]})


def test_a_file_that_is_no_eds_is_refused(tmp_path) -> None:
    for text in ("nonsense", "[1000]\nParameterName=x\nDataType=what\n", "[FileInfo]\nx=1\n"):
        (tmp_path / "bad.eds").write_text(text)
        table = {**SHAFT, "eds": str(tmp_path / "bad.eds")}
        assert "bad.eds" in refused({"bus": BUS, "shaft": table})


def test_all_errors_come_at_once() -> None:
    tables = {
        "bus": {**BUS, "sync_rate": 100.0},
        "shaft": {**SHAFT, "driver": "cia402-shaf"},
        "eccentricity": {**ECCENTRICITY, "low": 1.0},
        "photocel": {},
        "forces": [{"driver": "touch-probe"}],
    }
    message = refused(tables)
    for part in (
        "bus.sync_rate is not a known key; did you mean sync_rate_hz?",
        "shaft.driver = 'cia402-shaf' is not installed; did you mean 'cia402-shaft'?",
        "eccentricity: low = 1 has to be below high = 0.06",
        "photocel is not a known table",
        "forces[0].driver = 'touch-probe' is for photocell, not forces",
    ):
        assert part in message
    assert "is missing: it names the driver" in refused({"phase": {"node": 3}})


def test_a_drive_needs_a_bus_and_a_touch_probe_a_drive() -> None:
    assert "shaft: needs a CAN bus" in refused({"shaft": SHAFT})
    tables = {"shaft": {**SHAFT, "touch_probe": False}, "photocell": {"driver": "touch-probe"}}
    with (
        pytest.raises(ConfigurationError, match="touch_probe = true"),
        on_bus(tables, lambda n: Drive(n, 1)),
    ):
        pass


def test_answers_have_four_fifths_of_the_period_unless_it_is_said() -> None:
    assert BusConfiguration("virtual", "x", sync_rate_hz=200.0).answer_s == pytest.approx(0.004)
    assert BusConfiguration("virtual", "x", answer_ms=2000).answer_s == 2.0


def test_a_frame_is_as_long_as_the_standard_says() -> None:
    # Davis, Burns, Bril and Lukkien (2007): 55 + 10 s bits for an 11-bit identifier.
    assert [frame_bits(size) for size in range(9)] == [55 + 10 * size for size in range(9)]


def test_five_nodes_with_two_pdos_take_as_long_as_was_measured() -> None:
    load = bus_load({8: 10.0, 1: 1.0}, 1_000_000)  # one cycle a second
    assert 1.2e-3 < load < 1.45e-3


@pytest.mark.parametrize(("rate", "fits"), [(100.0, True), (250.0, True), (1000.0, False)])
def test_the_bus_load_is_checked_against_the_bit_rate(rate: float, fits: bool) -> None:
    second = {**FORCES, "node": 5, "channels": [
        {**one, "name": one["name"] + "_2"} for one in FORCES["channels"]]}  # fmt: skip
    tables = {
        "bus": {**BUS, "sync_rate_hz": rate},
        "shaft": SHAFT,
        "eccentricity": ECCENTRICITY,
        "phase": PHASE,
        "forces": [FORCES, second],
    }
    for part in tables["forces"]:
        part["tpdos"] = [["9130:1", "9130:2"], ["6150:1", "6150:2"]]
    if fits:
        assert read_rig(tables, DRIVERS).sample_rate_hz == rate
    else:
        message = refused(tables)
        assert "bus.sync_rate_hz = 1000 loads the bus with" in message
        assert "of its 1000000 bit/s; the limit is 70%. Up to" in message


@pytest.mark.parametrize("rate", [0.0, -5.0, -1e308, 1e308, 10_001.0])
def test_a_rate_that_no_bus_has_is_refused(rate: float) -> None:
    message = refused({"bus": {**BUS, "sync_rate_hz": rate}, "shaft": SHAFT})
    assert f"sync_rate_hz = {rate:g} has to be above 0, at most 10000" in message


@pytest.mark.parametrize(("limit_ms", "beat_ms"), [(0, 100), (100, 100), (300, 0), (-1, 100)])
def test_a_bus_on_which_no_drive_misses_the_program_is_refused(limit_ms: int, beat_ms: int) -> None:
    bus = {**BUS, "heartbeat_limit_ms": limit_ms, "heartbeat_ms": beat_ms}
    message = refused({"bus": bus, "shaft": SHAFT})
    assert f"heartbeat_limit_ms = {limit_ms} has to be above heartbeat_ms = {beat_ms}" in message


def test_a_channel_name_twice_is_refused() -> None:
    second = {**FORCES, "node": 5}
    assert "'force_aft' is there 2 times" in refused({"bus": BUS, "forces": [FORCES, second]})


@pytest.mark.parametrize("text", ["6041", "0x6041", "9130:1"])
def test_objects_are_written_as_in_the_manuals(text: str) -> None:
    assert str(entry(text)) in ("6041:0", "9130:1")


def test_a_bus_that_cannot_be_opened_is_named() -> None:
    with pytest.raises(BusOpenError, match="bus nosuch:can0"):
        open_bus(BusConfiguration("nosuch", "can0"))
    with pytest.raises(BusOpenError, match="slcan:/dev/nosuch"):
        open_bus(BusConfiguration("slcan", "/dev/nosuch"))


def test_a_driver_package_that_is_broken_is_named() -> None:
    from importlib.metadata import EntryPoint

    broken = (EntryPoint("x", "no_such_module:DRIVER", "pmm.drivers"),)
    with pytest.raises(ConfigurationError, match="no_such_module:DRIVER cannot be loaded"):
        find_driver("x", "shaft", broken)
    wrong = (EntryPoint("x", "math:pi", "pmm.drivers"),)
    with pytest.raises(ConfigurationError, match=r"math:pi is no hardware.driver.Driver"):
        find_driver("x", "shaft", wrong)


def test_a_drive_without_the_mode_is_refused() -> None:
    def lame(network):
        drive = Drive(network, 2)
        drive.set(0x6502, 0x04)
        return drive

    with (
        pytest.raises(ConfigurationError, match=r"does not support profile_position.*0x00000004"),
        on_bus({"eccentricity": ECCENTRICITY}, lame),
    ):
        pass
