"""An instrument that talks by itself on a serial line: its port, its lines, and its silence."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from typing import Protocol

from hardware.driver import Services
from hardware.errors import HardwareError, LineError, SilentPortError, worst
from hardware.lines import Decoder, LineKind, SerialLine
from hardware.roles import Cycle
from hardware.serial_port import PortSettings


class InstrumentSettings(Protocol):
    """What the settings of every such instrument have.

    Attributes
    ----------
    silent_s
        After so long without a line it is silent.
    """

    @property
    def port(self) -> PortSettings:
        """The serial port and its settings."""
        ...

    @property
    def silent_s(self) -> float:
        """Time in seconds."""
        ...


class SerialInstrument(ABC):
    """What the inclinometer and the photocell of a microcontroller share.

    Parameters
    ----------
    kinds
        Of the lines that it sends.
    """

    def __init__(
        self,
        name: str,
        settings: InstrumentSettings,
        services: Services,
        kinds: tuple[LineKind, ...],
    ) -> None:
        self.name = name
        self._silent_s, self._kinds = settings.silent_s, kinds
        self._port = services.port(name, settings.port)
        self._decoder = Decoder(name)
        self._heard_s: float | None = None
        self._told: set[type] = set()

    def prepare(self) -> None:  # noqa: B027
        """Nothing to write: the device talks by itself."""

    @property
    def is_answering(self) -> bool:
        """Whether its port is open: it talks by itself."""
        return self._port.is_open

    def reconnect(self) -> None:
        """Open a lost port again; raises as :meth:`reset_fault`."""
        self._port.open()

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

    def _read(self, cycle: Cycle) -> None:
        """Take the lines of the cycle; raise the worst of what they and their absence show."""
        faults: list[HardwareError] = []
        for raw in self._port.lines():
            try:
                line = self._decoder.decode(raw)
                if line.kind not in self._kinds:
                    raise LineError(self.name, f"a line of kind {line.kind}; swap the ports")
                self._heard_s = cycle.time_s
                self._take(line, cycle)
            except HardwareError as error:
                faults.append(error)
        faults += [*self._silence(cycle.time_s), *self._missing_faults(cycle.time_s)]
        if faults:
            raise worst(faults)

    @abstractmethod
    def _take(self, line: SerialLine, cycle: Cycle) -> None:
        """Take one line; raise what it shows."""

    def _missing_faults(self, now_s: float) -> Iterator[HardwareError]:
        """Yield what else is missing by now."""
        yield from ()

    def _silence(self, now_s: float) -> Iterator[HardwareError]:
        if self._heard_s is None:
            self._heard_s = now_s
        silent_s = now_s - self._heard_s
        if silent_s <= self._silent_s:
            self._told.discard(SilentPortError)
        elif SilentPortError not in self._told:
            self._told.add(SilentPortError)
            limit = f"limit {self._silent_s:g} s"
            yield SilentPortError(self.name, f"no line for {silent_s:.2f} s ({limit})")
