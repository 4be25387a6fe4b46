"""The keys of a carriage behind a programmable controller, or behind a panel that says lines."""

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar, Final

from hardware.analogue_link import AnalogueNumber, AnalogueSettings
from hardware.asked_link import AskedSettings
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.limits import check_above_0
from hardware.line_link import LineSettings, is_told
from hardware.line_registers import Line, LineCommand, LineNumber, LineStatus
from hardware.modbus_link import ModbusSettings
from hardware.modbus_registers import CommandRegister, Register, StatusRegister

_LONGEST_LAG_S: Final = 2.0
"""Twice a slow drive's. Half refuses some of them; twice lets milliseconds pass for seconds."""


@dataclass(frozen=True)
class CarriageRegisters:
    """Which registers are the carriage's; those it lacks are left out.

    Attributes
    ----------
    set_speed, speed, position
        Speed asked for, speed measured, place along the track. Positive along the track.
    set_turn_rate, turn_rate
        Of a carriage or an arm that drives circles: rate of turn asked for and measured, positive
        to starboard.
    life
        A number that the controller's program changes all the time; what stands is old.
    """

    set_speed: Register
    speed: Register
    position: Register | None = None
    status: StatusRegister | None = None
    command: CommandRegister | None = None
    life: Register | None = None
    set_turn_rate: Register | None = None
    turn_rate: Register | None = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def read(self) -> dict[str, Register]:
        """Return those that are read, by name."""
        registers = {
            "speed": self.speed,
            "position": self.position,
            "life": self.life,
            "turn_rate": self.turn_rate,
        }
        return {name: register for name, register in registers.items() if register is not None}


@dataclass(frozen=True, kw_only=True)
class AskedCarriageSettings(AskedSettings):
    """Settings of a carriage, however it is asked.

    Attributes
    ----------
    acceleration_m_s2
        Of its own ramps up and down.
    tolerance_m_s
        So near the speed asked for it has to be.
    settle_s
        For so long, before a run goes on.
    track_m
        Start and end of the way that may be used, as the position reads there.
    return_speed_m_s
        At which it goes back.
    highest_turn_rate_rad_s
        Of one that drives circles; 0 for one that goes straight.
    lag_s
        So late it follows a speed that changes: one that is led is told so much earlier.
    """

    highest_speed_m_s: float
    acceleration_m_s2: float
    tolerance_m_s: float
    settle_s: float = 2.0
    track_m: tuple[float, float] | None = None
    return_speed_m_s: float = 0.5
    highest_turn_rate_rad_s: float = 0.0
    lag_s: float = 0.0

    @property
    @abstractmethod
    def signals(self) -> "CarriageRegisters | CarriageLines | CarriageVoltages":
        """What it is asked and told."""

    def __post_init__(self) -> None:
        super().__post_init__()
        check_above_0(
            self,
            "highest_speed_m_s",
            "acceleration_m_s2",
            "tolerance_m_s",
            "settle_s",
            "return_speed_m_s",
        )
        if not 0.0 <= self.lag_s <= _LONGEST_LAG_S:
            raise ConfigurationError(
                f"lag_s = {self.lag_s:g} has to be from 0 to {_LONGEST_LAG_S:g}, in seconds"
            )
        if self.return_speed_m_s > self.highest_speed_m_s:
            raise ConfigurationError("return_speed_m_s is above highest_speed_m_s; lower it")
        if (self.track_m is None) != (self.signals.position is None):
            raise ConfigurationError("track_m and position belong together; give both")
        if self.track_m is not None and not self.track_m[0] < self.track_m[1]:
            raise ConfigurationError(
                f"track_m = {list(self.track_m)}: the start has to be below the end; a negative "
                "scale of registers.position turns it round"
            )
        self._check_turning()
        slowest = -self.return_speed_m_s if self.track_m is not None else 0.0
        for speed in (self.highest_speed_m_s, slowest):
            self.signals.set_speed.written(speed)

    def _check_turning(self) -> None:
        set_register, read, most = (
            self.signals.set_turn_rate,
            self.signals.turn_rate,
            self.highest_turn_rate_rad_s,
        )
        if most < 0.0 or len({set_register is None, read is None, most == 0.0}) > 1:
            raise ConfigurationError(
                "highest_turn_rate_rad_s (above 0), registers.set_turn_rate and "
                "registers.turn_rate belong together; give all three, or none"
            )
        if set_register is not None and self.track_m is not None:
            raise ConfigurationError(
                "track_m is of a straight way; leave it and registers.position out of a carriage "
                "that drives circles"
            )
        for rate in (-most, most):
            if set_register is not None:
                set_register.written(rate)


