"""A pendulum test: body, release and sensors, and their sampling; effects change it.

Noise, drift and conversion of each sensor are those of the towing tank.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.acquisition.channels import Digitiser
from sim.acquisition.noise import NoiseState, draw_normal, start_stream
from sim.chain import Chain
from sim.pendulum.body import FreeBody, SwingingBody
from sim.pendulum.photogate import Photogate
from sim.pendulum.release import Release
from sim.pendulum.sensors import Sensor, Sensors
from sim.signals import Signal, Signals, recorded
from sim.stage import Block

if TYPE_CHECKING:
    from sim.stage import Stage


@dataclass(frozen=True)
class PendulumBench:
    """All parameters of one test.

    Attributes
    ----------
    clock_error
        By how much the clock of recorder and timers runs fast; their times are the true ones times
        (1 + clock_error).
    delay_s
        By how much it stamps everything late.
    """

    body: SwingingBody
    release: Release
    sensors: tuple[Sensor, ...]
    digitisers: tuple[Digitiser, ...]
    photogates: tuple[Photogate, ...] = ()
    clock_error: float = 0.0
    delay_s: float = 0.0

    def __post_init__(self) -> None:
        if len(self.sensors) != len(self.digitisers):
            raise ConfigurationError(
                f"{len(self.sensors)} sensors and {len(self.digitisers)} digitisers; each sensor "
                "needs one"
            )
        if self.release.coordinates != self.body.coordinates:
            raise ConfigurationError("the release is for other coordinates than the body's")
        if not -0.5 < self.clock_error < 0.5:
            raise ConfigurationError(
                f"clock_error = {self.clock_error:g} is not between -0.5 and 0.5; it is a share of "
                "the time, 20e-6 for a common quartz"
            )

    def chain(self) -> Chain:
        """Return the stages: release, body, sensors, photogates, acquisition."""
        sampled = SampledSensors(self.sensors, self.digitisers)
        stages: tuple[Stage[Any], ...] = (self.release, FreeBody(self.body))
        return Chain((*stages, Sensors(self.sensors), *self.photogates, sampled))

    def change_body(self, change: Callable[[SwingingBody], SwingingBody]) -> "PendulumBench":
        """Return the test with another body of the same coordinates."""
        return replace(self, body=change(self.body))

    def change_sensors(self, change: Callable[[Sensor], Sensor]) -> "PendulumBench":
        """Return the test with each sensor changed."""
        return replace(self, sensors=tuple(change(sensor) for sensor in self.sensors))

    def with_effects(
        self, effects: Iterable[Callable[["PendulumBench"], "PendulumBench"]]
    ) -> "PendulumBench":
        """Return the test with all effects on, in the order given."""
        bench = self
        for effect in effects:
            bench = effect(bench)
        return bench


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
