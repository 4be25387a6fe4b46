"""A CAN bus from configuration, its load, and what receives from it.

:class:`Pumped` receives in the thread that asks (simulated time, or a quiet real bus);
:class:`Threaded` receives in a thread of its own. The code above sees no difference.
"""

import queue
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final, Protocol, cast

import can

from hardware.description.errors import ConfigurationError
from hardware.errors import BusOffError, BusOpenError, DeadReceiveThreadError

# Part of the bit rate that process data may take: the rest is for SDO, EMCY and repeated frames.
LARGEST_LOAD: Final = 0.7
FASTEST_HZ: Final = 10_000.0  # cycles: ten times what any loop here keeps
_ANSWER_SHARE: Final = 0.8  # of the period, for all nodes to answer a SYNC
_POLL_S: Final = 0.05
# An adapter that takes no frame for so long, or a thread that does not end, is given up.
_SEND_TIMEOUT_S: Final = 0.1
_JOIN_TIMEOUT_S: Final = 1.0


@dataclass(frozen=True)
class BusConfiguration:
    """How to open a bus and how fast to run it.

    Attributes
    ----------
    interface, channel
        As python-can names them (``socketcan``/``can0``, ``slcan``/``/dev/ttyACM0``,
        ``virtual``/any name ...), or the name of an interface that a package brings along.
    bit_rate
        Bits per second.
    sync_rate_hz
        SYNC messages, and so samples, per second.
    receive_thread
        Receive in a thread of its own: right for real time; a simulated bus is pumped instead.
    master_node
        Node id of the controller, for its heartbeat.
    heartbeat_ms, heartbeat_limit_ms
        Period of all heartbeats, and how long the drives wait for the controller's.
    allowed_gap_cycles
        Cycles that a heartbeat or process data may be late before it counts as lost.
    answer_ms
        How long the answers to a SYNC are waited for; 0 is four fifths of the period. Longer is for
        cycles that do not keep to a clock, so that a slow peer costs time and no samples.
    listen_ms
        How long to listen for another controller before anything is sent. One that runs a rig sends
        SYNC many times a second and its heartbeat at least once; half of it may miss a heartbeat
        alone, twice only takes longer. 0 does not listen.
    sync_overflow
        The SYNC counter runs from 1 to here (2 to 240); 0 sends SYNC without a counter.
    options
        Passed to the interface as they are, for example ``hop_limit``.
    """

    interface: str
    channel: str
    bit_rate: int = 1_000_000
    sync_rate_hz: float = 100.0
    receive_thread: bool = True
    master_node: int = 127
    heartbeat_ms: int = 100
    heartbeat_limit_ms: int = 300
    allowed_gap_cycles: int = 3
    answer_ms: int = 0
    listen_ms: int = 1000
    sync_overflow: int = 240
    options: Mapping[str, int | float | str | bool] = field(
        default_factory=lambda: MappingProxyType({})
    )

    def __post_init__(self) -> None:
        if not 0.0 < self.sync_rate_hz <= FASTEST_HZ:
            raise ConfigurationError(
                f"sync_rate_hz = {self.sync_rate_hz:g} has to be above 0, at most {FASTEST_HZ:g}"
            )
        if not 0 < self.heartbeat_ms < self.heartbeat_limit_ms:
            raise ConfigurationError(
                f"heartbeat_limit_ms = {self.heartbeat_limit_ms} has to be above heartbeat_ms = "
                f"{self.heartbeat_ms}, which has to be above 0: by them drives stop when this "
                "program is gone"
            )

    @property
    def period_s(self) -> float:
        """Seconds from SYNC to SYNC."""
        return 1.0 / self.sync_rate_hz

    @property
    def answer_s(self) -> float:
        """Seconds that the answers to a SYNC are waited for."""
        return self.answer_ms / 1000.0 if self.answer_ms else _ANSWER_SHARE * self.period_s


def frame_bits(data_bytes: int) -> int:
    """Return the bits of a frame with an 11-bit identifier, stuffed as badly as can be.

    44 bits of frame and 3 of interframe space around the data; a stuff bit can follow the first
    five of the ``34 + 8 n`` stuffed bits and every four after (ISO 11898-1).
    """
    return 47 + 8 * data_bytes + (33 + 8 * data_bytes) // 4


def bus_load(frames_per_s: Mapping[int, float], bit_rate: int) -> float:
    """Return the part of the bit rate that frames take.

    Parameters
    ----------
    frames_per_s
        Frames per second by their number of data bytes.
    """
    return sum(frame_bits(size) * rate for size, rate in frames_per_s.items()) / bit_rate


