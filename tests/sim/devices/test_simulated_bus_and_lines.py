"""The simulated rig by its name: entry point, file, several users, serial lines, a living host."""

import ast
import io
import os
import threading
import time
import tomllib
from pathlib import Path

import can
import pytest
import serial

from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry
from hardware.driver import Driver
from hardware.errors import BusOpenError, PortOpenError, SdoAbortError
from hardware.lines import decode
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import RigConfiguration, RigPart, read_rig
from hardware.roles import Role
from sim.devices.__main__ import main
from sim.devices.bench_file import DRIVERS, read_bench
from sim.devices.host import Host
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.slcan import SlcanAdapter
from sim.devices.terminal import PseudoTerminal
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody
from tests.sim.devices.benches import ROOT, WHOLE, amplifier, in_process, toml

TABLES = {"shaft": WHOLE["shaft"], "forces": [amplifier(4, "force_aft")]}


def test_the_package_names_the_bus_and_the_drivers_that_are_simulated() -> None:
    points = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]
    assert points["can.interface"] == {"pmm-simulated": "sim.devices.bus:SimulatedBus"}
    assert points["pmm.drivers"] == {one.name: one.value for one in DRIVERS}


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A simulated rig that takes its devices from a file beside it."""
    path = tmp_path / "simulated.toml"
    bus = {"interface": "pmm-simulated", "channel": str(path), "receive_thread": False}
    cell = {"driver": "timestamper", "port": {"url": f"sim://{path}/photocell"}}
    (tmp_path / "rig.toml").write_text(toml({"bus": bus, **TABLES, "photocell": cell}))
    path.write_text('rig = "rig.toml"\nseed = 3\neccentricity_m = 0.01\n')
    return path


def test_a_rig_comes_to_life_with_its_first_user_and_ends_with_its_last(file: Path) -> None:
    configuration = read_bench(file).configuration
    for _ in range(2):
        with Rig(configuration, lambda: 0.0, FreeRunning(), nobody) as rig:
            rig.prepare()
            for _ in range(110):
                rig.cycle()
            (block,) = rig.forces[0].take()
            assert block.values.shape == (1, 110)
    with pytest.raises(BusOpenError, match="no simulated rig 'nowhere'"):
        _open("nowhere")
    with pytest.raises(BusOpenError, match="cannot be read"):
        _open(str(file.with_name("missing.toml")))


def _open(channel: str) -> None:
    bus = {"interface": "pmm-simulated", "channel": channel, "receive_thread": False}
    Rig(read_rig({"bus": bus, **TABLES}, DRIVERS), lambda: 0.0, FreeRunning(), nobody)


def test_a_second_user_of_the_bus_sees_both_sides() -> None:
    with in_process(TABLES) as (rig, _):
        channel = rig.configuration.bus.channel
        with can.Bus(interface="pmm-simulated", channel=channel, ignore_config=True) as other:
            for _ in range(10):
                rig.cycle()
            seen = []
            while (frame := other.recv(0.0)) is not None:
                seen.append(frame)
        identifiers = {one.arbitration_id for one in seen}
        assert {0x080, 0x181, 0x184} <= identifiers
        stamps = [one.timestamp for one in seen if one.arbitration_id == 0x181]
        assert stamps == pytest.approx([0.01 * (i + 1) for i in range(10)])


def test_a_receive_thread_waits_instead_of_turning() -> None:
    bus = {"receive_thread": True}
    with in_process({**TABLES, "bus": bus}) as (rig, _):
        for _ in range(50):
            rig.cycle()
        (block,) = rig.forces[0].take()
        assert block.values.shape[1] >= 49


@pytest.mark.parametrize(
    ("at", "value", "code"),
    [
        (Entry(0x1A00, 1), 0x10000020, 0x06040041),  # the device type cannot be mapped
        (Entry(0x1A00, 1), 0x20000020, 0x06040041),  # there is no such object
        (Entry(0x1A02, 0), 3, 0x06040042),  # three positions of 32 bits
        (Entry(0x1006), 5000, 0x06090030),  # another rate than the simulated one
    ],
)
def test_a_node_refuses_what_it_cannot_do(at: Entry, value: int, code: int) -> None:
    with in_process(TABLES) as (rig, _):
        sdo = rig.master.nodes[0].sdo
        for sub in range(1, 4):
            sdo.write(Entry(0x1A02, sub), 0x60640020)
        with pytest.raises(SdoAbortError) as caught:
            sdo.write(at, value)
        assert caught.value.code == code


def test_process_objects_can_be_read_live_by_sdo() -> None:
    with in_process(TABLES, eccentricity_m=0.01) as (rig, world):
        for _ in range(5):
            rig.cycle()
        sdo = rig.master.nodes[0].sdo
        assert sdo.read(Entry(0x6041)) == world.nodes["shaft"].values[Entry(0x6041)]
        assert sdo.read(Entry(0x6064)) == world.nodes["shaft"].values[Entry(0x6064)]


def test_a_driver_without_a_simulated_device_is_refused() -> None:
    own = Driver(Role.FORCES, object, lambda *_: None)  # type: ignore[arg-type]
    rig = RigConfiguration(forces=(RigPart("forces[0]", own, object()),))
    with pytest.raises(ConfigurationError, match=r"forces\[0\].*no simulated device"):
        World(rig, Scene(vertical_rig()))


def test_a_channel_that_is_not_simulated_is_refused() -> None:
    tables = {"forces": [amplifier(4, "force_x")], "bus": {"interface": "x", "channel": "y"}}
    with pytest.raises(ConfigurationError, match=r"force_x.*it has .*force_aft, force_fore"):
        World(read_rig(tables, DRIVERS), Scene(vertical_rig()))


def test_a_bus_that_is_too_fast_is_refused_in_the_simulator_too() -> None:
    bus = {"interface": "x", "channel": "y", "sync_rate_hz": 1000.0, "bit_rate": 125_000}
    with pytest.raises(ConfigurationError, match=r"125000 bit/s; the limit is 70%"):
        read_rig({**WHOLE, "bus": bus}, DRIVERS)


def test_a_port_that_is_not_there_is_named() -> None:
    tables = {"inclinometer": {"driver": "serial-inclinometer", "port": {"url": "sim://one/tilt"}}}
    configuration = read_rig(tables, DRIVERS)
    with (
        running("one", World(configuration, Scene(vertical_rig()))),
        pytest.raises(PortOpenError, match="no serial device 'tilt'; plugged in: inclinometer"),
    ):
        Rig(configuration, lambda: 0.0, FreeRunning(), nobody)


def test_a_terminal_carries_lines_and_hangs_up() -> None:
    terminal = PseudoTerminal()
    with serial.serial_for_url(terminal.path, timeout=1.0, exclusive=True) as port:
        terminal.write(b"there\n")
        assert port.readline() == b"there\n"
        port.write(b"back")
        deadline = time.monotonic() + 1.0
        heard = b""
        while heard != b"back" and time.monotonic() < deadline:
            heard += terminal.read()
        assert heard == b"back"
    terminal.close()
    terminal.close()


@pytest.mark.parametrize(
    ("said", "answer"),
    [
        (b"O\r", b"\r"),
        (b"S8\r", b"\r"),
        (b"V\r", b"V1013\r"),
        (b"t1232AABB\r", b"\a"),  # the channel is closed
        (b"O\rt1232AABB\r", b"\rz\r"),
        (b"O\rt1232AA\r", b"\r\a"),
        (b"O\rtXYZ0\r", b"\r\a"),
        (b"!\r", b"\a"),
    ],
)
def test_the_adapter_answers_byte_for_byte(said: bytes, answer: bytes) -> None:
    adapter = SlcanAdapter()
    with serial.serial_for_url(adapter.path, timeout=0.5) as port:
        port.write(said)
        frame = adapter.recv()
        assert port.read(len(answer)) == answer
        assert (frame is not None) == (b"z" in answer)
        if frame is not None:
            assert (frame.arbitration_id, bytes(frame.data)) == (0x123, b"\xaa\xbb")
            adapter.send(can.Message(arbitration_id=0x7FF, data=b"\x05", is_extended_id=False))
            assert port.read(9) == b"t7FF105\r"
    adapter.shutdown()


def test_a_hosted_rig_lives_on_by_the_clock_and_talks_on_its_line(file: Path) -> None:
    adapter = SlcanAdapter()
    reading, writing = os.pipe()
    now = [0.0]
    answers = io.StringIO()
    with os.fdopen(reading) as commands, os.fdopen(writing, "w") as operator:
        host = Host(read_bench(file), adapter, commands, answers, lambda: now[0])
        served = threading.Thread(target=host.serve)
        served.start()
        with serial.serial_for_url(host.ports["photocell"], timeout=2.0) as port:
            now[0] = 2.5
            lines = [port.readline() for _ in range(3)]
        print("unplug photocell\nfire\nquit", file=operator, flush=True)
        served.join(5.0)
        assert not served.is_alive()
    assert [decode(one.strip(), "cell").kind for one in lines] == ["T", "T", "T"]
    assert host.world.plant.number == pytest.approx(250, abs=1)
    assert [one.split(":")[0] for one in answers.getvalue().splitlines()] == [
        "done",
        "refused",
        "done",
    ]
    host.close()
    adapter.shutdown()


def test_a_wrong_file_is_told_on_the_error_stream(tmp_path: Path, capsys) -> None:
    wrong = tmp_path / "simulated.toml"
    wrong.write_text("sead = 3\n[rig]\n")
    assert main([str(wrong)]) == 2
    assert "sead is not a known key; did you mean seed?" in capsys.readouterr().err


@pytest.mark.slow
def test_nothing_else_of_the_simulator_knows_a_bus_a_port_or_the_devices() -> None:
    """The linter keeps this too, but for parts of the hardware layer that reach no bus."""
    for path in (ROOT / "sim").rglob("*.py"):
        if path.is_relative_to(ROOT / "sim" / "devices"):
            continue
        for name in _imported(path):
            assert name.split(".")[0] not in ("can", "canopen", "serial"), path
            assert not name.startswith("sim.devices"), path
            assert not name.startswith("hardware") or name.startswith("hardware.description"), path


def _imported(path: Path) -> list[str]:
    found: list[str] = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            found += [one.name for one in node.names]
        elif isinstance(node, ast.ImportFrom):
            found.append(node.module or "")
    return found


def test_no_simulated_device_asks_for_the_time() -> None:
    """Only who hosts a rig hands a clock in."""
    for path in (ROOT / "sim" / "devices").glob("*.py"):
        if path.name != "__main__.py":
            assert not {"time", "datetime"} & set(_imported(path)), path
