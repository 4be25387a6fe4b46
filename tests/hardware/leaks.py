"""Notices buses, ports, threads and processes that were opened and not closed."""

import subprocess
import threading
from typing import Any

import can
import pytest
import serial

_ENDING_S = 2.0
# Of distributed and fsspec, one each for the whole process, kept for its next client.
_SHARED = {"fsspecIO", "IO loop", "Dask-Offload_0"}
# Reads binary files; one is kept for the next file, by design.
_READER = "analysis.foreign.child"


class Leaks:
    """Watches from its construction on."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self._buses: list[can.BusABC] = []
        self._ports: list[serial.SerialBase] = []
        self._processes: list[subprocess.Popen[Any]] = []
        self._threads = set(threading.enumerate())
        for kind, kept in (
            (can.BusABC, self._buses),
            (serial.SerialBase, self._ports),
            (subprocess.Popen, self._processes),
        ):
            _record(monkeypatch, kind, kept)

    def found(self) -> list[str]:
        """Close what was left open, and name it."""
        left = []
        for bus in self._buses:
            if not bus._is_shutdown:
                left.append(f"bus {bus.channel_info}")
                bus.shutdown()
        for port in self._ports:
            if port.is_open:
                left.append(f"port {port.portstr}")
                port.close()
        for process in self._processes:
            if process.poll() is None and _READER not in process.args:
                left.append(f"process {process.args!r}")
                process.kill()
                process.wait()
        fresh = set(threading.enumerate()) - self._threads
        for one in fresh:
            one.join(_ENDING_S)  # one that was told to end may still be about to
        alive = {one.name for one in fresh if one.is_alive()}
        return left + [f"thread {name}" for name in sorted(alive - _SHARED)]


def _record(monkeypatch: pytest.MonkeyPatch, kind: type, kept: list[Any]) -> None:
    original = kind.__init__

    def recorded(self: Any, *args: Any, **kwargs: Any) -> None:
        original(self, *args, **kwargs)
        kept.append(self)

    monkeypatch.setattr(kind, "__init__", recorded)
