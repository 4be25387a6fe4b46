"""A two-channel force amplifier that says its samples as text on a serial line."""

from collections import deque
from dataclasses import dataclass

import numpy as np

from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.driver import Driver, Services
from hardware.errors import BridgeSaturatedError, LineError, NotReadyError
from hardware.roles import Cycle, Role, Sample, SampleBlock, blocks
from hardware.serial_port import PortSettings, SerialPort


@dataclass(frozen=True)
class Settings:
    """The keys of the amplifier's table in ``rig.toml``."""

    names: tuple[str, str]
    full_scale_n: float
    port: PortSettings
    sample_rate_hz: float = 100.0

    def __post_init__(self) -> None:
        if not self.full_scale_n > 0.0:
            raise ConfigurationError(f"full_scale_n = {self.full_scale_n:g} is not above 0")


class TextAmplifier:
    """A :class:`hardware.roles.ForceChannels`; its samples carry their own numbers."""

    def __init__(self, name: str, settings: Settings, services: Services) -> None:
        self.name = name
        self.sample_rate_hz = settings.sample_rate_hz
        self.channels = tuple(Channel(one, "N", settings.full_scale_n) for one in settings.names)
        self._port = SerialPort(name, settings.port)
        self._samples: list[Sample] = []
        self._recent: deque[tuple[float, ...]] = deque(maxlen=round(settings.sample_rate_hz))
        self._zero = np.zeros(len(self.channels))
        self._overloaded = False

    def prepare(self) -> None:
        """Start the samples."""
        self._port.write(b"R%d\n" % round(self.sample_rate_hz))

    def tick(self, cycle: Cycle) -> None:
        """Take the lines of the cycle; say an overload once."""
        overloaded = self._overloaded
        for raw in self._port.lines():
            self._take(raw)
        if self._overloaded and not overloaded:
            full_scale = self.channels[0].full_scale
            raise BridgeSaturatedError(self.name, f"overload; full scale {full_scale:g} N")

    def tare(self) -> None:
        """Take the mean of the last second for zero."""
        if not self._recent:
            raise NotReadyError(self.name, "no samples yet; let the loop run before the tare")
        self._zero = np.mean(np.array(self._recent), axis=0)

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call."""
        taken, self._samples = self._samples, []
        return blocks(taken)

    def reset_fault(self) -> None:
        """Open a lost port again and start the samples anew."""
        self._port.open()
        self._overloaded = False
        self.prepare()

    def close(self) -> None:
        """Stop the samples and close the port."""
        if self._port.is_open:
            self._port.write(b"S\n")
        self._port.close()

    def _take(self, raw: bytes) -> None:
        try:
            kind, number, *values = raw.decode("ascii").split()
            first = int(number)
            forces = [np.inf if one == "OVL" else float(one) for one in values]
        except ValueError as error:
            raise LineError(self.name, f"{raw!r} is no line: {error}") from error
        if kind != "F" or len(forces) != len(self.channels):
            raise LineError(self.name, f"{raw!r} has not {len(self.channels)} forces")
        self._overloaded = np.inf in forces
        if not self._overloaded:
            self._recent.append(tuple(forces))
        full_scale = self.channels[0].full_scale or np.inf
        tared = np.clip(forces, -full_scale, full_scale) - self._zero
        self._samples.append((first, tuple(tared)))


DRIVER = Driver(Role.FORCES, Settings, TextAmplifier)
