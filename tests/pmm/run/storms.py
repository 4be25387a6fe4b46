"""Random sequences of commands and faults on the simulated rig, each cycle watched from outside.

The plant coasts where there is no torque. What the watch knows is the plant's true speed, the
drives' own states and the control words that took their power; never what the controller believes.
"""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

import numpy as np

from hardware.cia402 import DriveState
from hardware.description.errors import PmmError
from hardware.description.flags import Flag
from hardware.errors import NotAtRestError
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from hardware.roles import Pulse
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.header import LiveSettings
from pmm.recorder.lateness import CycleStatistics
from pmm.recorder.run_recorder import RunEnd
from pmm.run.measurement import Measurement
from pmm.run.run_control import RunControl
from pmm.run.states import Command, State
from sim.devices.bench_file import DRIVERS
from sim.devices.drive import SimulatedDrive
from sim.devices.faults import inject
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import vertical_rig
from tests.pmm.run.harness import (
    E_M,
    PHASE_RAD,
    TABLES,
    VERTICAL_1963,
    Blind,
    absent,
    oscillation,
)
from tests.sim.devices.power_watch import REST_SPEEDS, PowerOff, PowerWatch

RATE_HZ: Final = 100.0
SECONDS: Final = 10.0
# Cycles in which the encoder may not have shown yet what the plant does: window and rounding.
SEEN_CYCLES: Final = 8
OVERSPEED_CYCLES: Final = 30
COMMANDS: Final = (
    *(Command.START,) * 4,
    Command.STOP,
    Command.QUICK_STOP,
    Command.NEXT,
    Command.HOLD,
    *(Command.RESET,) * 5,
)
FAULTS: Final = (
    "sto {drive}",
    *("release {drive}",) * 2,
    "mains",
    "drive-fault {drive} 2310",
    "emergency {node} 4210",
    "runaway shaft {hz}",
    "drag shaft {hz}",
    *("free shaft",) * 3,
    "block {drive}",
    "free {drive}",
    "missed 1",
    "extra",
    "push force_fore {newton}",
    "silence {node}",
    "heartbeat {node}",
    "boot {drive}",
    "bus-off",
)
NODES: Final = ("shaft", "eccentricity", "phase", "force_0", "force_1")
DRIVES: Final = NODES[:3]


class NoJournal:
    """A recorder that keeps nothing."""

    has_files = False

    def opened(self, *, wait: bool) -> bool:
        return True

    def samples(self, first_sync: int, values: Any) -> None:
        return

    def pulse(self, pulse: Pulse) -> None:
        return

    def event(self, cycle: int, time_s: float, kind: str, text: str) -> None:
        return

    def harmonic(self, reading: Mapping[str, Any]) -> None:
        return

    def cycle_statistics(self, lateness_s: float) -> None:
        return

    def statistics(self) -> CycleStatistics:
        return CycleStatistics(0, 0.0, 0.0, 0.0, 0)

    def tick(self, now_s: float) -> None:
        return

    def close(self, outcome: RunEnd, flags: Sequence[Flag]) -> Path:
        return Path("nowhere")


@dataclass
class Found:
    """What a sequence showed.

    Attributes
    ----------
    wrong
        Sentences, each with the seed and the time; none is how it should be.
    counts
        Of what happened: commands, faults, states, power taken off, cycles.
    """

    wrong: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)


