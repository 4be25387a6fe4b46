"""The in-process bus to a simulated rig: ``interface = "pmm-simulated"``."""

import threading
from collections import deque
from pathlib import Path

import can

from hardware.driver import Prompt
from hardware.simulation_identity import SimulatedTables
from sim.devices.bench_file import read_bench
from sim.devices.operator import SimulatedOperator
from sim.devices.registry import give_back, take


class SimulatedBus(can.BusABC):
    """A bus over a queue: what is sent is answered before ``send`` returns.

    The thread that sends never waits in :meth:`recv`, because nothing can come meanwhile; another
    one does.

    Parameters
    ----------
    channel
        Name of the simulated rig, or its file (see :mod:`sim.devices.registry`).

    Attributes
    ----------
    private
        Whether no other process can be on it.
    """

    private = True

    def __init__(self, channel: str, **_options: object) -> None:
        self._name = channel
        self._world = take(channel)
        super().__init__(channel)
        self.channel_info = f"simulated rig {channel}"
        self._frames: deque[can.Message] = deque()
        self._arrived = threading.Event()
        self._owner = threading.get_ident()
        self._world.wire.outlets.append(self._frames)
        self._take = self._world.wire.take

    @staticmethod
    def tables(channel: str) -> SimulatedTables | None:
        """Return which rig is simulated behind a channel; ``None`` for a program's own world.

        Raises
        ------
        ConfigurationError
            If its file is wrong.
        """
        return read_bench(Path(channel)).tables if channel.endswith(".toml") else None

    @property  # type: ignore[misc]  # nobody sets the state of this bus
    def state(self) -> can.BusState:
        """Whether the controller is in order."""
        return can.BusState.ERROR if self._world.bus_off else can.BusState.ACTIVE

    def operator(self, person: Prompt) -> Prompt:
        """Return who does by hand what a rig asks for; ``person`` is asked about dials first."""
        return SimulatedOperator(self._world, person)

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame; the nodes answer at once.

        Raises
        ------
        can.CanOperationError
            If the bus is off.
        """
        if self._world.bus_off:
            raise can.CanOperationError("bus off")
        for outlet in self._world.wire.outlets:
            if outlet is not self._frames:
                outlet.append(msg)
        self._take(msg)
        if not self._arrived.is_set():
            self._arrived.set()

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame, or ``None``.

        Raises
        ------
        can.CanOperationError
            If the adapter is deaf.
        """
        if self._world.deaf:
            raise can.CanOperationError("the adapter does not answer")
        if not self._frames and threading.get_ident() != self._owner:
            self._arrived.clear()
            if not self._frames:
                self._arrived.wait(timeout)
        return self._frames.popleft() if self._frames else None

    def shutdown(self) -> None:
        """Unplug from the simulated rig."""
        if not self._is_shutdown:
            _remove(self._world.wire.outlets, self._frames)
            give_back(self._name)
        super().shutdown()


def _remove(outlets: list[deque[can.Message]], outlet: deque[can.Message]) -> None:
    """Remove a queue by identity: two empty ones are equal."""
    outlets[:] = [queue for queue in outlets if queue is not outlet]
