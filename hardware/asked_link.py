"""A device asked through a port, a request at a time, without ever waiting.

What is asked for are registers, whether a programmable controller has them or a panel says them in
lines of text.
"""

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, Final

from hardware.description.errors import ConfigurationError
from hardware.driver import Services
from hardware.errors import HardwareError, LineError, ModbusError, SilentPortError, worst
from hardware.roles import Cycle
from hardware.serial_port import Port

READ: Final = {"holding": 3, "input": 4}
WRITE: Final = 16
_LOOKS_HZ: Final = 100.0


@dataclass(frozen=True, kw_only=True)
class AskedSettings(ABC):
    """How a device is asked.

    Attributes
    ----------
    answer_s
        After so long without an answer it is asked again.
    silent_s
        After so long without any it is silent.
    refresh_s
        So often is written again what it was told, so that it notices when nobody is there.
    """

    answer_s: float = 0.2
    silent_s: float = 1.0
    refresh_s: float = 0.2

    def __post_init__(self) -> None:
        if not 0.0 < self.answer_s <= self.lost_s < self.silent_s:
            raise ConfigurationError(
                f"answer_s = {self.answer_s:g} has to be above 0 and below silent_s = "
                f"{self.silent_s:g}: a single answer that is lost is asked for again after "
                f"{self.lost_s:g} s"
            )

    @property
    def is_numbered(self) -> bool:
        """Whether an answer says which question it belongs to."""
        return True

    @property
    def lost_s(self) -> float:
        """After so long is asked again what was not answered.

        Without numbers the line has to be quiet for as long again as an answer may take: one that
        comes late would be taken for the next question's, and so on with all that follow.
        """
        return self.answer_s if self.is_numbered else 2.0 * self.answer_s

    @abstractmethod
    def link(self, name: str, services: Services) -> "AskedLink":
        """Return what asks it; raises as :class:`AskedLink`."""


@dataclass(frozen=True)
class RegisterRequest:
    """What is asked: so many registers read, or words written, from an address on."""

    function: int
    address: int
    count: int = 0
    words: tuple[int, ...] = ()


Answer = tuple[RegisterRequest, tuple[int, ...]]
"""What was asked, and the words that were read or written."""
Following = Callable[[], RegisterRequest | None]
"""Returns what is asked for next."""


class AskedLink(ABC):
    """Asks a device.

    Attributes
    ----------
    remedy
        What to look at where it is silent and nothing else is known.
    """

    remedy: ClassVar[str] = "check its power, the cable and its settings"

    def __init__(self, name: str, settings: AskedSettings) -> None:
        self.name = name
        self._settings = settings
        self._heard_s: float | None = None
        self._answers = False
        self._trouble = ""
        self._told: set[type] = set()

    @property
    def is_open(self) -> bool:
        """Whether its port is open, as far as is known."""
        return True

    @property
    def is_answering(self) -> bool:
        """Whether the device answers and refuses nothing."""
        return self._answers

    def reset(self) -> None:
        """Begin anew; a port that is lost is opened again."""
        self._heard_s = None
        self._answers = False
        self.forget()

    def forget(self) -> None:
        """Report faults anew that were reported before."""
        self._trouble = ""
        self._told.clear()

    def assume(self, *, heard: bool) -> None:
        """Go on where another link stood: whether the device had answered."""
        self._answers = heard

    def prepare(self) -> None:  # noqa: B027
        """Write the device's settings, if it has any."""

    def close(self) -> None:  # noqa: B027
        """Close the port, if it has one."""

    def exchange(
        self, cycle: Cycle, following: Following
    ) -> tuple[list[Answer], list[HardwareError]]:
        """Take the answers of the cycle and ask for what follows; return both, faults once each."""
        now_s = cycle.time_s
        answers, faults = self._poll(cycle, following)
        refused = any(isinstance(fault, ModbusError) for fault in faults)
        since_s = now_s if answers or refused or self._heard_s is None else self._heard_s
        self._heard_s = since_s
        self._answers = (bool(answers) or self._answers) and not refused
        faults += self._silence(now_s - since_s)
        fresh = [fault for fault in faults if type(fault) not in self._told]
        self._told |= {type(fault) for fault in fresh}
        return answers, fresh

    def _silence(self, silent_s: float) -> Iterator[HardwareError]:
        if silent_s <= self._settings.silent_s:
            return
        self._answers = False
        why = self._trouble or self.remedy
        yield SilentPortError(
            self.name,
            f"no answer for {silent_s:.2f} s (limit {self._settings.silent_s:g} s); {why}",
        )

    @abstractmethod
    def _poll(self, cycle: Cycle, following: Following) -> tuple[list[Answer], list[HardwareError]]:
        """Return the answers of the cycle, and what went wrong; ask for what follows."""


