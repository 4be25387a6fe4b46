"""``pmm devices`` at a terminal that takes nothing: the loop behind it goes on."""

import io
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

from hardware.roles import Pulse
from pmm.cli.devices.gauges import gauges
from pmm.cli.devices.photocell import photocell
from pmm.cli.devices.read import read
from pmm.devices.device_readings import DeviceRow
from pmm.devices.photocell_test import PhotocellRecord
from pmm.devices.push_session import Pushed
from pmm.devices.push_test import Push
from pmm.devices.readings import Shown

EXAMPLE = Path(__file__).parents[3] / "examples" / "vertical" / "rig.toml"


class Stopped(io.StringIO):
    """A terminal that takes nothing until it is let go, or for five seconds."""

    def __init__(self) -> None:
        super().__init__()
        self.goes_on = threading.Event()
        self.held_up = False

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        if not self.goes_on.wait(5.0):
            self.held_up = True
            self.goes_on.set()
        return super().write(text)


def stopped(monkeypatch: pytest.MonkeyPatch) -> Stopped:
    """Put such a terminal in the place of both streams, within the test: pytest has its own."""
    found = Stopped()
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.setattr(sys, "stdout", found)
    monkeypatch.setattr(sys, "stderr", found)
    return found


def test_values_are_read_on(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = stopped(monkeypatch)
    looked: list[float] = []

    def look(seconds: float) -> Shown:
        looked.append(seconds)
        if len(looked) == 20:
            terminal.goes_on.set()
            raise KeyboardInterrupt
        return Shown((DeviceRow("shaft", "looks", float(len(looked))),))

    @contextmanager
    def source(*_: object) -> Iterator[Any]:
        yield look

    monkeypatch.setattr("pmm.cli.devices.read._source", source)
    read.main([str(EXAMPLE)], standalone_mode=False)
    assert not terminal.held_up
    assert "19" in terminal.getvalue()


def test_gauges_are_pushed_on(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = stopped(monkeypatch)

    def pushed(*_: object) -> Iterator[Pushed]:
        yield Pushed("force_aft", Push("force_aft", 1, 10.0, 1.0, "N", {}), ())
        yield Pushed("force_fore", None, ("no push",))
        terminal.goes_on.set()

    monkeypatch.setattr("pmm.devices.push_session.push_each", pushed)
    words = [str(EXAMPLE), "--free-running", "--within", "1"]
    assert gauges.main(words, standalone_mode=False) == 1
    assert not terminal.held_up
    assert "force_aft: came in on force_aft, sign +, +10 N" in terminal.getvalue()
    assert "error: force_fore: no push" in terminal.getvalue()


def test_pulses_are_watched_on(monkeypatch: pytest.MonkeyPatch) -> None:
    terminal = stopped(monkeypatch)

    def watched(_rig: object, _count: int, _s: float, on_pulse: Any) -> PhotocellRecord:
        on_pulse(Pulse(7, 1.0))
        terminal.goes_on.set()
        return PhotocellRecord((Pulse(7, 1.0),), (), (), True)

    monkeypatch.setattr("pmm.devices.photocell_test.watch", watched)
    words = [str(EXAMPLE), "--free-running", "--yes", "--pulses", "2"]
    photocell.main(words, standalone_mode=False)
    assert not terminal.held_up
    assert "pulse 7 at 1.0000 s" in terminal.getvalue()
