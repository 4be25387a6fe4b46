"""Frames of a rig that is made up, and a broker of its own for a test."""

import math
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import paho.mqtt.client as paho
import pytest

from hardware.description.setpoint import SetPoint
from pmm.console.messages import Bus, ChannelInfo, Frame, Hello, Needles, SignalTrace
from pmm.recorder.lateness import CycleStatistics
from pmm.run.gate import GateState
from pmm.run.states import State
from pmm.run.status import RunStatus

MOSQUITTO = shutil.which("mosquitto", path="/usr/local/sbin:/usr/sbin:/usr/bin:/usr/local/bin")
needed = pytest.mark.skipif(MOSQUITTO is None, reason="needs mosquitto (apt-get install)")
WITHIN_S = 60.0
CHANNELS = (ChannelInfo("force_aft", "N", 500.0), ChannelInfo("moment, fore", "N·m"))
HELLO = Hello("tank", Path("rig.toml"), True, CHANNELS, 100.0, 100.0, 3, 1.0)


def frame(number: int, *, state: State = State.GATE_OPEN, force_n: float = 40.0) -> Frame:
    """Return tick ``number``: its second channel reads 7, and its needles are 1 to 14."""
    status = RunStatus(state, 4 * number, 0.04 * number, "run", "oscillation", 1, 9, 1.0,
                       GateState.OPEN, 3, 10)  # fmt: skip
    samples = np.array([[0.0, force_n], [0.0, 7.0]])
    needles = Needles(np.arange(1.0, 15.0).reshape(2, 7), np.full((2, 7), 0.5), final=True)
    return Frame(
        number=number, status=status, plan=1, queue=(), set_point=SetPoint(1.1, 0.02, 0.0, 2.5),
        opened_s=0.0, closed_s=math.nan, shaft_hz=math.nan, axes=(("eccentricity", "m", 0.02),),
        allowed=(), question="", bus=Bus(True, 9, 0), loop=CycleStatistics(1, 0.0, 0.0, 0.0, 0),
        needles=needles, trace=SignalTrace(4 * number, 0.04 * number, samples),
    )  # fmt: skip


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.create_server(("127.0.0.1", 0)) as one:
        return int(one.getsockname()[1])


@contextmanager
def broker(port: int, folder: Path, *lines: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run mosquitto on a port."""
    file = folder / "mosquitto.conf"
    whole = [f"listener {port} 127.0.0.1", *(lines or ["allow_anonymous true"])]
    file.write_text("\n".join(whole) + "\n", encoding="utf-8")
    with subprocess.Popen([str(MOSQUITTO), "-c", str(file)], stderr=subprocess.DEVNULL) as one:
        try:
            until(lambda: _listens(port))
            yield one
        finally:
            one.kill()


def _listens(port: int) -> bool:
    with socket.socket() as one:
        return one.connect_ex(("127.0.0.1", port)) == 0


class Reader:
    """Another MQTT client, which keeps all that comes; its session outlives the connection."""

    def __init__(self, port: int, take: Callable[[Any, Any, Any], None] | None = None) -> None:
        self.came: list[tuple[str, bytes]] = []
        self._known, self._port = threading.Event(), port
        self._client = paho.Client(
            paho.CallbackAPIVersion.VERSION2, client_id="reader", clean_session=False
        )
        self._client.on_connect = lambda client, *_: client.subscribe("#", 1)
        self._client.on_subscribe = lambda *_: self._known.set()
        self._client.on_message = take or (
            lambda *got: self.came.append((got[2].topic, got[2].payload))
        )
        self._client.reconnect_delay_set(0.1, 0.1)

    def __enter__(self) -> "Reader":
        self._client.connect("127.0.0.1", self._port)
        self._client.loop_start()
        assert self._known.wait(WITHIN_S)
        return self

    def __exit__(self, *_: object) -> None:
        self._client.disconnect()
        self._client.loop_stop()

    def of(self, topic: str) -> list[bytes]:
        """Return what came on a topic."""
        return [payload for name, payload in self.came if name == topic]


def until(condition: Callable[[], bool]) -> None:
    """Wait for a condition."""
    end_s = time.monotonic() + WITHIN_S
    while not condition():
        assert time.monotonic() < end_s
        time.sleep(0.01)
