"""Rigs over the doubles, ready to run."""

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from typing import Any

import serial

from hardware.lines import LineKind, encode
from hardware.lines import SerialLine as LineOfText
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from tests.hardware.doubles import Drive, Network, bench, virtual
from tests.hardware.protocol_double import Line

COUNTS_PER_TURN = 10_000
COUNTS_PER_METRE = 1_000_000
NEWTON_PER_COUNT = 0.01
_CHANNELS = count()

SHAFT = {
    "driver": "cia402-shaft",
    "node": 1,
    "counts_per_turn": COUNTS_PER_TURN,
    "highest_frequency_hz": 2.0,
    "acceleration_hz_per_s": 1.0,
    "quick_stop_hz_per_s": 5.0,
    "touch_probe": True,
}
ECCENTRICITY = {
    "driver": "cia402-axis",
    "node": 2,
    "counts_per_unit": COUNTS_PER_METRE,
    "low": 0.0,
    "high": 0.06,
    "speed": 0.005,
    "acceleration": 0.05,
    "quick_stop": 0.5,
    "tolerance": 1e-5,
    "standard_uncertainty": 1e-5,
}
PHASE = {
    **ECCENTRICITY,
    "node": 3,
    "unit": "rad",
    "counts_per_unit": 100_000,
    "low": -3.2,
    "high": 3.2,
    "speed": 0.2,
    "acceleration": 1.0,
    "quick_stop": 5.0,
    "tolerance": 1e-3,
}
FORCES = {
    "driver": "cia404-amplifier",
    "node": 4,
    "channels": [
        {
            "name": name,
            "object": f"9130:{i}",
            "scale": NEWTON_PER_COUNT,
            "full_scale": 490.0,
            "status": f"6150:{i}",
        }
        for i, name in enumerate(("force_aft", "force_fore"), start=1)
    ],
}
MANUAL = {
    "driver": "manual-axis",
    "low": 0.0,
    "high": 0.06,
    "standard_uncertainty": 2e-5,
    "tolerance": 1e-4,
    "dial": "micrometer",
    "dial_unit": "mm",
    "dial_per_unit": 1000.0,
}


def nobody(_question: str) -> str | None:
    """Nobody answers."""
    return None


def still() -> float:
    """A clock that nobody moves: the pumped bus answers at once or never."""
    return 0.0


@contextmanager
def open_rig(
    tables: Mapping[str, Any],
    prompt: Callable[[str], str | None] = nobody,
    clock: Callable[[], float] = still,
    **options: Any,
) -> Iterator[Rig]:
    """A prepared rig."""
    with Rig(read_rig(tables, DRIVERS), clock, FreeRunning(), prompt, **options) as rig:
        rig.prepare()
        yield rig


def bus_table(channel: str, interface: str, **more: Any) -> dict[str, Any]:
    threaded = interface != "pumped"
    return {"interface": interface, "channel": channel, "receive_thread": threaded, **more}


@contextmanager
def on_bus(
    tables: Mapping[str, Any], build: Callable[[Network], Any], kind: str = "pumped", **bus: Any
) -> Iterator[tuple[Rig, Any]]:
    """A prepared rig on a bus, and the doubles that ``build`` put on its other end."""
    channel = f"rig {next(_CHANNELS)}"
    side = bench if kind == "pumped" else virtual
    clock = still if kind == "pumped" else time.monotonic
    with side(channel) as network:
        doubles = build(network)
        patience = {} if kind == "pumped" else {"allowed_gap_cycles": 30}
        whole = {"bus": bus_table(channel, kind, **patience, **bus), **tables}
        with open_rig(whole, clock=clock) as rig:
            yield rig, doubles


def two_drives(network: Network) -> dict[str, Drive]:
    return {"shaft": Drive(network, 1), "eccentricity": Drive(network, 2)}


def slotted(drive: Drive) -> None:
    """Give a drive a photocell at every whole turn."""
    drive.photocell = once_a_turn


def once_a_turn(before: float, after: float) -> float | None:
    turns = int(after // COUNTS_PER_TURN)
    return float(turns * COUNTS_PER_TURN) if turns > before // COUNTS_PER_TURN else None


class Talker:
    """A small device that says lines, at the far end of a line in memory."""

    def __init__(self) -> None:
        self._name = f"talker{next(_CHANNELS)}"
        self.url = f"double://{self._name}"
        self.line = Line()
        self.sequence = 0

    def say(self, kind: LineKind, time_s: float, value: float) -> None:
        self.send(encode(LineOfText(kind, self.sequence, round(time_s * 1e6), value)))
        self.sequence += 1

    def send(self, data: bytes) -> None:
        self.line.waiting += data

    def unplug(self) -> None:
        self.line.there = False
        gone = serial.SerialException("device disconnected")
        self.line.fail_on = dict.fromkeys(("in_waiting", "read", "write"), gone)

    def plug(self) -> None:
        self.line.there, self.line.fail_on = True, {}

    def __enter__(self) -> "Talker":
        Line.by_name[self._name] = self.line
        if "tests.hardware" not in serial.protocol_handler_packages:
            serial.protocol_handler_packages.append("tests.hardware")
        return self

    def __exit__(self, *_: object) -> None:
        del Line.by_name[self._name]


def run(rig: Rig, count: int) -> None:
    """Let cycles pass."""
    for _ in range(count):
        rig.cycle()
