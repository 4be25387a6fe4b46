"""A simulated rig behind a real interface, for a controller in another process."""

import os
import select
from collections import deque
from collections.abc import Callable
from typing import Protocol, TextIO

import can

from hardware.description.errors import ConfigurationError
from sim.devices.bench_file import Bench
from sim.devices.faults import inject
from sim.devices.terminal import PseudoTerminal

_POLL_S = 0.05
_CHUNK = 4096
_IDLE_PERIODS = 3  # without SYNC for so long, time goes on by the clock


class FrameCarrier(Protocol):
    """What carries frames: a bus of python-can that can be waited for, or the slcan adapter."""

    def fileno(self) -> int:
        """Return the file descriptor that becomes readable."""
        ...

    def recv(self, timeout: float | None = None) -> can.Message | None:
        """Return the next frame, or ``None``."""
        ...

    def send(self, msg: can.Message, timeout: float | None = None) -> None:
        """Send a frame."""
        ...


class Host:
    """Serves a simulated rig in one thread: frames, serial lines, and commands by line.

    A line is a fault of :mod:`sim.devices.faults`, ``reset`` for a rig as new, or ``quit``.

    Parameters
    ----------
    clock
        Monotonic seconds, if the rig is to live on without SYNC, as a real one does: it notices
        then that its controller hangs. Without a clock SYNC alone is time, and a controller may run
        as fast as it can.
    """

    def __init__(
        self,
        bench: Bench,
        carrier: FrameCarrier,
        commands: TextIO,
        answers: TextIO,
        clock: Callable[[], float] | None = None,
    ) -> None:
        self._bench, self._carrier = bench, carrier
        self._commands, self._answers, self._clock = commands, answers, clock
        self._frames: deque[can.Message] = deque()
        self._serving = True
        self._rest = b""
        self._reset()
        self._terminals = {name: PseudoTerminal() for name in self.world.talkers}
        self._lived_s = clock() if clock else 0.0

    @property
    def ports(self) -> dict[str, str]:
        """The device of each serial line."""
        return {name: terminal.path for name, terminal in self._terminals.items()}

    def serve(self) -> None:
        """Serve until ``quit``, or until the commands end."""
        while self._serving:
            listened = [self._carrier.fileno(), self._commands.fileno()]
            ready, _, _ = select.select(listened, [], [], self._wait_s())
            if listened[1] in ready:
                self._listen()
            if listened[0] in ready:
                self._exchange()
            self._live()
            self._speak()

    def close(self) -> None:
        """Hang up the serial lines; the carrier is the caller's."""
        for terminal in self._terminals.values():
            terminal.close()

    def _reset(self) -> None:
        self.world = self._bench.world()
        self.world.wire.outlets.append(self._frames)

    def _wait_s(self) -> float:
        return min(_POLL_S, 1.0 / self.world.plant.sample_rate_hz) if self._clock else _POLL_S

    def _exchange(self) -> None:
        while (frame := self._carrier.recv(0.0)) is not None:
            before = self.world.wire.number
            self.world.wire.take(frame)
            self._send()
            if self._clock and self.world.wire.number != before:
                self._lived_s = self._clock()

    def _send(self) -> None:
        while self._frames:
            self._carrier.send(self._frames.popleft())

    def _live(self) -> None:
        """Let time pass by the clock where no SYNC says it."""
        if self._clock is None:
            return
        period_s = 1.0 / self.world.plant.sample_rate_hz
        if self._clock() - self._lived_s < _IDLE_PERIODS * period_s:
            return
        while self._lived_s + period_s < self._clock():
            self._lived_s += period_s
            self.world.live()
        self._send()

    def _speak(self) -> None:
        for name, terminal in self._terminals.items():
            cable = self.world.talkers[name].cable
            if cable.plugged:
                cable.heard += terminal.read()
                del cable.waiting[: terminal.write(cable.waiting) if cable.waiting else 0]

    def _listen(self) -> None:
        heard = os.read(self._commands.fileno(), _CHUNK)
        if not heard:
            self._serving = False
        *lines, self._rest = (self._rest + heard).split(b"\n")
        for line in lines:
            self._command(line.decode("utf-8", "replace").strip())

    def _command(self, words: str) -> None:
        try:
            if words == "quit":
                self._serving = False
            elif words == "reset":
                self._reset()
            else:
                inject(self.world, words)
        except ConfigurationError as error:
            self._say(f"refused: {error}")
        else:
            self._say("done")

    def _say(self, text: str) -> None:
        try:
            self._answers.write(f"{text}\n")
            self._answers.flush()
        except (BrokenPipeError, ValueError):
            self._serving = False  # nobody listens any more
