"""The guard against leaks finds what is left behind, and nothing else."""

import subprocess
import sys
import threading

import can
import pytest
import serial

from tests.hardware.leaks import Leaks


def test_what_is_left_open_is_named_and_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    leaks = Leaks(monkeypatch)
    bus = can.Bus(interface="virtual", channel="left", ignore_config=True)
    port = serial.serial_for_url("loop://")
    process = subprocess.Popen([sys.executable, "-c", "input()"], stdin=subprocess.PIPE)
    stop = threading.Event()
    thread = threading.Thread(target=stop.wait, name="left thread")
    thread.start()
    left = " ".join(leaks.found())
    stop.set()
    thread.join()
    process.stdin.close()
    for word in ("bus Virtual bus channel left", "port loop://", "process", "left thread"):
        assert word in left
    assert not port.is_open
    assert bus._is_shutdown
    assert process.poll() is not None
    assert leaks.found() == []


def test_what_is_closed_is_not_named(monkeypatch: pytest.MonkeyPatch) -> None:
    leaks = Leaks(monkeypatch)
    can.Bus(interface="virtual", channel="closed", ignore_config=True).shutdown()
    serial.serial_for_url("loop://").close()
    assert leaks.found() == []
