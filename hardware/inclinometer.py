"""The inclinometer of the swing, on a serial line."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.driver import Driver, Services
from hardware.errors import SensorInvalidError
from hardware.lines import SEQUENCE_MODULUS, LineKind, SerialLine, Unwrapped
from hardware.roles import Cycle, Role, Sample, SampleBlock, blocks
from hardware.serial_instrument import SerialInstrument
from hardware.serial_port import PortSettings


@dataclass(frozen=True)
class InclinometerSettings:
    """Settings of a serial inclinometer.

    Attributes
    ----------
    rad_per_unit
        Radians for one unit of the line's value; pi/180 for degrees, negative to turn the sign.
    range_rad
        Largest angle that it measures, either way.
    """

    port: PortSettings
    sample_rate_hz: float = 256.0
    rad_per_unit: float = math.pi / 180.0
    range_rad: float = math.radians(3.0)
    silent_s: float = 1.0

    def __post_init__(self) -> None:
        if not self.sample_rate_hz > 0.0:
            raise ConfigurationError(f"sample_rate_hz = {self.sample_rate_hz:g} is not above 0")


class SerialInclinometer(SerialInstrument):
    """A :class:`hardware.roles.Inclinometer`; its samples are numbered by its lines."""

    def __init__(self, name: str, settings: InclinometerSettings, services: Services) -> None:
        super().__init__(name, settings, services, (LineKind.ANGLE,))
        self.channels: tuple[Channel, ...] = (Channel(name, "rad", settings.range_rad),)
        self.sample_rate_hz = settings.sample_rate_hz
        self._settings = settings
        self._sequence = Unwrapped(SEQUENCE_MODULUS)
        self._samples: list[Sample] = []

    def tick(self, cycle: Cycle) -> None:
        """Take the lines of the cycle.

        Raises
        ------
        SensorInvalidError
            If an angle is at or beyond the range; once, until it is back.
        UnpluggedError, SilentPortError, LineError
            As the line shows.
        """
        self._read(cycle)

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call: one channel, in radians."""
        taken, self._samples = self._samples, []
        return blocks(taken)

    def carried(self) -> dict[str, Any]:
        """Return the count of lines; see :mod:`hardware.carry_over`."""
        return {"sequence": self._sequence.value}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Count on from there."""
        self._sequence.value = carried["sequence"]

    def _take(self, line: SerialLine, cycle: Cycle) -> None:
        angle = line.value * self._settings.rad_per_unit
        self._samples.append((self._sequence.take(line.sequence), (angle,)))
        inside = abs(angle) < self._settings.range_rad
        if inside:
            self._told.discard(SensorInvalidError)
        elif SensorInvalidError not in self._told:
            self._told.add(SensorInvalidError)
            raise SensorInvalidError(
                self.name,
                f"{angle:g} rad is at or beyond its range of {self._settings.range_rad:g} rad",
            )


DRIVER = Driver(Role.INCLINOMETER, InclinometerSettings, SerialInclinometer)
