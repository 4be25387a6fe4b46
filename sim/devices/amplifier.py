"""A simulated CiA 404 amplifier: the chain's channels as raw values of the mapped objects."""

import math
from collections.abc import Callable
from typing import Final

from canopen.objectdictionary import datatypes

from hardware.amplifier import AmplifierChannel, AmplifierSettings
from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, entry, variable
from sim.devices.network import Wire
from sim.devices.node import Number, SimulatedNode

Source = Callable[[], float]
_INVALID, _ABOVE, _BELOW = 0x01, 0x02, 0x04
_FULL: Final = {datatypes.INTEGER16: 2**15 - 1, datatypes.INTEGER32: 2**31 - 1}


class _Line:
    """One channel: where its value comes from and which objects show it."""

    def __init__(self, channel: AmplifierChannel, source: Source, full: int | None) -> None:
        self.source = source
        self.at = entry(channel.object)
        self.status = entry(channel.status) if channel.status else None
        self.scale, self.offset, self.full_scale = channel.scale, channel.offset, channel.full_scale
        self.full = full  # of a whole number; None for REAL32
        self.push = 0.0
        self.stuck = self.broken = False

    def raw(self) -> tuple[Number, int]:
        """Return raw value and status byte of the present sample."""
        if self.broken:
            return (math.nan if self.full is None else 0), _INVALID
        value = self.source() + self.push
        status = 0
        if abs(value) >= self.full_scale:
            status = _ABOVE if value > 0.0 else _BELOW
            value = math.copysign(self.full_scale, value)
        raw = (value - self.offset) / self.scale
        if self.full is None:
            return raw, status
        return min(max(round(raw), -self.full - 1), self.full), status


class SimulatedAmplifier(SimulatedNode):
    """Shows channels of the chain.

    Parameters
    ----------
    source
        Returns, for a channel's name, what delivers its present value in the channel's unit.
    """

    def __init__(
        self,
        wire: Wire,
        name: str,
        settings: AmplifierSettings,
        sample_rate_hz: float,
        source: Callable[[str], Source],
    ) -> None:
        super().__init__(wire, name, settings.node, settings.eds, sample_rate_hz)
        self.lines = {
            channel.name: _Line(channel, source(channel.name), self._full(channel))
            for channel in settings.channels
        }
        self.tick()

    def tick(self) -> None:
        """Show the present sample."""
        values = self.values
        for line in self.lines.values():
            if line.stuck:
                continue
            values[line.at], status = line.raw()
            if line.status is not None:
                values[line.status] = status

    def boot(self) -> None:
        """Lose power for a moment."""
        super().boot()
        self.tick()

    def _full(self, channel: AmplifierChannel) -> int | None:
        at: Entry = entry(channel.object)
        variable_at = variable(self.dictionary, at)
        kind = None if variable_at is None else variable_at.data_type
        if kind == datatypes.REAL32:
            return None
        if kind not in _FULL:
            raise ConfigurationError(
                f"{self.name}: channel {channel.name}: object {at} is neither I16, I32 nor REAL32; "
                "the simulated amplifier has no other process values"
            )
        return _FULL[kind]
