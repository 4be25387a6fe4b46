"""Speed and loads, watched in every cycle: whatever the drivers, and whatever state a run is in."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, cast

import numpy as np

from hardware.errors import HardwareError, OverloadError, OverspeedError
from hardware.limits import OVERSPEED, OVERSPEED_S
from hardware.roles import ForceChannels, SampleBlock, Shaft


@dataclass(frozen=True)
class WatchLimits:
    """What must not be exceeded.

    Attributes
    ----------
    frequency_hz
        The oscillator's highest; the shaft's own limit holds beside it.
    loads
        Largest magnitude of channels by name, in their units; those without a name have none.
    """

    frequency_hz: float = math.inf
    loads: Mapping[str, float] = field(default_factory=lambda: MappingProxyType({}))


class _WatchedForces:
    """Hands everything on to an amplifier; sees its samples before whoever takes them."""

    def __init__(self, inner: ForceChannels) -> None:
        self._inner = inner
        self._taken: list[SampleBlock] = []

    def __getattr__(self, name: str) -> Any:
        return getattr(self._inner, name)

    def look(self, loads: Sequence[float]) -> OverloadError | None:
        """Look at what has come; return the first channel beyond its load."""
        new = self._inner.take()
        self._taken += new
        for block in new:
            for row, (values, load) in enumerate(zip(block.values.tolist(), loads, strict=True)):
                for value in values:
                    if abs(value) > load:
                        return self._beyond(row, value, load)
        return None

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call, oldest first."""
        self._taken += self._inner.take()
        taken, self._taken = self._taken, []
        return _merged(taken)

    def _beyond(self, row: int, value: float, limit: float) -> OverloadError:
        channel = self._inner.channels[row]
        return OverloadError(
            channel.name,
            f"{value:g} {channel.unit} is beyond its safe load, {limit:g} {channel.unit}; reduce "
            "amplitude or frequency, and look at the gauge before the next run",
        )


class Watch:
    """Compares what a rig's shaft and gauges show with the limits.

    Attributes
    ----------
    forces
        The amplifiers, to be used in place of those given.
    """

    def __init__(self, shaft: Shaft | None, forces: Sequence[ForceChannels]) -> None:
        self._shaft = shaft
        self._watched = tuple(_WatchedForces(force) for force in forces)
        self.forces = cast("tuple[ForceChannels, ...]", self._watched)
        self._cycles_beyond = 0
        self.limit(WatchLimits())

    def limit(self, limits: WatchLimits) -> None:
        """Set the limits of shaft speed (Hz) and loads (in each channel's unit)."""
        shaft_hz = self._shaft.frequency_hz.high if self._shaft is not None else math.inf
        self._highest_hz = OVERSPEED * min(shaft_hz, limits.frequency_hz)
        self._loads = [
            [limits.loads.get(channel.name, math.inf) for channel in force.channels]
            for force in self.forces
        ]

    def look(self) -> Iterator[HardwareError]:
        """Yield what is beyond its limit in this cycle."""
        if self._shaft is not None:
            measured_hz = self._shaft.measured_frequency_hz
            is_beyond = abs(measured_hz) > self._highest_hz
            self._cycles_beyond = self._cycles_beyond + 1 if is_beyond else 0
            if self._cycles_beyond >= max(1, round(OVERSPEED_S * self._shaft.sample_rate_hz)):
                yield OverspeedError(
                    self._shaft.name,
                    f"turns at {measured_hz:g} Hz (limit {self._highest_hz:g} Hz either way)",
                )
        for force, loads in zip(self._watched, self._loads, strict=True):
            error = force.look(loads)
            if error is not None:
                yield error


def _merged(taken: Sequence[SampleBlock]) -> tuple[SampleBlock, ...]:
    """Put blocks that follow each other without a gap into one."""
    stretches: list[list[SampleBlock]] = []
    end = None
    for block in taken:
        if block.first != end:
            stretches.append([])
        stretches[-1].append(block)
        end = block.first + block.values.shape[1]
    return tuple(
        SampleBlock(parts[0].first, np.concatenate([part.values for part in parts], axis=1))
        for parts in stretches
    )
