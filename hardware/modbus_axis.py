"""An angle behind a programmable controller, over Modbus: a drift table for example."""

import math
from dataclasses import dataclass

from hardware.asked_device import AskedDevice, raise_worst
from hardware.command_limits import check_move
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.oscillator import Range
from hardware.driver import Driver, Services
from hardware.errors import NotReadyError
from hardware.limits import RAMP_MARGIN, REST_DEADLINE_S, check_above_0, check_ends
from hardware.modbus_link import ModbusSettings
from hardware.modbus_registers import CommandRegister, Register, StatusRegister
from hardware.roles import Cycle, Reading, Role


@dataclass(frozen=True)
class AxisRegisters:
    """Which registers are the axis's; those it lacks are left out. It reads absolutely."""

    set_position: Register
    position: Register
    status: StatusRegister | None = None
    command: CommandRegister | None = None
    life: Register | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def read(self) -> dict[str, Register]:
        """Return those that are read, by name."""
        registers = {"position": self.position, "life": self.life}
        return {name: register for name, register in registers.items() if register is not None}


@dataclass(frozen=True, kw_only=True)
class ModbusAxisSettings(ModbusSettings):
    """Settings of an axis in radians.

    Attributes
    ----------
    speed
        In rad/s, at which it moves: only for how long a move may take.
    tolerance
        So near what was asked for it has to be, in rad.
    settle_s
        For so long, and standing, before it has arrived.
    """

    registers: AxisRegisters
    low: float
    high: float
    speed: float
    tolerance: float
    standard_uncertainty: float
    settle_s: float = 1.0

    @property
    def signals(self) -> AxisRegisters:
        """Its registers."""
        return self.registers

    def __post_init__(self) -> None:
        super().__post_init__()
        check_ends(self.low, self.high)
        check_above_0(self, "speed", "tolerance", "standard_uncertainty", "settle_s")
        for position in (self.low, self.high):
            self.registers.set_position.written(position)


