"""Simulated controllers of carriage and angles: registers behind Modbus, as rig.toml maps them."""

import math
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final

from hardware.asked_device import Number, Place, Status, spans
from hardware.asked_link import READ, WRITE
from hardware.carriage_settings import (
    AskedCarriageSettings,
    CarriageLines,
    CarriageRegisters,
    ModbusCarriageSettings,
)
from hardware.modbus_axis import AxisRegisters, ModbusAxisSettings
from hardware.modbus_frames import framer_of
from hardware.modbus_registers import StatusRegister
from sim.devices.plant import Passage
from sim.devices.serial_devices import SerialCable

if TYPE_CHECKING:
    from pymodbus.pdu import ModbusPDU

_HOLDING: Final = READ["holding"]
_ILLEGAL_FUNCTION, _ILLEGAL_ADDRESS = 1, 2
_STEP_S: Final = 0.1  # a ramp is steps of so long: each has the chain made anew
_ALONE_S: Final = 1.0  # without a request for so long it stops by itself


class Controller:
    """A programmable controller with registers and a motor.

    Attributes
    ----------
    local, alarm
        Faults: a person has it in hand; it has stopped by itself.
    stale
        Fault: it answers, but its program stands.
    refuses
        Fault: the exception that it answers everything with; 0 for none.
    torn
        Fault: its answers lack their last bytes.
    unit_id
        Which unit it answers as; another one than it is asked for is a fault.
    """

    def __init__(self, name: str, settings: ModbusCarriageSettings | ModbusAxisSettings) -> None:
        from pymodbus.pdu import DecodePDU

        self.unit_id = settings.unit_id
        self._framer = framer_of(name, settings.port.framing)
        self._framer.decoder = DecodePDU(True)
        self._begin(settings.registers)

    def _begin(self, registers: CarriageRegisters | AxisRegisters | CarriageLines) -> None:
        self.cable = SerialCable()
        self.mute = self.local = self.alarm = self.stale = self.torn = False
        self.refuses = 0
        self._status, self._command = registers.status, registers.command
        self._life = getattr(registers, "life", None)
        self._words: dict[Place, int] = {}
        self._heard_s = -math.inf
        self._asked = b""
        self._count = 0
        self._time_s = 0.0
        self._map(registers.read().values(), registers.status)

    def tick(self, time_s: float, _passages: tuple[Passage, ...]) -> None:
        """Go on up to a time, and answer what has been asked."""
        step_s, self._time_s = time_s - self._time_s, time_s
        self.move(step_s)
        if not self.stale:
            self._show()
        self._asked += bytes(self.cable.heard)
        self.cable.heard.clear()
        self._serve()

    def _serve(self) -> None:
        """Answer what has been asked."""
        while self._asked:
            used, unit, number, request = self._framer.decode(self._asked)
            if not used:
                break
            self._asked = self._asked[used:]
            if request:
                self._answer(unit, number, request)

    def move(self, step_s: float) -> None:
        """Advance the motor by ``step_s``; each kind of controller does it its own way."""
        raise AssertionError("a controller has something to move")

    @property
    def driven(self) -> bool:
        """Whether it is under power and does what it is told."""
        alone = self._time_s - self._heard_s > _ALONE_S
        return not (self.local or self.alarm or alone) and self._commanded("enable")

    def number(self, register: Number) -> float:
        """Return the number that stands in a register."""
        places = range(register.address, register.address + register.count)
        return register.value([self._words.get((_HOLDING, at), 0) for at in places])

    def show(self, register: Number | None, value: float) -> None:
        """Write a number into a register that is read."""
        if register is None:
            return
        for i, word in enumerate(register.written(value)):
            self._words[READ[register.table], register.address + i] = word

    def _map(self, numbers: Iterable[Number], status: Status | None) -> None:
        for (function, first), count in spans(numbers, status):
            self._words |= {(function, first + i): 0 for i in range(count)}

    def _commanded(self, name: str) -> bool:
        command = self._command
        bit = None if command is None else getattr(command, name)
        if command is None or bit is None:
            return True
        return bool(self._words.get((_HOLDING, command.address), 0) >> bit & 1)

    def _show(self) -> None:
        self._count = (self._count + 1) % 1000
        self.show(self._life, self._count)
        status = self._status
        if isinstance(status, StatusRegister):
            says = self._states()
            bits = ((getattr(status, name), on != (name in status.inverted))
                    for name, on in says.items())  # fmt: skip
            word = sum(1 << bit for bit, on in bits if bit is not None and on)
            self._words[READ[status.table], status.address] = word

    def _states(self) -> dict[str, bool]:
        return {
            "remote": not self.local,
            "ready": self.driven,
            "alarm": self.alarm,
            "at_end": False,
        }

    def _answer(self, unit: int, number: int, request: bytes) -> None:
        pdu = self._framer.decoder.decode(request)
        if pdu is None or self.mute or not self.cable.plugged:
            return
        self._heard_s = self._time_s
        answer = self._served(pdu)
        answer.dev_id, answer.transaction_id = unit and self.unit_id, number
        frame = self._framer.buildFrame(answer)
        self.cable.waiting += frame[:-3] if self.torn else frame

    def _served(self, request: "ModbusPDU") -> "ModbusPDU":
        from pymodbus.pdu import ExceptionResponse
        from pymodbus.pdu.register_message import (
            ReadHoldingRegistersResponse,
            ReadInputRegistersResponse,
            WriteMultipleRegistersResponse,
        )

        function, first, count = request.function_code, request.address, request.count
        if self.refuses:
            return ExceptionResponse(function, self.refuses)
        if function == WRITE:
            for i, word in enumerate(request.registers):
                self._words[_HOLDING, first + i] = word
            self.alarm = self.alarm and not self._resets()
            return WriteMultipleRegistersResponse(address=first, count=count)
        if function not in READ.values():
            return ExceptionResponse(function, _ILLEGAL_FUNCTION)
        places = [(function, first + i) for i in range(count)]
        if not all(place in self._words for place in places):
            return ExceptionResponse(function, _ILLEGAL_ADDRESS)
        kind = ReadHoldingRegistersResponse if function == _HOLDING else ReadInputRegistersResponse
        return kind(registers=[self._words[place] for place in places])

    def _resets(self) -> bool:
        return (
            self._command is not None
            and self._command.reset is not None
            and (self._commanded("reset"))
        )


