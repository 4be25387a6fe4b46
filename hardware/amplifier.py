"""Force channels on a CiA 404-style amplifier: which objects, types and scales is configuration."""

import math
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, default_mapping, entry, load
from hardware.driver import Driver, NodePlan, Services, join
from hardware.errors import (
    BridgeSaturatedError,
    HardwareError,
    NotReadyError,
    SensorInvalidError,
    StuckSensorError,
)
from hardware.roles import Cycle, Role, Sample, SampleBlock, blocks

# Bits of the analogue input's status (6150); an overload comes with or without "not valid".
_INVALID, _OVERLOADS = 0x01, 0x06
_PATIENCE_CYCLES = 2
_TARE_S = 1.0  # tare takes the mean of the samples since then


@dataclass(frozen=True)
class AmplifierChannel:
    """One channel of an amplifier.

    Attributes
    ----------
    object
        Where its value is, for example ``"9130:1"``; it has to be in a TPDO.
    scale, offset
        Value in ``unit`` = raw value times ``scale`` plus ``offset``; a negative scale turns the
        sign of a gauge that is mounted the other way.
    full_scale
        Largest magnitude before tare, in ``unit``; at or above it the bridge is saturated.
    status
        Where its status byte (6150) is, if it has one.
    """

    name: str
    object: str
    scale: float
    full_scale: float
    offset: float = 0.0
    unit: str = "N"
    status: str | None = None


@dataclass(frozen=True)
class AmplifierSettings:
    """Settings of an amplifier.

    Attributes
    ----------
    tpdos
        Objects of each TPDO; the EDS's own mapping where none is given.
    settings
        Objects to write before operation, for example sensor type or filter: ``"6110:1" = 70``.
    stuck_s
        A channel that repeats one raw value for so long is stuck; 0 does not look.
    """

    node: int
    channels: tuple[AmplifierChannel, ...]
    eds: str = "cia404-amplifier.eds"
    tpdos: tuple[tuple[str, ...], ...] = ()
    settings: dict[str, int | float] = field(default_factory=dict)
    stuck_s: float = 0.0


