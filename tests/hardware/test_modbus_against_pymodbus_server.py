"""The Modbus drivers against a server and numbers that pymodbus makes: nothing of it is ours."""

import asyncio
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest
from pymodbus.client import ModbusTcpClient
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

from hardware.errors import PortOpenError, UnpluggedError
from hardware.modbus_registers import Register
from hardware.pacing import RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from tests.hardware.rigs import nobody
from tests.sim.devices.modbus_tables import CARRIAGE

KINDS = {
    "int16": ModbusTcpClient.DATATYPE.INT16,
    "uint16": ModbusTcpClient.DATATYPE.UINT16,
    "int32": ModbusTcpClient.DATATYPE.INT32,
    "uint32": ModbusTcpClient.DATATYPE.UINT32,
    "float32": ModbusTcpClient.DATATYPE.FLOAT32,
}
WORDS = {"high-first": "big", "low-first": "little"}


@pytest.mark.parametrize("words", WORDS)
@pytest.mark.parametrize("kind", KINDS)
def test_numbers_lie_in_registers_as_pymodbus_puts_them(kind, words) -> None:
    one = Register(0, "mm/s", kind, words=words, scale=2.0)
    counts = 12345 if kind.startswith("u") or kind == "float32" else -12345
    theirs = ModbusTcpClient.convert_to_registers(counts, KINDS[kind], WORDS[words])
    assert list(one.written(counts * 2e-3)) == theirs
    assert one.value(theirs) == pytest.approx(counts * 2e-3, rel=1e-12)


class Follower:
    """A device that runs at once at the speed that stands in its register."""

    def __init__(self) -> None:
        self.written: list[float] = []

    async def act(self, _function, start, _address, _count, registers, _values) -> None:
        asked = ModbusTcpClient.convert_from_registers(
            registers[100 - start : 102 - start], KINDS["int32"], "little"
        )
        self.written.append(asked * 1e-4)
        speed = ModbusTcpClient.convert_to_registers(asked * 1e-4, KINDS["float32"], "big")
        registers[10 - start : 12 - start] = speed
        registers[14 - start] = 0b0111  # remote, ready, no alarm (which is said by 0)
        registers[15 - start] = len(self.written)


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def served(follower: Follower, port: int | None = None) -> Iterator[int]:
    """A server of pymodbus in a thread of its own; yields its port."""
    port = free_port() if port is None else port
    loop = asyncio.new_event_loop()
    block = SimData(0, count=120, values=0, datatype=DataType.REGISTERS)
    device = SimDevice(1, simdata=[block], action=follower.act)
    started = threading.Event()

    async def serve() -> ModbusTcpServer:
        server = ModbusTcpServer(device, address=("127.0.0.1", port))
        await server.serve_forever(background=True)
        started.set()
        return server

    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    server = asyncio.run_coroutine_threadsafe(serve(), loop).result(5.0)
    try:
        yield port
    finally:
        asyncio.run_coroutine_threadsafe(server.shutdown(), loop).result(5.0)
        loop.call_soon_threadsafe(loop.stop)
        thread.join(5.0)
        loop.close()


def rig_at(port: int) -> Rig:
    table = {**CARRIAGE, "settle_s": 0.1, "port": {"url": f"socket://127.0.0.1:{port}"}}
    configuration = read_rig({"carriage": table}, DRIVERS)
    return Rig(configuration, time.monotonic, RealTime(0.01, time.monotonic, time.sleep), nobody)


def test_a_carriage_behind_their_server_is_set_and_read() -> None:
    follower = Follower()
    with served(follower) as port, rig_at(port) as rig:
        rig.prepare()
        carriage = rig.carriage
        carriage.enable()
        rig.run_until(lambda: carriage.enabled and not carriage.moving, 300, "enable")
        carriage.run_at(0.75)
        rig.run_until(lambda: carriage.at_speed, 300, "speed")
        assert carriage.measured_speed_m_s == pytest.approx(0.75, abs=1e-6)
        carriage.stop()
        rig.run_until(lambda: not carriage.moving, 300, "stop")
    assert follower.written[-1] == 0.0
    assert max(follower.written) == pytest.approx(0.75)


def test_a_server_that_goes_away_and_comes_back_is_connected_by_a_reset(monkeypatch) -> None:
    """The run's own end is at rest; the reset that finds nobody says how often it has tried."""
    monkeypatch.setattr("hardware.reconnection.RECONNECT_S", 0.3)
    follower, port = Follower(), free_port()
    with ExitStack() as stack:
        with served(follower, port):
            rig = stack.enter_context(rig_at(port))
            rig.prepare()
            carriage = rig.carriage
            carriage.enable()
            rig.run_until(lambda: carriage.enabled and not carriage.moving, 300, "enable")
            carriage.run_at(0.75)
            rig.run_until(lambda: carriage.at_speed, 300, "speed")
        with pytest.raises(UnpluggedError):
            rig.run_until(lambda: False, 300, "the server's end")
        assert carriage.moving  # nobody hears it
        carriage.disable()
        with pytest.raises(PortOpenError, match=rf"{port} cannot be opened: .*3 tries"):
            rig.reset()
        assert rig.faults
        with served(follower, port):
            rig.reset()
            assert not rig.faults
            assert not carriage.moving
            assert not carriage.enabled
            assert follower.written[-1] == 0.0
            carriage.enable()
            rig.run_until(lambda: carriage.enabled, 300, "enable again")
            carriage.run_at(0.5)
            rig.run_until(lambda: carriage.at_speed, 300, "speed again")
            rig.close()


def test_a_connection_that_is_refused_is_told_with_the_address() -> None:
    port = free_port()
    with pytest.raises(PortOpenError, match=f"socket://127.0.0.1:{port} cannot be opened"):
        rig_at(port)
