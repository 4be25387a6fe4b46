"""The inclinometer of the swing, on a serial line."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.driver import Driver, Services
from hardware.errors import (
    HardwareError,
    LineError,
    SensorInvalidError,
    SilentPortError,
    worst,
)
from hardware.lines import SEQUENCE_MODULUS, Decoder, LineKind, SerialLine, Unwrapped
from hardware.roles import Cycle, Role, Sample, SampleBlock, blocks
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


class SerialInclinometer:
    """A :class:`hardware.roles.Inclinometer`; its samples are numbered by its lines."""

    def __init__(self, name: str, settings: InclinometerSettings, services: Services) -> None:
        self.name = name
        self.channels: tuple[Channel, ...] = (Channel(name, "rad", settings.range_rad),)
        self.sample_rate_hz = settings.sample_rate_hz
        self._settings = settings
        self._port = services.port(name, settings.port)
        self._decoder = Decoder(name)
        self._sequence = Unwrapped(SEQUENCE_MODULUS)
        self._samples: list[Sample] = []
        self._heard_s: float | None = None
        self._told: set[type] = set()

    def prepare(self) -> None:
        """Nothing to write: the device talks by itself."""

    def tick(self, cycle: Cycle) -> None:
        """Take the lines of the cycle.

        Raises
        ------
        SensorInvalidError
            If an angle is at or beyond the range; once, until it is back.
        UnpluggedError, SilentPortError, LineError
            As the line shows.
        """
        faults: list[HardwareError] = []
        for raw in self._port.lines():
            try:
                self._take(self._decoder.decode(raw))
                self._heard_s = cycle.time_s
            except HardwareError as error:
                faults.append(error)
        self._listen(cycle.time_s, faults)
        if faults:
            raise worst(faults)

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

    def reset_fault(self) -> None:
        """Open a lost port again and begin anew.

        Raises
        ------
        PortOpenError
            If the port is still not there.
        """
        self._port.open()
        self._heard_s = None
        self._told.clear()

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _take(self, line: SerialLine) -> None:
        if line.kind is not LineKind.ANGLE:
            raise LineError(self.name, f"a line of kind {line.kind} is no angle; swap the ports")
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

    def _listen(self, now_s: float, faults: list[HardwareError]) -> None:
        if self._heard_s is None:
            self._heard_s = now_s
        silent_s = now_s - self._heard_s
        if silent_s <= self._settings.silent_s:
            self._told.discard(SilentPortError)
        elif SilentPortError not in self._told:
            self._told.add(SilentPortError)
            limit = f"{self._settings.silent_s:g} s"
            faults.append(
                SilentPortError(self.name, f"no line for {silent_s:.2f} s (limit {limit})")
            )


DRIVER = Driver(Role.INCLINOMETER, InclinometerSettings, SerialInclinometer)
