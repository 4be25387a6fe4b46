"""``pmm devices read``: what a rig, a bus or a port reads now."""

import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from hardware.listening import Heard, listen
from hardware.master import Master
from hardware.objects import MappedObjects
from hardware.scan import Ear
from hardware.scan import scan as scan_bus
from hardware.serial_port import SerialPort
from pmm.cli.devices_common import opened, plain_table, print_json
from pmm.cli.devices_scan import DeviceScanOptions
from pmm.cli.screen import error_line, output
from pmm.cli.terminal import Terminal
from pmm.devices.live import DeviceRow, Live
from pmm.devices.opening import DeviceTables

if TYPE_CHECKING:
    from rich.console import Console
    from rich.live import Live as Screen
    from rich.table import Table

_REFRESH_S = 0.25
_ONCE_S = 0.5
_QUICK_LISTEN_S = 0.3
_LATEST = 5  # faults shown


@dataclass(frozen=True)
class DeviceReadOptions(DeviceScanOptions):
    """The options of ``pmm devices read`` by their names there."""

    once: bool = False
    seconds: float | None = None


@dataclass(frozen=True)
class _Shown:
    rows: tuple[DeviceRow, ...]
    said: Sequence[str] = ()


Look = Callable[[float], _Shown]


def run(request: DeviceReadOptions) -> None:
    """Show values until the time is over, or Ctrl-C."""
    tables = request.tables()
    console = output(sys.stdout)
    # The terminal is waited for last: the rig is left by then.
    with Terminal() as terminal, _source(request, tables) as look:
        shown = look(_ONCE_S) if request.once else _live(look, request, terminal, console)
    if request.as_json:
        rows = [{"device": one.device, "what": one.what, "value": one.value, "unit": one.unit}
                for one in shown.rows]  # fmt: skip
        print_json("read", {"values": rows, "said": list(shown.said)})
        return
    if request.once:
        output().print(_table(shown.rows))
    for one in shown.said[-_LATEST:]:
        error_line(one)


@contextmanager
def _source(request: DeviceReadOptions, tables: DeviceTables | None) -> Iterator[Look]:
    """Open what is named, and return what looks at it for so many seconds."""
    if tables is not None:
        with opened(tables.configuration()) as rig:
            rig.prepare()
            live = Live(rig)
            yield lambda seconds: _of_rig(live, seconds)
    elif request.interface:
        ear = Ear()
        master = Master(request.bus(), time.monotonic, (ear,))
        try:
            objects = MappedObjects(master, scan_bus(master, ear, _QUICK_LISTEN_S))
            yield lambda seconds: _of_bus(objects, seconds)
        finally:
            master.close()
    else:
        port = SerialPort("port", request.port_settings())
        try:
            heard = Heard()
            yield lambda seconds: _of_port(port, heard, seconds)
        finally:
            port.close()


def _of_rig(live: Live, seconds: float) -> _Shown:
    live.run(seconds)
    return _Shown(live.rows(), live.said)


def _of_bus(objects: MappedObjects, seconds: float) -> _Shown:
    time.sleep(seconds if seconds == _REFRESH_S else 0.0)  # once: there is nothing to wait for
    values = objects.read()
    return _Shown(tuple(DeviceRow(f"node {one.node_id}", one.name, one.value) for one in values))


def _of_port(port: SerialPort, heard: Heard, seconds: float) -> _Shown:
    listen(port, seconds, time.monotonic, time.sleep, heard)
    rows = [
        DeviceRow("port", "is", heard.what),
        DeviceRow("port", "lines", float(sum(heard.counts.values()))),
    ]
    rows += [DeviceRow("port", f"last {kind}", line.value) for kind, line in heard.last.items()]
    rows += [
        DeviceRow("port", "lost", float(heard.lost)),
        DeviceRow("port", "refused", float(heard.refused)),
    ]
    return _Shown(tuple(rows))


def _live(look: Look, request: DeviceReadOptions, terminal: Terminal, console: "Console") -> _Shown:
    """Look again and again; on a terminal the table stays in its place."""
    from rich.live import Live as Screen

    screen = Screen(
        console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False
    )
    end = None if request.seconds is None else time.monotonic() + request.seconds
    shown = _Shown(())
    with suppress(KeyboardInterrupt):  # the way to end it
        while end is None or time.monotonic() < end:
            shown = look(_REFRESH_S)
            if not request.as_json:
                terminal.draw(partial(_draw, screen, shown.rows))
    if not request.as_json:
        terminal.do(partial(_draw, screen, shown.rows))
        terminal.do(screen.stop)
    return shown


def _draw(screen: "Screen", rows: Sequence[DeviceRow]) -> None:
    screen.start()
    screen.update(_table(rows), refresh=True)


def _table(rows: Sequence[DeviceRow]) -> "Table":
    lines = []
    before = ""
    for one in rows:
        value = one.value if isinstance(one.value, str) else _number(one.value)
        lines.append((one.device if one.device != before else "", one.what, value, one.unit))
        before = one.device
    return plain_table(("device", "what", "value", "unit"), lines, "value")


def _number(value: float) -> str:
    return "-" if value != value else f"{value:.6g}"
