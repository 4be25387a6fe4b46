"""One device asked over Modbus, a request at a time, without ever waiting."""

import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Final

from hardware.description.errors import ConfigurationError
from hardware.driver import Services
from hardware.errors import HardwareError, LineError, ModbusError, SilentPortError, worst
from hardware.modbus_frames import ModbusPortSettings, framer_of
from hardware.roles import Cycle

READ: Final = {"holding": 3, "input": 4}
WRITE: Final = 16
_LOOKS_HZ: Final = 100.0
_LATER: Final = (5, 6)  # acknowledged, busy: asked again
_EXCEPTIONS: Final = {
    1: ("illegal function", "the device has no such table or cannot write; correct table"),
    2: ("illegal address", "correct address, type or table of the register map"),
    3: ("illegal value", "correct type, scale or unit of the register map"),
    4: ("device failure", "look at its own display, then reset"),
    10: ("gateway path unavailable", "correct unit_id, or the gateway's own table"),
    11: ("gateway target does not respond", "correct unit_id, and look whether it has power"),
}


@dataclass(frozen=True)
class ModbusSettings:
    """How a device is reached.

    Attributes
    ----------
    unit_id
        Which device behind the port: 1 to 247; 255 or 0 for one alone behind TCP.
    answer_s
        After so long without an answer it is asked again.
    silent_s
        After so long without any it is silent.
    refresh_s
        So often is written again what it was told, so that it notices when nobody is there.
    """

    port: ModbusPortSettings
    unit_id: int = 1
    answer_s: float = 0.2
    silent_s: float = 1.0
    refresh_s: float = 0.2

    def __post_init__(self) -> None:
        if not 0 <= self.unit_id <= 255:
            raise ConfigurationError(f"unit_id = {self.unit_id}; it is 0 to 255")
        if not 0.0 < self.answer_s < self.silent_s:
            raise ConfigurationError(
                f"answer_s = {self.answer_s:g} has to be above 0 and below silent_s = "
                f"{self.silent_s:g}: a single answer that is lost is asked for again"
            )


@dataclass(frozen=True)
class ModbusRequest:
    """What is asked: so many registers read, or words written, from an address on."""

    function: int
    address: int
    count: int = 0
    words: tuple[int, ...] = ()


Answer = tuple[ModbusRequest, tuple[int, ...]]
"""What was asked, and the words that were read or written."""


