"""For the console's benchmark: a loop that shows 16 channels, and a watcher without a browser."""

import math
import time
from collections.abc import Callable
from multiprocessing import get_context
from pathlib import Path
from socket import create_server
from typing import Any, Final

import numpy as np

from hardware.description.setpoint import SetPoint
from pmm.console.app_settings import ConsoleSettings
from pmm.console.link import Link
from pmm.console.messages import Bus, ChannelInfo, Frame, Hello, LoopOrder, Needles, SignalTrace
from pmm.console.quick_stop import QuickStop
from pmm.console.security import Door
from pmm.console.session import serve
from pmm.console.station_view import TICK_S
from pmm.interface.console import ConsoleClient
from pmm.interface.console_requests import Message
from pmm.plan.rig_file import read_rig_file
from pmm.recorder.lateness import CycleStatistics
from pmm.run.gate import GateState
from pmm.run.states import State
from pmm.run.status import RunStatus

CHANNELS: Final = 16
_RATE_HZ: Final = 100.0
_EACH: Final = round(_RATE_HZ * TICK_S)
_JOIN_S: Final = 10.0


def plan_of_many() -> str:
    """Return a plan of 9950 runs, nearly as many as a plan may have."""
    frequencies = [round(0.2 + 0.0005 * k, 4) for k in range(1990)]
    return (
        'name = "many"\nrig = "rig.toml"\n[[runs]]\nmotion = "heave"\n'
        f"frequencies_hz = {frequencies}\namplitudes_mm = [1.0, 2.0, 3.0, 4.0, 5.0]\n"
    )


class Source:
    """Serves the console's page with made-up channels; frames go out while :meth:`wait` waits."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._rng = np.random.default_rng(1963)
        self._number = 0
        self._spent_s = 0.0

    def __enter__(self) -> "Source":
        self._socket = create_server(("127.0.0.1", 0))
        port = self._socket.getsockname()[1]
        self.address = f"http://127.0.0.1:{port}/"
        door = Door("127.0.0.1", port)
        rig = self._folder / "rig.toml"
        hashes = read_rig_file(rig).hashes if rig.exists() else {}  # no rig, no plans
        settings = ConsoleSettings(rig, hashes, self._folder, None, self._folder, door)
        context = get_context("spawn")
        ours, theirs = context.Pipe()
        self._process = context.Process(
            target=serve, args=(settings, self._socket, theirs, QuickStop(), None, None)
        )
        self._process.start()
        theirs.close()
        self._link: Link[LoopOrder] = Link(ours)
        self._link.tell(self._hello())
        self.wait(3.0)
        self._number, self._spent_s = 0, 0.0
        return self

    def __exit__(self, *_: object) -> None:
        self._link.close()
        self._process.join(_JOIN_S)
        self._socket.close()

    @property
    def server_pid(self) -> int:
        """The web server's process."""
        return int(self._process.pid or 0)

    @property
    def sent_per_s(self) -> float:
        """Frames a second that were handed on."""
        return self._number / self._spent_s

    def wait(self, seconds: float) -> None:
        """Hand on frames for so long."""
        start = time.monotonic()
        due = start
        while (now := time.monotonic()) < start + seconds:
            self._link.frame(self._frame())
            due = max(due + TICK_S, now)
            time.sleep(max(due - time.monotonic(), 0.0))
        self._spent_s += time.monotonic() - start

    def _hello(self) -> Hello:
        channels = tuple(ChannelInfo(f"force_{k:02d}", "N", 500.0) for k in range(CHANNELS))
        return Hello("bench", self._folder, True, channels, _RATE_HZ, _RATE_HZ, 3, 1.0)

    def _frame(self) -> Frame:
        self._number += 1
        first = self._number * _EACH
        theta = 2.0 * np.pi * np.arange(first, first + _EACH) / _RATE_HZ
        phases = np.arange(CHANNELS)[:, None]
        noise = self._rng.normal(0.0, 0.5, (CHANNELS, _EACH))
        values = 40.0 * np.sin(theta + 0.2 * phases) + noise
        coefficients = self._rng.normal(20.0, 0.05, (CHANNELS, 7))
        time_s = first / _RATE_HZ
        status = RunStatus(State.GATE_OPEN, first, time_s, "run", "oscillation", 1, 9, 1.0,
                           GateState.OPEN, self._number // 25, 1000)  # fmt: skip
        return Frame(
            number=self._number,
            status=status,
            plan=0,
            queue=(),
            set_point=SetPoint(1.0, 0.02, 0.0, 0.0),
            opened_s=max(time_s - 10.0, 0.0),
            closed_s=math.nan,
            shaft_hz=1.0 + float(self._rng.normal(0.0, 1e-3)),
            axes=(("eccentricity", "m", 0.02), ("phase", "rad", 0.0)),
            allowed=("next", "hold", "stop", "quick stop"),
            question="",
            bus=Bus(True, 9, 0),
            loop=CycleStatistics(first, 1e-4, 1e-3, 2e-3, 0),
            needles=Needles(coefficients, np.full((CHANNELS, 7), 0.05), final=False),
            trace=SignalTrace(first, time_s, values),
        )


class Watcher(ConsoleClient):
    """A program that watches a console by its stream, and begins a plan."""

    def __init__(self, address: str) -> None:
        super().__init__(address, "", None)

    def start(self, plan: str) -> None:
        """Queue a plan and start it."""
        self.queue(plan)
        self.command("start")

    def frames_per_s(self, seconds: float) -> float:
        """Return how many frames a second come in a window of so long."""
        end_s, count = time.monotonic() + seconds, 0
        for message in self.messages():
            count += message["type"] == "frame"
            if time.monotonic() > end_s:
                break
        return count / seconds

    def loops(self, seconds: float) -> list[dict[str, Any]]:
        """Watch for a while; return the loop's statistics of each window that ended."""
        found: list[dict[str, Any]] = []
        end_s = time.monotonic() + seconds
        for message in self.messages():
            if message["type"] == "frame" and message["loop"]["cycles"]:
                found += [message["loop"]] * (message["loop"] not in found[-1:])
            if found and time.monotonic() > end_s:
                break
        return found[1:] or found

    def until(self, rig_s: float) -> None:
        """Wait until the rig's time has come."""
        self.see(lambda frame: bool(frame["time_s"] >= rig_s))

    def see(self, condition: Callable[[Message], bool]) -> None:
        """Wait for a frame that shows something."""
        next(one for one in self.messages() if one["type"] == "frame" and condition(one))

    def told(self, kind: str) -> None:
        """Wait for a message of a kind."""
        next(one for one in self.messages() if one["type"] == kind)
