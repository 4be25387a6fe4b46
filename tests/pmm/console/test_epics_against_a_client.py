"""Live values as process variables, by what another Channel Access client reads."""

import asyncio
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import count

import pytest
from caproto import AlarmSeverity, AlarmStatus, CaprotoError
from caproto.sync.client import read, write

from pmm.console.live.epics import EpicsOutlet
from pmm.console.live.live_settings import OutletSettings
from pmm.console.live.process import Publishing
from pmm.console.live.values import LiveTable
from tests.pmm.console.live_rig import HELLO, frame, free_port, until

WITHIN_S = 30.0


@pytest.fixture(autouse=True)
def ports(monkeypatch: pytest.MonkeyPatch) -> int:
    """Take ports of the test's own, on this machine alone."""
    port = free_port()
    for name, value in {
        "EPICS_CA_SERVER_PORT": str(port), "EPICS_CA_REPEATER_PORT": str(free_port()),
        "EPICS_CA_AUTO_ADDR_LIST": "NO", "EPICS_CA_ADDR_LIST": "127.0.0.1",
    }.items():  # fmt: skip
        monkeypatch.setenv(name, value)
    return port


def _read(name: str, kind: str = "control"):
    return read(f"PMM:{name}", data_type=kind, timeout=WITHIN_S, repeater=False)


@contextmanager
def _fed(one: Publishing, force_n: list[float]) -> Iterator[None]:
    """Hand on frames until the end; without them all values would soon be invalid."""
    over = threading.Event()

    def feed() -> None:
        one.take(HELLO)
        numbers = count(1)
        while not over.wait(0.05):
            one.take(frame(next(numbers), force_n=force_n[0]))

    thread = threading.Thread(target=feed)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def test_values_are_read_where_they_are_made(ports: int) -> None:
    async def run() -> None:
        outlet, table = EpicsOutlet("PMM"), LiveTable(HELLO)
        running = asyncio.create_task(outlet.run())
        for number in range(1, 13):
            outlet.offer(table.tick(frame(number, force_n=501.0), 0.0))
        async with asyncio.timeout(WITHIN_S):
            while outlet.status().carried < 12:
                await asyncio.sleep(0.01)
        await asyncio.to_thread(_values_are_read_and_not_written)
        running.cancel()
        with suppress(asyncio.CancelledError):
            await running

    asyncio.run(run())


@pytest.mark.slow
def test_values_units_and_alarms_are_read_and_nothing_is_written(ports: int) -> None:
    before = threading.active_count()
    one, force_n = Publishing(OutletSettings(epics_prefix="PMM")), [501.0]
    with _fed(one, force_n):
        until(lambda: any(status.carried > 10 for status in one.statuses()))
        _values_are_read_and_not_written()
        _strangers(ports)
        force_n[0] = -3.0
        until(lambda: _read("force_aft").data[0] == -3.0)
    until(lambda: _read("force_aft").metadata.severity == AlarmSeverity.INVALID_ALARM)  # silence
    one.close()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as free:
        free.bind(("127.0.0.1", ports))
    assert threading.active_count() == before


def _values_are_read_and_not_written() -> None:
    force = _read("force_aft")
    assert (force.data[0], force.metadata.units) == (501.0, b"N")
    assert (force.metadata.upper_disp_limit, force.metadata.lower_disp_limit) == (500.0, -500.0)
    assert (force.metadata.severity, force.metadata.status) == (
        AlarmSeverity.MAJOR_ALARM, AlarmStatus.STATE,
    )  # fmt: skip
    fore = _read("moment__fore:in_phase_2")
    assert (fore.data[0], fore.metadata.units) == (11.0, "N·m".encode("latin-1"))
    assert _read("set_speed").metadata.units == b"m/s"
    assert _read("state").data[0] == b"gate open"
    assert _read("periods").data[0] == 3
    shaft = _read("shaft").metadata
    assert (shaft.severity, shaft.status) == (AlarmSeverity.INVALID_ALARM, AlarmStatus.UDF)
    assert _read("carried").data[0] > 10
    with pytest.raises(CaprotoError):
        write("PMM:force_aft", 1.0, notify=True, timeout=WITHIN_S, repeater=False)
    assert _read("force_aft").data[0] == 501.0


def _strangers(ports: int) -> None:
    """Send what is no Channel Access: the server stays standing."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as stranger:
        for size in (1, 15, 16, 400):
            stranger.sendto(b"\xff" * size, ("127.0.0.1", ports))
    with socket.create_connection(("127.0.0.1", ports)) as stranger:
        stranger.sendall(b"GET / HTTP/1.1\r\n\r\n" + b"\xff" * 4000)
