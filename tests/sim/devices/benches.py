"""Simulated rigs ready to run: in this process, or behind an interface in another one."""

import json
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from itertools import count
from pathlib import Path
from typing import Any

import can
from can.interfaces.udp_multicast import UdpMulticastBus

from hardware.pacing import FreeRunning, RealTime
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import SimulatedRig, vertical_rig
from tests.hardware.contract import Bench
from tests.hardware.rigs import ECCENTRICITY, PHASE, SHAFT, nobody

ROOT = Path(__file__).parents[3]
NEWTON_PER_COUNT = 0.01
_NAMES = count()


def amplifier(node: int, *names: str, **more: Any) -> dict[str, Any]:
    channels = [
        {
            "name": name,
            "object": f"9130:{i}",
            "scale": NEWTON_PER_COUNT,
            "full_scale": 490.0,
            "status": f"6150:{i}",
        }
        for i, name in enumerate(names, start=1)
    ]
    return {"driver": "cia404-amplifier", "node": node, "channels": channels, **more}


QUICK_HOMING = {"homing_speed": 0.01}
WHOLE: dict[str, Any] = {
    "shaft": SHAFT,
    "eccentricity": {**ECCENTRICITY, **QUICK_HOMING},
    "phase": {**PHASE, "homing_speed": 0.5},
    "forces": [amplifier(4, "force_aft"), amplifier(5, "force_fore")],
    "photocell": {"driver": "touch-probe"},
}


@contextmanager
def in_process(
    tables: Mapping[str, Any],
    simulated: SimulatedRig | None = None,
    around: PlantConditions | None = None,
    *,
    on_bus: bool = True,
    serial: tuple[str, ...] = (),
    **start: float,
) -> Iterator[tuple[Rig, World]]:
    """A prepared rig on the in-process bus, and its world; ``serial`` parts are on ``sim://``."""
    name = f"rig-{next(_NAMES)}"
    whole: dict[str, Any] = dict(tables)
    for part in serial:
        port = {**whole[part].get("port", {}), "url": f"sim://{name}/{part}"}
        whole[part] = {**whole[part], "port": port}
    if on_bus:
        bus = {"interface": "pmm-simulated", "channel": name, "receive_thread": False}
        whole["bus"] = bus | whole.get("bus", {})
    configuration = read_rig(whole, DRIVERS)
    scene = Scene(simulated or vertical_rig(), around or PlantConditions(), **start)
    world = World(configuration, scene)
    with (
        running(name, world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), nobody) as rig,
    ):
        rig.prepare()
        yield rig, world


def ready(rig: Rig, within: int = 3000) -> None:
    """Put all axes under power and home them."""
    for one in rig.powered():
        one.enable()
    rig.run_until(lambda: all(one.enabled for one in rig.powered()), 100, "enable")
    axes = [one for one in (rig.eccentricity, rig.phase) if one is not None]
    for one in axes:
        one.home()
    rig.run_until(lambda: all(one.homed and not one.moving for one in axes), within, "home")


def turning(rig: Rig, eccentricity_m: float, phase_rad: float, frequency_hz: float) -> None:
    """Set the linkage and let the shaft turn."""
    ready(rig)
    rig.eccentricity.move_to(eccentricity_m)
    rig.phase.move_to(phase_rad)
    axes = (rig.eccentricity, rig.phase)
    rig.run_until(lambda: all(one.settled for one in axes), 3000, "move")
    rig.shaft.turn(frequency_hz)
    rig.run_until(lambda: rig.shaft.at_speed, 1000, "speed")


