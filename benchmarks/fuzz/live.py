"""Frames on the bus of a rig that runs: any identifier, length and data, between its cycles."""

import struct
from collections.abc import Callable
from contextlib import ExitStack
from itertools import count
from pathlib import Path
from typing import Final

import can
from can.interfaces import BACKENDS

from benchmarks.fuzz.promises import REFUSED
from benchmarks.kill_child import tables
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig

_FRAME: Final = struct.Struct("<HB8s")  # identifier and kind, length, data
_EVERY: Final = 8  # frames from cycle to cycle
_FRESH: Final = 4_000  # frames of one rig: one that met another master sends no more
_IDENTIFIERS: Final = (0x000, 0x080, 0x081, 0x084, 0x100, 0x181, 0x184, 0x281, 0x285, 0x381, 0x581,
                       0x584, 0x601, 0x701, 0x704, 0x705, 0x77F, 0x7E4)  # fmt: skip
FRAMES: Final = [
    _FRAME.pack(one, 8, bytes([0x37, 0x06, 0, 0, 0x10, 0x27, 0, 0])) for one in _IDENTIFIERS
]


class _Bus:
    """A rig that takes frames, and a new one every now and then."""

    def __init__(self) -> None:
        self._names = count()
        self._taken = 0
        self._open = ExitStack()
        self._rig: Rig | None = None

    def close(self) -> None:
        """Close the present rig."""
        self._open.close()

    def take(self, data: bytes) -> object:
        """Deliver a frame; every now and then a cycle follows."""
        if self._rig is None or self._taken % _FRESH == 0:
            self._rig = self._fresh()
        self._taken += 1
        identifier, length, content = _FRAME.unpack(data[: _FRAME.size].ljust(_FRAME.size, b"\0"))
        message = can.Message(
            arbitration_id=identifier & 0x7FF,
            is_extended_id=bool(identifier & 0x1000),
            is_remote_frame=bool(identifier & 0x2000),
            is_error_frame=bool(identifier & 0x4000),
            data=b"" if identifier & 0x2000 else content[: length % 9],
            dlc=length % 9,
            timestamp=0.0,
        )
        if self._rig.master is not None:
            self._rig.master.deliver(message)
        if self._taken % _EVERY == 0:
            self._rig.cycle()
        return identifier & 0x780

    def _fresh(self) -> Rig:
        self._open.close()
        self._open = ExitStack()
        name = f"fuzzed-{next(self._names)}"
        configuration = read_rig(tables(name), DRIVERS)
        world = World(configuration, Scene(vertical_rig(), PlantConditions(1.2), 0.02, 0.5))
        self._open.enter_context(running(name, world))
        rig = Rig(configuration, lambda: world.time_s, FreeRunning(), lambda _: None)
        self._open.enter_context(rig)
        try:
            rig.prepare()
        except REFUSED:
            self._open.close()
            raise
        return rig


def frames(_folder: Path, stack: ExitStack) -> Callable[[bytes], object]:
    """Return what takes a frame."""
    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    bus = _Bus()
    stack.callback(bus.close)
    return bus.take