class PortLink(AskedLink):
    """Asks a device behind a port; raises as its port does where it cannot be opened."""

    def __init__(self, name: str, settings: AskedSettings, port: Port) -> None:
        super().__init__(name, settings)
        self._port = port
        self._asked_s: float | None = None  # since when an answer is waited for
        self._now_s = 0.0
        self._quiet_s: float | None = None  # since when nothing has come that belongs nowhere

    @property
    def is_open(self) -> bool:
        """Whether its port is open, as far as is known."""
        return self._port.is_open

    def reset(self) -> None:
        """Open a lost port again and begin anew; raises as :meth:`SerialPort.open`."""
        was_open = self._port.is_open
        self._port.open()
        self._asked_s = None
        if was_open:  # an answer may still be under way
            self._quiet(self._now_s)
        super().reset()

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _poll(self, cycle: Cycle, following: Following) -> tuple[list[Answer], list[HardwareError]]:
        answers: list[Answer] = []
        self._now_s = now_s = cycle.time_s
        try:
            for line in self._arrived(now_s):
                self._asked_s = None
                answers += self._answers_in(line)
            request = following() if self._is_due(now_s) and self._port.is_open else None
            if request is not None:
                self._asked_s = now_s
                self._port.write(self._frame(request))
        except LineError as error:  # a single one is asked for again
            self._trouble = str(error)
            if self._asked_s is None or self._quiet_s is not None:  # what came belongs nowhere
                self._quiet(now_s)
        except HardwareError as error:
            return answers, [error]
        return answers, []

    def _arrived(self, now_s: float) -> list[bytes]:
        """Return what has come, but for what belongs to no question."""
        lines = self._port.lines()
        if self._quiet_s is None:
            return lines
        if lines:
            self._quiet_s = now_s
        return []

    def _quiet(self, now_s: float) -> None:
        """Take nothing from now on, until nothing comes any more."""
        self._asked_s = None
        self._quiet_s = None if self._settings.is_numbered else now_s

    def _is_due(self, now_s: float) -> bool:
        """Whether to ask what follows: the last was answered, or is lost and the line quiet."""
        if self._asked_s is not None and now_s - self._asked_s > self._settings.answer_s:
            self._quiet(now_s)
        if self._quiet_s is not None and now_s - self._quiet_s > self._settings.answer_s:
            self._quiet_s = None
        return self._asked_s is None and self._quiet_s is None

    @abstractmethod
    def _answers_in(self, line: bytes) -> Iterator[Answer]:
        """Yield the answers of a line; raise what it shows."""

    @abstractmethod
    def _frame(self, request: RegisterRequest) -> bytes:
        """Return what is sent for a request."""


def read_once(
    name: str, settings: AskedSettings, places: Sequence[tuple[tuple[int, int], int]]
) -> int:
    """Read registers of a device once, waiting for them; return how many there were.

    Raises
    ------
    PortOpenError, SilentPortError, ModbusError
        If it cannot be reached, does not answer, or refuses.
    """
    services = Services(time.monotonic, lambda _: None, _LOOKS_HZ)
    link = settings.link(name, services)
    requests = [RegisterRequest(function, address, count) for (function, address), count in places]
    total, began_s = 0, time.monotonic()
    try:
        while requests:
            cycle = Cycle(0, time.monotonic() - began_s)
            answers, faults = link.exchange(cycle, partial(next, iter(requests), None))
            if faults:
                raise worst(faults)
            for request, words in answers:
                requests = [waiting for waiting in requests if waiting != request]
                total += len(words)
            time.sleep(1.0 / _LOOKS_HZ)
    finally:
        link.close()
    return total