class Hosted:
    """A simulated rig in another process; start it once and reset it for each test."""

    def __init__(
        self, tables: Mapping[str, Any], folder: Path, interface: str, *, real_time: bool = False
    ) -> None:
        file = folder / "simulated.toml"
        bus = {"interface": interface, "channel": "as the host says"}
        text = "eccentricity_m = 0.001\n\n" + toml({"bus": bus, **tables}, "rig.")
        file.write_text(text, encoding="utf-8")
        command = [sys.executable, "-m", "sim.devices", str(file)]
        command += [] if real_time else ["--free-running"]
        command += ["--interface", interface, "--port", str(_free_port())]
        self.tables = tables
        self.real_time = real_time
        self._process = subprocess.Popen(
            command, cwd=ROOT, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        line = self._process.stdout.readline()
        if not line:
            self._process.communicate()
            raise RuntimeError("the host of the simulated rig ended")
        self.said = json.loads(line)

    def say(self, words: str) -> str:
        self._process.stdin.write(words + "\n")
        self._process.stdin.flush()
        return self._process.stdout.readline().strip()

    @contextmanager
    def rig(self, *parts: str, reset: bool = True) -> Iterator[Rig]:
        """A prepared rig of some of the parts; serial ones are on their pseudo-terminals."""
        if reset:
            assert self.say("reset") == "done"
        bus = dict(self.said["bus"])
        interface, channel = bus.pop("interface"), bus.pop("channel")
        if interface == "slcan":
            bus["sleep_after_open"] = 0
        table = {
            "interface": interface,
            "channel": channel,
            "options": bus,
            # In real time a machine that is kept busy keeps frames waiting too.
            "allowed_gap_cycles": 300 if self.real_time else 30,
            "listen_ms": 50,
            # Free-running, a peer that the machine has no time for costs time and no samples.
            "answer_ms": 0 if self.real_time else 2000,
        }
        tables = {part: self._plugged(part) for part in parts}
        whole = tables if set(parts) <= set(self.said["ports"]) else {"bus": table, **tables}
        configuration = read_rig(whole, DRIVERS)
        period_s = 1.0 / configuration.sample_rate_hz
        pacer = RealTime(period_s, time.monotonic, time.sleep) if self.real_time else FreeRunning()
        with Rig(configuration, time.monotonic, pacer, nobody) as rig:
            rig.prepare()
            yield rig

    def _plugged(self, part: str) -> Any:
        if part not in self.said["ports"]:
            return self.tables[part]
        return {**self.tables[part], "port": {"url": self.said["ports"][part]}}

    def close(self) -> None:
        self._process.communicate("quit\n", timeout=5)


def multicast_works() -> bool:
    """Tell whether frames come through between two sockets of this machine."""
    group, port = "239.74.163.2", _free_port()
    try:
        options = {"channel": group, "port": port, "hop_limit": 0}
        one = UdpMulticastBus(**options)
        other = UdpMulticastBus(**options)
    except (can.CanError, OSError):
        return False
    try:
        one.send(can.Message(arbitration_id=1, data=b"x", is_extended_id=False))
        return other.recv(1.0) is not None
    except can.CanError:
        return False
    finally:
        one.shutdown()
        other.shutdown()


def push(send: Callable[[str], object], channel: str) -> Callable[[float], None]:
    """What applies a force to a gauge, by word."""
    return lambda force_n: send(f"push {channel} {force_n!r}") and None


def slotted(rig: Rig, send: Callable[[str], object]) -> Callable[[float], None]:
    """What makes the shaft turn, or its pulses stay away."""

    def apply(frequency_hz: float) -> None:
        if not frequency_hz:
            send("missed 1000")
            return
        rig.shaft.enable()
        rig.run_until(lambda: rig.shaft.enabled, 100, "enable")
        rig.shaft.turn(frequency_hz)
        rig.run_until(lambda: rig.shaft.at_speed, 1000, "speed")

    return apply


def by_word(world: World) -> Callable[[str], None]:
    return lambda words: inject(world, words)


def bench(rig: Rig, apply: Callable[[float], None] | None = None) -> Bench:
    return Bench(rig, within=3000) if apply is None else Bench(rig, apply, 3000)


def _free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
        one.bind(("", 0))
        return int(one.getsockname()[1])


def toml(tables: Mapping[str, Any], within: str = "") -> str:
    """Write the tables of a rig; values as JSON, which TOML reads in this case."""
    lines = []
    for name, table in tables.items():
        for one in table if isinstance(table, list) else [table]:
            head = f"{within}{name}"
            lines.append(f"[[{head}]]" if isinstance(table, list) else f"[{head}]")
            lines += [f"{key} = {_value(value)}" for key, value in one.items()]
    return "\n".join(lines) + "\n"


def _value(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_value(one)}" for key, one in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(_value, value)) + "]"
    return json.dumps(value)