class Amplifier:
    """A CANopen amplifier of strain gauges, as :class:`hardware.roles.ForceChannels`."""

    def __init__(self, name: str, settings: AmplifierSettings, services: Services) -> None:
        self.name = name
        self.sample_rate_hz = services.sample_rate_hz
        self.channels = tuple(
            Channel(channel.name, channel.unit, channel.full_scale) for channel in settings.channels
        )
        self._settings = settings
        self._node = join(nodes(name, settings)[0], services)
        self._channels = settings.channels
        self._values = tuple(entry(channel.object) for channel in settings.channels)
        self._status = tuple(
            entry(channel.status) if channel.status else None for channel in settings.channels
        )
        self._value_streams = tuple(
            stream for stream in self._node.streams if set(stream.layout.entries) & {*self._values}
        )
        self._partial: dict[int, dict[Entry, int | float]] = {}
        self._zero = [0.0] * len(self.channels)
        self._recent: deque[tuple[float, ...]] = deque(
            maxlen=max(1, round(_TARE_S * self.sample_rate_hz))
        )
        self._untaken: list[Sample] = []
        self._told: set[tuple[str, str]] = set()
        self._repeats = [0] * len(self.channels)
        self._raw: list[int | float] = [math.nan] * len(self.channels)

    def prepare(self) -> None:
        """Write the settings of the configuration to the amplifier."""
        for text, value in self._settings.settings.items():
            self._node.sdo.write(entry(text), value)

    def tick(self, cycle: Cycle) -> None:
        """Take the cycle's values.

        Raises
        ------
        BridgeSaturatedError, SensorInvalidError, StuckSensorError
            Once, until the channel is in order again.
        """
        samples = self._samples(cycle.number)
        if not samples:
            return
        faults = [self._look(i) for i in range(len(self._channels))]
        valid = [self._is_valid(i) for i in range(len(self._channels))]
        for number, raw in samples:
            values = self._scaled(raw, valid)
            self._recent.append(values)
            tared = tuple(v - z for v, z in zip(values, self._zero, strict=True))
            self._untaken.append((number, tared))
        self._tell([fault for fault in faults if fault is not None])

    def tare(self) -> None:
        """Take the mean of the last second for zero.

        Raises
        ------
        NotReadyError
            If no sample has come yet, or one of them was not valid.
        """
        if not self._recent:
            raise NotReadyError(self.name, "no samples yet; let the loop run before the tare")
        mean = np.mean(np.array(self._recent), axis=0)
        if not np.all(np.isfinite(mean)):
            raise NotReadyError(
                self.name, "cannot tare: a channel was not valid in the last second"
            )
        self._zero = [float(value) for value in mean]

    def carried(self) -> dict[str, Any]:
        """Return the tare; see :mod:`hardware.carry_over`."""
        return {"zero": self._zero}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Go on with that tare."""
        self._zero = list(carried["zero"])

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call; shape of each: ``(channels, samples)``."""
        taken, self._untaken = self._untaken, []
        return blocks(taken)

    def reset_fault(self) -> None:
        """Let findings that persist be told again."""
        self._told.clear()

    def close(self) -> None:
        """Nothing to let go of: the bus is the master's."""

    def _samples(self, newest: int) -> list[tuple[int, tuple[int | float, ...]]]:
        """Return the raw values over the channels of the samples that are complete now.

        Where the channels come in several TPDOs, one of them may be a cycle late: a sample waits
        for it that long, and what has not come by then is NaN.
        """
        for stream in self._value_streams:
            for number, values in stream.samples:
                self._partial.setdefault(number, {}).update(
                    zip(stream.layout.entries, values, strict=True)
                )
        ready = []
        for number in sorted(self._partial):
            is_whole = all(at in self._partial[number] for at in self._values)
            if not is_whole and number > newest - _PATIENCE_CYCLES:
                break
            sample = self._partial.pop(number)
            ready.append((number, tuple(sample.get(at, math.nan) for at in self._values)))
        return ready

    def _scaled(self, raw: tuple[int | float, ...], valid: list[bool]) -> tuple[float, ...]:
        return tuple(
            value * channel.scale + channel.offset if good and math.isfinite(value) else math.nan
            for value, channel, good in zip(raw, self._channels, valid, strict=True)
        )

    def _is_valid(self, i: int) -> bool:
        return not self._state(i) & _INVALID

    def _state(self, i: int) -> int:
        at = self._status[i]
        return int(self._node.values[at]) if at is not None else 0

    def _look(self, i: int) -> HardwareError | None:
        """Return what is wrong with a channel now."""
        channel, raw = self._channels[i], self._node.values[self._values[i]]
        status = self._state(i)
        value = raw * channel.scale + channel.offset
        if status & _OVERLOADS or abs(value) >= channel.full_scale:
            return BridgeSaturatedError(
                self.name,
                f"{channel.name} = {value:g} {channel.unit} (status 0x{status:02X}); "
                f"full scale {channel.full_scale:g} {channel.unit}; reduce amplitude or frequency",
            )
        if status & _INVALID or not math.isfinite(value):
            return SensorInvalidError(
                self.name, f"{channel.name} is not valid (status 0x{status:02X}); check the gauge"
            )
        return self._stuck_fault(i, raw)

    def _stuck_fault(self, i: int, raw: int | float) -> HardwareError | None:
        self._repeats[i] = self._repeats[i] + 1 if raw == self._raw[i] else 0
        self._raw[i] = raw
        limit = self._settings.stuck_s * self.sample_rate_hz
        if not limit or self._repeats[i] < limit:
            return None
        return StuckSensorError(
            self.name,
            f"{self._channels[i].name} repeats the raw value {raw} for {self._repeats[i]} samples "
            f"(limit {limit:.0f})",
        )

    def _tell(self, faults: list[HardwareError]) -> None:
        """Raise the first finding that was not told; forget those that are over."""
        keys = {(type(fault).__name__, str(fault).split(" ")[1]): fault for fault in faults}
        self._told &= set(keys)
        for key, fault in keys.items():
            if key not in self._told:
                self._told.add(key)
                raise fault


def nodes(name: str, settings: AmplifierSettings) -> tuple[NodePlan, ...]:
    """Return what the amplifier wants of the bus.

    Raises
    ------
    ConfigurationError
        If a channel's object is in no TPDO, or the EDS is unknown.
    """
    tpdos = tuple(tuple(entry(text) for text in tpdo) for tpdo in settings.tpdos)
    if not tpdos:
        dictionary = load(settings.eds, settings.node, name)
        tpdos = tuple(tpdo for tpdo in default_mapping(dictionary, 0x1A00) if tpdo)
    mapped = {at for tpdo in tpdos for at in tpdo}
    for channel in settings.channels:
        for text in (channel.object, *((channel.status,) if channel.status else ())):
            if entry(text) not in mapped:
                raise ConfigurationError(
                    f"{name}: channel {channel.name}: object {entry(text)} is in no TPDO; "
                    f"mapped are {', '.join(map(str, sorted(mapped)))}"
                )
    return (NodePlan(name, settings.node, settings.eds, tpdos),)


DRIVER = Driver(Role.FORCES, AmplifierSettings, Amplifier, nodes)