class SimulatedCarriage(Controller):
    """Runs on its ramps at the speed that stands in its register.

    Parameters
    ----------
    driven
        Returns speed and rate of turn that the carriage really has, with what ripples on them.
    runs
        Told both along the ramp, in steps: the circle is kept.
    """

    def __init__(
        self,
        name: str,
        settings: AskedCarriageSettings,
        driven: Callable[[], tuple[float, float]],
        runs: Callable[[float, float], None],
    ) -> None:
        self._open(name, settings)
        self._settings, self._really, self._runs = settings, driven, runs
        self._ramp_m_s = self._told_m_s = self._curvature = 0.0
        self.position_m = settings.track_m[0] if settings.track_m is not None else 0.0
        self.show(settings.signals.position, self.position_m)

    def _open(self, name: str, settings: AskedCarriageSettings) -> None:
        if not isinstance(settings, ModbusCarriageSettings):
            raise TypeError(f"{name}: a controller has registers")
        Controller.__init__(self, name, settings)

    def move(self, step_s: float) -> None:
        """Go on along the ramp and the track."""
        settings = self._settings
        wanted = self.number(settings.signals.set_speed) if self.driven else 0.0
        most = settings.acceleration_m_s2 * step_s
        self._ramp_m_s += min(max(wanted - self._ramp_m_s, -most), most)
        late = abs(self._ramp_m_s - self._told_m_s) >= settings.acceleration_m_s2 * _STEP_S
        if self._ramp_m_s != self._told_m_s and (late or self._ramp_m_s == wanted):
            self._told_m_s = self._ramp_m_s
            self._runs(self._ramp_m_s, self._ramp_m_s * self._per_radius(wanted))
        speed, turn = self._really()
        self.position_m += speed * step_s
        if not self.stale:
            self.show(settings.signals.speed, speed)
            self.show(settings.signals.position, self.position_m)
            self.show(settings.signals.turn_rate, turn)

    def _per_radius(self, wanted_m_s: float) -> float:
        """Return one over the circle's radius; on the ramp down that which it has."""
        register = self._settings.signals.set_turn_rate
        if register is not None and wanted_m_s:
            self._curvature = self.number(register) / wanted_m_s
        return self._curvature


class SimulatedAngle(Controller):
    """Turns to the angle that stands in its register.

    Parameters
    ----------
    moved
        Told the angle when it has arrived.
    """

    def __init__(
        self, name: str, settings: ModbusAxisSettings, moved: Callable[[float], None]
    ) -> None:
        super().__init__(name, settings)
        self._settings, self._moved = settings, moved
        self.angle_rad = 0.0
        self._arrived = True

    def move(self, step_s: float) -> None:
        """Go on towards the angle; the model has it once the table stands."""
        settings = self._settings
        wanted = self.number(settings.registers.set_position) if self.driven else self.angle_rad
        most = settings.speed * step_s
        way = min(max(wanted - self.angle_rad, -most), most)
        self.angle_rad += way
        if way == 0.0 and not self._arrived:
            self._moved(self.angle_rad)
        self._arrived = way == 0.0
        if not self.stale:
            self.show(settings.registers.position, self.angle_rad)