class ModbusAxis(AskedDevice):
    """A :class:`hardware.roles.PositionAxis` that reads absolutely: to home it is to read it."""

    unit = "rad"

    def __init__(self, name: str, settings: ModbusAxisSettings, services: Services) -> None:
        registers = settings.registers
        super().__init__(
            name, settings, services, registers.read(), registers.status, registers.command
        )
        self.limits = Range(settings.low, settings.high)
        self._settings = settings
        self._goal: float | None = None
        self._read = False
        self._stays = False  # whether it is still to be told to stay where it is
        self._read_s = -math.inf  # when its position was read last
        self._stood: tuple[float, float] | None = None  # where it stands, and since when

    @property
    def position(self) -> float:
        """The angle that it reads, in rad; NaN before, and in silence."""
        return self.values["position"] if self._is_heard else math.nan

    @property
    def homed(self) -> bool:
        """Whether it has been told to read, and does."""
        return self._read and not math.isnan(self.position)

    @property
    def reading(self) -> Reading | None:
        """Where it is; ``None`` before it is known."""
        if not self.homed:
            return None
        return Reading(self.position, self._settings.standard_uncertainty, "encoder")

    @property
    def moving(self) -> bool:
        """Whether it has moved lately, is on its way, or is not heard."""
        stood_s = -1.0 if self._stood is None else self._now_s - self._stood[1]
        on_its_way = self._goal is not None and not self._is_near(self._goal)
        return math.isnan(self.position) or on_its_way or stood_s < self._settings.settle_s

    @property
    def settled(self) -> bool:
        """Whether it stands where it was sent."""
        return self._goal is not None and self._is_near(self._goal) and not self.moving

    def home(self) -> None:
        """Read where it is. Raises as :meth:`move_to` does."""
        self._require_power()
        self._read = True

    def move_to(self, position: float) -> None:
        """Go to an angle.

        Raises
        ------
        LimitError
            If it is outside the limits, or no number.
        NotReadyError
            If the axis is not enabled, or was never read.
        """
        self._require_power()
        check_move(self, position)
        self._goal, self._stays = position, False
        self.tell(self._settings.registers.set_position, position)
        takes_s = abs(position - self.position) / self._settings.speed
        self.set_deadline(
            RAMP_MARGIN * takes_s + REST_DEADLINE_S + self._settings.settle_s,
            f"{position:g} rad within {self._settings.tolerance:g} rad",
        )

    def enable(self) -> None:
        """Ask for power; before it has any, it is told to stay where it is read to be."""
        self._stays = self._stays or not self._wants_power
        super().enable()

    def stop(self) -> None:
        """Stay where it is; one that has arrived stays arrived.

        Where it is not known the power is taken off.
        """
        self.cancel_deadline()
        if self._goal is None or self._is_near(self._goal):
            return
        self._wants_power = self._wants_power and math.isfinite(self.position)
        self._lose()
        if self._now_s - self._read_s <= self._settings.lost_s:  # else it is read first
            self._stay()

    def quick_stop(self) -> None:
        """Stay where it is, without power."""
        self.stop()
        self._wants_power = False

    def disable(self) -> None:
        """Take the power off, where it is."""
        self.quick_stop()

    def reconnect(self) -> None:
        """Open a lost port again, and ask anew, without power; raises as :meth:`reset_fault`."""
        self._wants_power = False
        self._lose()
        super().reconnect()

    def reset_fault(self) -> None:
        """Begin anew, without power; raises as :meth:`AskedDevice.reset_fault`."""
        self.stop()
        self._lose()
        super().reset_fault()

    def tick(self, cycle: Cycle) -> None:
        """Take what came; raises as :meth:`AskedDevice.exchange` says."""
        was_led = self._is_led
        fresh, faults = self.exchange(cycle)
        if not self._is_led:
            self._wants_power = self._wants_power and not was_led
            self._lose()
        if fresh:
            self._look()
        if faults and not self._wants_power:
            self.stop()
        raise_worst(faults)

    def _look(self) -> None:
        """Take what was read: where it is, and whether it has arrived."""
        if "position" in self.read_now:
            self._read_s = self._now_s
            self._stay()
        if self._stood is None or not abs(self.position - self._stood[0]) <= self._rest_tolerance:
            self._stood = (self.position, self._now_s)
        if self.settled:
            self.cancel_deadline()
        if not self._wants_power and self._acknowledges(self._address):
            # Without power it may be turned by hand: it must not be told to go back.
            del self._told[self._address]

    def _lose(self) -> None:
        """Forget the set-position; where it is, is told instead, once that is read."""
        if self._goal is not None and not self._is_near(self._goal):
            self._goal = None
        self._stays = self._told.pop(self._address, None) is not None or self._stays

    def _stay(self) -> None:
        """Tell it to stay where it is, where that is still to be told and it is known."""
        if self._stays and self._is_led and math.isfinite(self.position):
            self._stays = False
            self.tell(self._settings.registers.set_position, self.position)

    def _is_told(self) -> bool:
        return not self._stays and super()._is_told()

    @property
    def _address(self) -> int:
        return self._settings.registers.set_position.address

    @property
    def _is_heard(self) -> bool:
        return self._link.is_open and self._link.is_answering

    @property
    def _is_led(self) -> bool:
        """Whether it is heard, and in nobody else's hand."""
        return self._is_heard and self._says("remote") is not False

    @property
    def _rest_tolerance(self) -> float:
        """How far it may wander and is said to stand."""
        return 0.5 * self._settings.tolerance

    def _is_near(self, goal: float) -> bool:
        return abs(self.position - goal) <= self._settings.tolerance

    def _require_power(self) -> None:
        if not self.enabled:
            raise NotReadyError(
                self.name, "is not enabled; enable it, and look whether it is in remote and ready"
            )


DRIVER = Driver(Role.POSITION_AXIS, ModbusAxisSettings, ModbusAxis)
