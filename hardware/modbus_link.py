"""One device asked over Modbus, a request at a time, without ever waiting."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from hardware.asked_link import READ, WRITE, Answer, AskedSettings, PortLink, RegisterRequest
from hardware.description.errors import ConfigurationError
from hardware.driver import Services
from hardware.errors import HardwareError, LineError, ModbusError
from hardware.modbus_frames import ModbusPortSettings, framer_of

_LATER: Final = (5, 6)  # acknowledged, busy: asked again
_EXCEPTIONS: Final = {
    1: ("illegal function", "the device has no such table or cannot write; correct table"),
    2: ("illegal address", "correct address, type or table of the register map"),
    3: ("illegal value", "correct type, scale or unit of the register map"),
    4: ("device failure", "look at its own display, then reset"),
    10: ("gateway path unavailable", "correct unit_id, or the gateway's own table"),
    11: ("gateway target does not respond", "correct unit_id, and look whether it has power"),
}


@dataclass(frozen=True, kw_only=True)
class ModbusSettings(AskedSettings):
    """How a Modbus device is reached.

    Attributes
    ----------
    unit_id
        Which device behind the port: 1 to 247; 255 or 0 for one alone behind TCP.
    """

    port: ModbusPortSettings
    unit_id: int = 1

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 <= self.unit_id <= 255:
            raise ConfigurationError(f"unit_id = {self.unit_id}; it is 0 to 255")

    @property
    def is_numbered(self) -> bool:
        """Whether an answer says which question it belongs to: by TCP it does."""
        return self.port.framing == "tcp"

    def link(self, name: str, services: Services) -> "ModbusLink":
        """Return what asks it."""
        return ModbusLink(name, self, services)


class ModbusLink(PortLink):
    """Asks a device; raises as its port does where it cannot be opened."""

    remedy = "check its power, the cable and unit_id"

    def __init__(self, name: str, settings: ModbusSettings, services: Services) -> None:
        self._framer = framer_of(name, settings.port.framing)  # says what to install
        from pymodbus.pdu import DecodePDU

        self._requests, self._unit_id, self._number = DecodePDU(True), settings.unit_id, 0
        super().__init__(name, settings, services.port(name, settings.port))

    def _answers_in(self, line: bytes) -> Iterator[Answer]:
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
        question = RegisterRequest(
            asked[1], request.address, request.count, tuple(request.registers)
        )
        words = question.words or tuple(answer.registers)
        elsewhere = question.function == WRITE and answer.address != question.address
        if (
            answer.function_code != question.function
            or elsewhere
            or len(words) != (len(question.words) or question.count)
        ):
            raise LineError(
                self.name,
                f"answers {len(words)} registers of function {answer.function_code} where "
                f"{question.count} of {question.function} were asked for; look who else asks it, "
                "and whether it answers later than answer_s",
            )
        yield question, words

    def _refusal(self, function: int, address: int, code: int) -> HardwareError:
        if code in _LATER:
            return LineError(self.name, "says that it is busy; ask it less often (refresh_s)")
        reason, remedy = _EXCEPTIONS.get(code, ("unknown to us", "look into the device's manual"))
        doing = "to write" if function == WRITE else f"to read (function {function})"
        return ModbusError(
            self.name, f"refuses {doing} register {address}: exception {code}, {reason}; {remedy}"
        )

    def _frame(self, request: RegisterRequest) -> bytes:
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
            dev_id=self._unit_id,
            transaction_id=self._number,
            address=request.address,
            count=request.count,
            registers=request.words,
        )
        return self._framer.buildFrame(pdu)