@dataclass(frozen=True, kw_only=True)
class ModbusCarriageSettings(AskedCarriageSettings, ModbusSettings):
    """Settings of a carriage behind a programmable controller."""

    registers: CarriageRegisters

    @property
    def signals(self) -> CarriageRegisters:
        """Its registers."""
        return self.registers


@dataclass(frozen=True, kw_only=True)
class CarriageLines:
    """Which lines are the carriage's; those it lacks are left out.

    Attributes
    ----------
    set_speed, speed, position
        As the registers of :class:`CarriageRegisters`.
    """

    set_speed: LineNumber
    speed: LineNumber
    position: LineNumber | None = None
    status: LineStatus | None = None
    command: LineCommand | None = None

    set_turn_rate: ClassVar[None] = None
    turn_rate: ClassVar[None] = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        for name, query in (("speed", self.speed), ("position", self.position)):
            if query is not None and is_told(query):
                raise ConfigurationError(f"{name} is read: {{value}} stands in its answer")
        if not is_told(self.set_speed):
            raise ConfigurationError("set_speed is set: {value} stands in its line")
        lines = (self.set_speed, self.speed, self.position, self.status, self.command)
        for number, line in enumerate(lines, 1):
            if line is not None:
                line.at(number)

    def read(self) -> dict[str, LineNumber]:
        """Return those that are read, by name."""
        lines = {"speed": self.speed, "position": self.position}
        return {name: line for name, line in lines.items() if line is not None}


@dataclass(frozen=True, kw_only=True)
class LineCarriageSettings(AskedCarriageSettings, LineSettings):
    """Settings of a carriage behind a drive panel that answers lines of text."""

    lines: CarriageLines

    @property
    def signals(self) -> CarriageLines:
        """Its lines."""
        return self.lines

    @property
    def every_line(self) -> tuple[Line, ...]:
        """All that it is asked and told."""
        lines = self.lines
        candidates = (lines.set_speed, lines.speed, lines.position, lines.status, lines.command)
        return tuple(each for each in candidates if each is not None)


@dataclass(frozen=True, kw_only=True)
class CarriageVoltages:
    """Which voltages are the carriage's: speed asked for and measured, in m/s."""

    set_speed: AnalogueNumber
    speed: AnalogueNumber

    position: ClassVar[None] = None
    status: ClassVar[None] = None
    command: ClassVar[None] = None
    set_turn_rate: ClassVar[None] = None
    turn_rate: ClassVar[None] = None

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        for number, voltage in enumerate((self.set_speed, self.speed), 1):
            voltage.at(number)

    def read(self) -> dict[str, AnalogueNumber]:
        """Return those that are read, by name."""
        return {"speed": self.speed}


@dataclass(frozen=True, kw_only=True)
class AnalogueCarriageSettings(AskedCarriageSettings, AnalogueSettings):
    """Settings of a carriage behind voltages: without power it is told 0 m/s, and nothing more."""

    voltages: CarriageVoltages

    @property
    def signals(self) -> CarriageVoltages:
        """Its voltages."""
        return self.voltages

    @property
    def outputs(self) -> tuple[AnalogueNumber, ...]:
        """What is set."""
        return (self.voltages.set_speed,)

    @property
    def inputs(self) -> tuple[AnalogueNumber, ...]:
        """What is read."""
        return (self.voltages.speed,)
