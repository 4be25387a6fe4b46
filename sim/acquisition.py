"""The acquisition: noise, drift and conversion of each channel that the rig records."""

from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from hardware.description import channels
from hardware.description.channels import Channel
from sim import signals
from sim.noise import NoiseState, draw_normal, start_stream
from sim.signals import FloatArray, Signal, Signals
from sim.stage import UNKNOWN_KEYS_REFUSED, Block


@dataclass(frozen=True)
class Digitiser:
    """How one channel is sampled; all values in the channel's unit.

    Attributes
    ----------
    noise_rms
        Standard deviation of white noise.
    drift_per_s
        Slope of a linear drift that is zero at time 0.
    resolution
        Step of the converter; 0 for none.
    full_scale
        Converter's range to either side of zero; beyond it the samples stay at it. ``None`` for no
        limit.
    """

    noise_rms: float = 0.0
    drift_per_s: float = 0.0
    resolution: float = 0.0
    full_scale: float | None = None

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED


class Line(NamedTuple):
    """One recorded channel: what it is called, what it measures, and how."""

    channel: Channel
    source: Signal
    digitiser: Digitiser


# Field of Acquisition (and name of the channel) -> the signal behind it.
_SOURCES = {
    channels.SHAFT_ANGLE: signals.SHAFT_ANGLE,
    channels.DISPLACEMENT_AFT: signals.DISPLACEMENT_AFT,
    channels.DISPLACEMENT_FORE: signals.DISPLACEMENT_FORE,
    channels.FORCE_AFT: signals.DYNAMOMETER_FORCE_AFT,
    channels.FORCE_FORE: signals.DYNAMOMETER_FORCE_FORE,
    channels.CARRIAGE_SPEED: signals.CARRIAGE_SPEED,
}


@dataclass(frozen=True)
class Acquisition:
    """The recorded channels, under their standard names; ``None`` where the rig has no such sensor.

    The samples are those of the chain: all channels at the same instants.
    """

    shaft_angle: Digitiser | None = None
    displacement_aft: Digitiser | None = None
    displacement_fore: Digitiser | None = None
    force_aft: Digitiser | None = Digitiser()
    force_fore: Digitiser | None = Digitiser()
    carriage_speed: Digitiser | None = None

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED
    name: ClassVar[str] = "acquisition"

    @property
    def lines(self) -> tuple[Line, ...]:
        """The channels that are recorded, in their order."""
        found = ((channel, getattr(self, channel.name)) for channel in _SOURCES)
        return tuple(Line(channel, _SOURCES[channel], how) for channel, how in found if how)

    @property
    def reads(self) -> tuple[Signal, ...]:
        """The quantities behind the recorded channels."""
        return tuple(line.source for line in self.lines)

    @property
    def writes(self) -> tuple[Signal, ...]:
        """The recorded channels."""
        return tuple(signals.recorded(line.channel) for line in self.lines)

    def start(self, sample_rate_hz: float, seed: int) -> tuple[NoiseState, ...]:  # noqa: ARG002
        """Return the beginning of each channel's own noise."""
        return tuple(start_stream(seed, self.name, line.channel.name) for line in self.lines)

    def run(
        self, state: tuple[NoiseState, ...], block: Block, inputs: Signals
    ) -> tuple[tuple[NoiseState, ...], Signals]:
        """Return the recorded samples of each channel over the block."""
        after: list[NoiseState] = []
        written: dict[str, FloatArray] = {}
        for line, before, out in zip(self.lines, state, self.writes, strict=True):
            noise, samples = _digitise(line.digitiser, before, block, inputs[line.source.name])
            after.append(noise)
            written[out.name] = samples
        return tuple(after), written


def _digitise(
    how: Digitiser, noise: NoiseState, block: Block, values: FloatArray
) -> tuple[NoiseState, FloatArray]:
    """Add drift and noise, then limit and round, as the converter does."""
    if how.drift_per_s:
        values = values + how.drift_per_s * block.time_s
    if how.noise_rms:
        noise, deviates = draw_normal(noise, block.count)
        values = values + how.noise_rms * deviates
    if how.full_scale is not None:
        values = np.clip(values, -how.full_scale, how.full_scale)
    if how.resolution:
        values = np.round(values / how.resolution) * how.resolution
    return noise, values
