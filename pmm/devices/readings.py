"""What a rig, a bus or a port reads, looked at again and again."""

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass
from typing import Final

from hardware.bus import BusConfiguration
from hardware.listening import PortLines, listen
from hardware.master import Master
from hardware.objects import MappedObjects
from hardware.rig import Rig
from hardware.scan import Ear, scan
from hardware.serial_port import PortSettings, SerialPort
from pmm.devices.device_readings import DeviceRow, Live

REFRESH_S: Final = 0.25
ONCE_S: Final = 0.5
_QUICK_LISTEN_S: Final = 0.3


@dataclass(frozen=True)
class Shown:
    """Values, and the faults that were reported up to now, oldest first."""

    rows: tuple[DeviceRow, ...]
    faults: Sequence[str] = ()


Look = Callable[[float], Shown]  # looks for so many seconds


def of_rig(rig: Rig) -> Look:
    """Return what looks at all devices of a rig that is prepared."""
    live = Live(rig)

    def look(seconds: float) -> Shown:
        live.run(seconds)
        return Shown(live.rows(), live.said)

    return look


@contextmanager
def of_bus(bus: BusConfiguration) -> Iterator[Look]:
    """Open a bus alone, and give what asks its nodes by SDO."""
    ear = Ear()
    with closing(Master(bus, time.monotonic, (ear,))) as master:
        objects = MappedObjects(master, scan(master, ear, _QUICK_LISTEN_S))

        def look(seconds: float) -> Shown:
            time.sleep(seconds if seconds == REFRESH_S else 0.0)  # once: nothing to wait for
            values = objects.read()
            return Shown(
                tuple(
                    DeviceRow(f"node {value.node_id}", value.name, value.value) for value in values
                )
            )

        yield look


@contextmanager
def of_port(settings: PortSettings) -> Iterator[Look]:
    """Open a port alone, and give what listens to it."""
    heard = PortLines()
    with closing(SerialPort("port", settings)) as port:

        def look(seconds: float) -> Shown:
            listen(port, seconds, time.monotonic, time.sleep, heard)
            return Shown(tuple(_port_rows(heard)))

        yield look


def _port_rows(heard: PortLines) -> Iterator[DeviceRow]:
    yield DeviceRow("port", "is", heard.device_kind)
    yield DeviceRow("port", "lines", float(sum(heard.counts.values())))
    for kind, line in heard.last.items():
        yield DeviceRow("port", f"last {kind}", line.value)
    yield DeviceRow("port", "lost", float(heard.lost))
    yield DeviceRow("port", "refused", float(heard.refused))
