"""Sampling of the sensors: noise, drift and conversion of each, as in the towing tank."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from sim.acquisition.channels import Digitiser
from sim.acquisition.noise import NoiseState, draw_normal, start_stream
from sim.pendulum.sensors import Sensor
from sim.signals import Signal, Signals, recorded
from sim.stage import Block


@dataclass(frozen=True)
class SampledSensors:
    """The recorded channels of a pendulum test.

    Attributes
    ----------
    sensors
        The instruments, in the record's order.
    digitisers
        How each is sampled, in the same order.
    """

    sensors: tuple[Sensor, ...]
    digitisers: tuple[Digitiser, ...]

    name = "acquisition"

    @property
    def reads(self) -> tuple[Signal, ...]:
        """What the instruments deliver."""
        return tuple(sensor.signal for sensor in self.sensors)

    @property
    def writes(self) -> tuple[Signal, ...]:
        """The recorded channels."""
        return tuple(recorded(sensor.channel) for sensor in self.sensors)

    def start(self, sample_rate_hz: float, seed: int) -> tuple[NoiseState, ...]:
        """Return the beginning of each channel's own noise."""
        return tuple(start_stream(seed, self.name, sensor.channel.name) for sensor in self.sensors)

    def run(
        self, state: tuple[NoiseState, ...], block: Block, inputs: Signals
    ) -> tuple[tuple[NoiseState, ...], Signals]:
        """Return the recorded samples over the block."""
        after: list[NoiseState] = []
        written: dict[str, FloatArray] = {}
        for sensor, how, noise, out in zip(
            self.sensors, self.digitisers, state, self.writes, strict=True
        ):
            drawn, values = digitise(how, noise, block, inputs[sensor.signal.name])
            after.append(drawn)
            written[out.name] = values
        return tuple(after), written


def digitise(
    how: Digitiser, noise: NoiseState, block: Block, values: FloatArray
) -> tuple[NoiseState, FloatArray]:
    """Return the noise's state and the values with drift and noise, limited and rounded."""
    noise, deviates = draw_normal(noise, block.count)
    heard = values + how.drift_per_s * block.time_s + how.noise_rms * deviates
    if how.full_scale is not None:
        heard = np.clip(heard, -how.full_scale, how.full_scale)
    if how.resolution:
        heard = np.round(heard / how.resolution) * how.resolution
    return noise, heard