def check_load(load: float, configuration: BusConfiguration) -> None:
    """Refuse what a bus cannot carry.

    Raises
    ------
    ConfigurationError
        If the load is above :data:`LARGEST_LOAD`.
    """
    if load > LARGEST_LOAD:
        fits = configuration.sync_rate_hz * LARGEST_LOAD / load
        raise ConfigurationError(
            f"bus.sync_rate_hz = {configuration.sync_rate_hz:g} loads the bus with {load:.0%} of "
            f"its {configuration.bit_rate} bit/s; the limit is {LARGEST_LOAD:.0%}. Up to "
            f"{fits:.0f} Hz fit"
        )


def open_bus(configuration: BusConfiguration) -> can.BusABC:
    """Open the bus.

    Raises
    ------
    BusOpenError
        If the interface or the channel cannot be had; the message says why.
    """
    where = f"bus {configuration.interface}:{configuration.channel}"
    try:
        return can.Bus(
            interface=configuration.interface,
            channel=configuration.channel,
            bitrate=configuration.bit_rate,
            ignore_config=True,
            **cast("dict[str, Any]", dict(configuration.options)),
        )
    except NotImplementedError as error:
        raise BusOpenError(where, f"{error}; see python-can's list of interfaces") from error
    except (can.CanError, OSError, ValueError, TypeError, RuntimeError) as error:
        raise BusOpenError(where, f"{error}") from error


class Receiver(Protocol):
    """Takes frames off a bus."""

    def receive(self, timeout_s: float) -> can.Message | None:
        """Return the next frame, or ``None`` if none comes in time.

        Raises
        ------
        DeadReceiveThreadError
            If receiving has ended.
        """
        ...

    def close(self) -> None:
        """Stop receiving; the bus stays open."""
        ...


class Pumped:
    """Receives in the caller's thread."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus

    def receive(self, timeout_s: float) -> can.Message | None:
        """Return the next frame; see :class:`Receiver`."""
        try:
            return self._bus.recv(timeout_s)
        except (can.CanError, OSError) as error:
            raise DeadReceiveThreadError("bus", f"receiving failed: {error}") from error

    def close(self) -> None:
        """Nothing to stop."""


class Threaded:
    """Receives in a thread of its own, whose death is noticed at the next :meth:`receive`."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus
        self._frames: queue.SimpleQueue[can.Message] = queue.SimpleQueue()
        self._stop = threading.Event()
        self._error: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="bus receiver", daemon=True)
        self._thread.start()

    def receive(self, timeout_s: float) -> can.Message | None:
        """Return the next frame; see :class:`Receiver`."""
        try:
            return self._frames.get(timeout_s > 0, max(timeout_s, 0.0))
        except queue.Empty:
            self._check()
            return None

    def close(self) -> None:
        """Stop the thread and wait for its end, unless it hangs in the adapter."""
        self._stop.set()
        self._thread.join(_JOIN_TIMEOUT_S)

    def _check(self) -> None:
        if not self._thread.is_alive():
            why = f": {self._error}" if self._error else ""
            raise DeadReceiveThreadError(
                "bus", f"the receive thread ended{why}; close the rig and open it again"
            )

    def _run(self) -> None:
        try:
            while not self._stop.is_set():
                frame = self._bus.recv(_POLL_S)
                if frame is not None:
                    self._frames.put(frame)
        except Exception as error:  # whatever ends the thread has to be told to the caller
            self._error = error


class Sender:
    """Sends frames; whatever the adapter raises is the loss of the bus."""

    def __init__(self, bus: can.BusABC) -> None:
        self._bus = bus
        self._lock = threading.Lock()

    def send(self, identifier: int, data: bytes) -> can.Message:
        """Send one frame with an 11-bit identifier and return it.

        Raises
        ------
        BusOffError
            If the adapter cannot send.
        """
        return self._pass(
            can.Message(
                arbitration_id=identifier, data=data, is_extended_id=False, is_rx=False, check=False
            )
        )

    def request(self, identifier: int) -> can.Message:
        """Send a remote frame, which asks for the frame of that identifier; raises as `send`."""
        return self._pass(
            can.Message(
                arbitration_id=identifier,
                is_remote_frame=True,
                is_extended_id=False,
                is_rx=False,
                dlc=1,
            )
        )

    def _pass(self, frame: can.Message) -> can.Message:
        try:
            with self._lock:
                self._bus.send(frame, _SEND_TIMEOUT_S)
        except (can.CanError, OSError) as error:
            raise BusOffError(
                "bus", f"frame 0x{frame.arbitration_id:03X} cannot be sent: {error}"
            ) from error
        return frame
