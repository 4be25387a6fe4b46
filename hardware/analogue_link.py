"""Numbers behind voltages: an analogue module on the CAN bus (CiA 401), one value each cycle."""

import struct
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Final

from hardware.asked_link import (
    READ,
    WRITE,
    Answer,
    AskedLink,
    AskedSettings,
    Following,
    RegisterRequest,
)
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.dictionary import Entry, entry, has
from hardware.driver import NodePlan, Services, join
from hardware.errors import HardwareError
from hardware.line_registers import Addressed
from hardware.modbus_registers import Table
from hardware.node import Node
from hardware.roles import Cycle

_ERROR_MODE, _ERROR_VALUE = 0x6443, 0x6444  # what an output does without a controller
_MOST: Final = 32767  # counts either way, of a 16-bit converter


@dataclass(frozen=True, kw_only=True)
class AnalogueNumber(Addressed):
    """A number that a voltage stands for: ``per_volt * (voltage - offset_v)``.

    Attributes
    ----------
    object
        Of the module: ``"6411:1"`` is its first output, ``"6401:1"`` its first input.
    volt_per_count
        Of the converter: 10 V over 32767 counts for most.
    per_volt
        In SI units (m/s per volt), negative where the other way.
    offset_v
        Voltage at which the number is 0.
    """

    object: str
    per_volt: float
    offset_v: float = 0.0
    volt_per_count: float = 10.0 / _MOST

    table: ClassVar[Table] = "holding"
    count: ClassVar[int] = 1

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        entry(self.object)
        for key in ("per_volt", "volt_per_count"):
            if getattr(self, key) == 0.0:
                raise ConfigurationError(f"{key} = 0; nothing could be told from the voltage")

    def value(self, words: Sequence[int]) -> float:
        """Return the number in SI units that words of the converter stand for."""
        return self.per_volt * (signed(words) * self.volt_per_count - self.offset_v)

    def written(self, value: float) -> tuple[int, ...]:
        """Return the counts for a number in SI units, in a word.

        Raises
        ------
        ConfigurationError
            If the converter has no such voltage.
        """
        volt = value / self.per_volt + self.offset_v
        counts = round(volt / self.volt_per_count)
        if abs(counts) > _MOST:
            raise ConfigurationError(
                f"{self.object}: {value:g} is {volt:.4g} V, beyond "
                f"{_MOST * self.volt_per_count:.4g} V; correct per_volt, offset_v or volt_per_count"
            )
        return struct.unpack(">H", struct.pack(">h", counts))


@dataclass(frozen=True, kw_only=True)
class AnalogueSettings(AskedSettings):
    """How an analogue module is reached.

    Attributes
    ----------
    settings
        Objects to write before operation, after those that let each output go to the voltage of
        0 when the controller is lost (6443, 6444).
    """

    node: int
    eds: str = "cia401-analogue.eds"
    settings: dict[str, int | float] = field(default_factory=dict)

    @property
    @abstractmethod
    def outputs(self) -> tuple[AnalogueNumber, ...]:
        """The numbers that the program sets as voltages."""

    @property
    @abstractmethod
    def inputs(self) -> tuple[AnalogueNumber, ...]:
        """The numbers that the program reads as voltages."""

    def link(self, name: str, services: Services) -> "AnalogueLink":
        """Return what reads and sets its voltages; raises as :func:`hardware.driver.join`."""
        return AnalogueLink(name, self, join(nodes(name, self)[0], services))


class AnalogueLink(AskedLink):
    """Registers that are voltages: all are read in each cycle in which the module answers."""

    def __init__(self, name: str, settings: AnalogueSettings, node: Node) -> None:
        super().__init__(name, settings)
        self._node = node
        self._inputs = settings.inputs
        self._outputs = {output.address: entry(output.object) for output in settings.outputs}
        lost: dict[Entry, int | float] = {}
        for output in settings.outputs:
            number, counts = entry(output.object).subindex, signed(output.written(0.0))
            lost |= {Entry(_ERROR_MODE, number): 1, Entry(_ERROR_VALUE, number): counts}
            node.put(entry(output.object), counts)  # 0 V is not rest where there is an offset
        present = {at: value for at, value in lost.items() if has(node.dictionary, at)}
        self._objects = present | {entry(at): value for at, value in settings.settings.items()}

    def prepare(self) -> None:
        """Write the module's settings: what its outputs do when the controller is lost."""
        for at, value in self._objects.items():
            self._node.sdo.write(at, value)

    def _poll(self, cycle: Cycle, following: Following) -> tuple[list[Answer], list[HardwareError]]:
        answers: list[Answer] = []
        if any(stream.last == cycle.number for stream in self._node.streams):
            for channel in self._inputs:
                word = int(self._node.values[entry(channel.object)]) & 0xFFFF
                answers.append((RegisterRequest(READ[channel.table], channel.address, 1), (word,)))
        request = following()
        if request is not None and request.function == WRITE:
            self._node.put(self._outputs[request.address], signed(request.words))
            answers += [(request, request.words)] if answers else []
        return answers, []


def signed(words: Sequence[int]) -> int:
    """Return the counts of a converter that stand in a word."""
    (counts,) = struct.unpack(">h", struct.pack(">H", *words))
    return int(counts)


def nodes(name: str, settings: AnalogueSettings) -> tuple[NodePlan, ...]:
    """Return what the module wants of the bus."""
    read, written = (
        (tuple(entry(channel.object) for channel in channels),)
        for channels in (settings.inputs, settings.outputs)
    )
    return (NodePlan(name, settings.node, settings.eds, read, written),)