class ModbusLink:
    """Asks a device; raises as its port does where it cannot be opened."""

    def __init__(self, name: str, settings: ModbusSettings, services: Services) -> None:
        self.name = name
        self._settings = settings
        self._framer = framer_of(name, settings.port.framing)  # says what to install
        from pymodbus.pdu import DecodePDU

        self._requests = DecodePDU(True)
        self._port = services.port(name, settings.port)
        self._number = 0
        self._asked_s: float | None = None  # since when an answer is waited for
        self._heard_s: float | None = None
        self._answers = False
        self._trouble = ""
        self._told: set[type] = set()

    @property
    def is_open(self) -> bool:
        """Whether its port is open, as far as is known."""
        return self._port.is_open

    @property
    def heard(self) -> bool:
        """Whether it answers."""
        return self._answers

    def reset(self) -> None:
        """Open a lost port again and begin anew; raises as :meth:`SerialPort.open`."""
        self._port.open()
        self._asked_s = self._heard_s = None
        self._answers = False
        self.forget()

    def forget(self) -> None:
        """Tell again what was told once."""
        self._trouble = ""
        self._told.clear()

    def assume(self, *, heard: bool) -> None:
        """Go on where another link stood: whether the device had answered."""
        self._answers = heard

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def exchange(
        self, cycle: Cycle, following: Callable[[], ModbusRequest | None]
    ) -> tuple[list[Answer], list[HardwareError]]:
        """Take the answers of the cycle and ask for what follows; return both, faults once each."""
        answers: list[Answer] = []
        faults: list[HardwareError] = []
        now_s = cycle.time_s
        try:
            for line in self._port.lines():
                self._asked_s = None
                answers += self._understood(line)
            due = self._asked_s is None or now_s - self._asked_s > self._settings.answer_s
            request = following() if due and self._port.is_open else None
            if request is not None:
                self._asked_s = now_s
                self._port.write(self._frame(request))
        except LineError as error:  # a single one is asked for again
            self._trouble = str(error)
        except HardwareError as error:
            faults.append(error)
        refused = any(isinstance(one, ModbusError) for one in faults)
        since_s = now_s if answers or refused or self._heard_s is None else self._heard_s
        self._heard_s = since_s
        self._answers = (bool(answers) or self._answers) and not refused
        faults += self._silence(now_s - since_s)
        fresh = [one for one in faults if type(one) not in self._told]
        self._told |= {type(one) for one in fresh}
        return answers, fresh

    def _silence(self, silent_s: float) -> Iterator[HardwareError]:
        if silent_s <= self._settings.silent_s:
            return
        self._answers = False
        why = self._trouble or "check its power, the cable and unit_id"
        yield SilentPortError(
            self.name,
            f"no answer for {silent_s:.2f} s (limit {self._settings.silent_s:g} s); {why}",
        )

    def _understood(self, line: bytes) -> Iterator[Answer]:
        asked, said = (bytes.fromhex(part) for part in line.decode("ascii").split(" "))
        if asked[0] != said[0]:
            raise LineError(
                self.name, f"unit {said[0]} answers where {asked[0]} was asked; correct unit_id"
            )
        request, answer = self._requests.decode(asked[1:]), self._framer.decoder.decode(said[1:])
        if request is None or answer is None:
            raise LineError(self.name, f"{said.hex()} is no answer; check what is at that address")
        if answer.isError():
            raise self._refusal(asked[1], request.address, answer.exception_code)
        one = ModbusRequest(asked[1], request.address, request.count, tuple(request.registers))
        words = one.words or tuple(answer.registers)
        if answer.function_code != one.function or len(words) != (len(one.words) or one.count):
            raise LineError(
                self.name,
                f"answers {len(words)} registers of function {answer.function_code} where "
                f"{one.count} of {one.function} were asked for; look who else asks it",
            )
        yield one, words

    def _refusal(self, function: int, address: int, code: int) -> HardwareError:
        if code in _LATER:
            return LineError(self.name, "says that it is busy; ask it less often (refresh_s)")
        what, remedy = _EXCEPTIONS.get(code, ("unknown to us", "look into the device's manual"))
        doing = "to write" if function == WRITE else f"to read (function {function})"
        return ModbusError(
            self.name, f"refuses {doing} register {address}: exception {code}, {what}; {remedy}"
        )

    def _frame(self, request: ModbusRequest) -> bytes:
        from pymodbus.pdu.register_message import (
            ReadHoldingRegistersRequest,
            ReadInputRegistersRequest,
            WriteMultipleRegistersRequest,
        )

        self._number = self._number % 0xFFFF + 1
        kinds = {
            READ["holding"]: ReadHoldingRegistersRequest,
            READ["input"]: ReadInputRegistersRequest,
            WRITE: WriteMultipleRegistersRequest,
        }
        pdu = kinds[request.function](
            dev_id=self._settings.unit_id,
            transaction_id=self._number,
            address=request.address,
            count=request.count,
            registers=request.words,
        )
        return self._framer.buildFrame(pdu)


def read_once(
    name: str, settings: ModbusSettings, places: Sequence[tuple[tuple[int, int], int]]
) -> int:
    """Read registers of a device once, waiting for them; return how many there were.

    Raises
    ------
    PortOpenError, SilentPortError, ModbusError
        If it cannot be reached, does not answer, or refuses.
    """
    services = Services(time.monotonic, lambda _: None, _LOOKS_HZ)
    link = ModbusLink(name, settings, services)
    left = [ModbusRequest(function, address, count) for (function, address), count in places]
    found, began_s = 0, time.monotonic()
    try:
        while left:
            cycle = Cycle(0, time.monotonic() - began_s)
            answers, faults = link.exchange(cycle, partial(next, iter(left), None))
            if faults:
                raise worst(faults)
            for request, words in answers:
                left = [one for one in left if one != request]
                found += len(words)
            time.sleep(1.0 / _LOOKS_HZ)
    finally:
        link.close()
    return found