class Storm:
    """One sequence, made from its seed."""

    def __init__(self, seed: int) -> None:
        self.seed = seed
        self.found = Found()
        self._random = np.random.default_rng([23, seed])
        self._unseen = self._over = self._faulty = 0
        self._stood_in_fault = False
        self._on: dict[str, bool] = {}
        self._alarmed: set[tuple[str, str]] = set()

    def run(self) -> Found:
        """Carry it out."""
        name = f"storm-{self.seed}"
        bus = {"interface": "pmm-simulated", "channel": name, "receive_thread": False}
        configuration = read_rig({**TABLES, "bus": bus}, DRIVERS)
        place = {"eccentricity_m": E_M - 1e-4, "strut_phase_rad": PHASE_RAD - 1e-3}
        self.world = World(configuration, Scene(vertical_rig(), **place))
        nodes = self.world.nodes.items()
        self._drives = [(n, one) for n, one in nodes if isinstance(one, SimulatedDrive)]
        self._shaft = dict(self._drives)["shaft"]
        self.watch = PowerWatch(self.world)
        file = RigFile(
            path=Path("rig.toml"),
            sha256="0" * 64,
            oscillator=VERTICAL_1963,
            hardware=configuration,
            realtime=False,
        )
        with running(name, self.world):
            rig = Rig(configuration, self._now, FreeRunning(), absent)
            with rig:
                rig.prepare()
                self.rig = rig
                self._weather(rig, file)
            self._judge_power()
        return self.found

    def _now(self) -> float:
        return self.world.time_s

    def _weather(self, rig: Rig, file: RigFile) -> None:
        runs = [oscillation(f"run-{i}", float(self._random.uniform(0.5, 1.8))) for i in range(3)]

        def begin(run: RunPlan) -> Measurement:
            return Measurement(rig, run, NoJournal(), LiveSettings(periods=run.max_periods))

        self.control = RunControl(rig, file, runs, begin, self._now, Blind())
        events = self._events()
        for number in range(round(SECONDS * RATE_HZ)):
            for what in events.get(number, ()):
                self._do(what)
            self.control.step()
            self._look()
        self.found.counts["cycles"] += round(SECONDS * RATE_HZ)

    def _events(self) -> dict[int, list[Command | str]]:
        """Return what is done before which cycle: a start, then commands and faults at random."""
        events: dict[int, list[Command | str]] = {
            int(self._random.integers(0, 50)): [Command.START]
        }
        for _ in range(int(self._random.integers(2, 13))):
            number = int(self._random.integers(10, round(SECONDS * RATE_HZ)))
            events.setdefault(number, []).append(self._event())
        return events

    def _event(self) -> Command | str:
        if self._random.random() < 0.6:
            return COMMANDS[int(self._random.integers(len(COMMANDS)))]
        words = FAULTS[int(self._random.integers(len(FAULTS)))]
        return words.format(
            drive=DRIVES[int(self._random.integers(len(DRIVES)))],
            node=list(self.world.nodes)[int(self._random.integers(len(self.world.nodes)))],
            hz=f"{self._random.uniform(-3.5, 3.5):.3f}",
            newton=f"{self._random.uniform(-800, 800):.0f}",
        )

    def _do(self, what: Command | str) -> None:
        if isinstance(what, Command):
            self._command(what)
            return
        inject(self.world, what)
        self.found.counts[f"fault: {what.split()[0]}"] += 1

    def _command(self, command: Command) -> None:
        resetting = command is Command.RESET and self.control.state is State.FAULT
        moving = [name for name, one in self._drives if abs(one.speed) > REST_SPEEDS[name]]
        try:
            self.control.request(command)
        except PmmError:
            self.found.counts[f"refused: {command}"] += 1
            return
        self.found.counts[f"command: {command}"] += 1
        if resetting and moving:
            self._wrong(f"a reset was accepted while {' and '.join(moving)} moved")

    def _look(self) -> None:
        self.found.counts[f"state: {self.control.state}"] += 1
        self._look_at_rest()
        self._look_at_speed()
        self._look_at_fault()

    def _look_at_rest(self) -> None:
        """A shaft that turns is seen to move, within the cycles that seeing takes."""
        turns = abs(self._shaft.speed) > REST_SPEEDS["shaft"]
        self._unseen = self._unseen + 1 if turns and not self._rig_shaft.moving else 0
        if self._unseen == SEEN_CYCLES:
            self._wrong(f"a shaft at {self._shaft.speed:.3g} Hz is taken for one at rest")

    def _look_at_speed(self) -> None:
        """A shaft that turns too fast is a fault in every state, unless the bus is lost."""
        heard = self._shaft.talking and self._shaft.operational and not self.world.bus_off
        over = heard and abs(self._shaft.speed) > 2.12 and not self.rig.faults
        self._over = self._over + 1 if over else 0
        if self._over == OVERSPEED_CYCLES:
            self._wrong(f"{self._shaft.speed:.3g} Hz is no fault in state {self.control.state}")

    def _look_at_fault(self) -> None:
        """Behind a latched fault no drive is enabled, until a reset."""
        self._faulty = self._faulty + 1 if self.rig.faults else 0
        self._keep_alarms()
        for name, one in self._drives:
            on = one.state is DriveState.OPERATION_ENABLED
            if on and not self._on.get(name, False) and self._faulty > 2:
                self._wrong(f"{name} was enabled behind a latched fault")
            self._on[name] = on

    def _keep_alarms(self) -> None:
        """Keep whose power goes in this cycle by an alarm: a reset may take it back later."""
        for one in self.rig.faults:
            if isinstance(one, NotAtRestError):
                self._alarmed.add((one.device, f"{self.world.time_s:.2f}"))

    def _judge_power(self) -> None:
        """Power off by command above the speed of rest follows an alarm only."""
        self.found.counts["power taken off"] += len(self.watch.seen)
        for one in self.watch.while_moving:
            alarmed = (one.part, f"{one.time_s:.2f}") in self._alarmed or any(
                isinstance(fault, NotAtRestError) and fault.device == one.part
                for fault in self.rig.faults  # of the closing, which nobody looked at
            )
            self.found.counts["power off by deadline"] += alarmed
            if not alarmed:
                self._wrong(_said(one))

    @property
    def _rig_shaft(self) -> Any:
        return self.rig.shaft

    def _wrong(self, what: str) -> None:
        self.found.wrong.append(f"seed {self.seed}, {self.world.time_s:.2f} s: {what}")


def _said(one: PowerOff) -> str:
    return f"{one.part} lost its power at {one.speed:.3g} a second, at {one.time_s:.2f} s"
