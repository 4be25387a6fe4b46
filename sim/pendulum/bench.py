"""A pendulum test: body, release and sensors; effects change it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from hardware.description.errors import ConfigurationError
from sim.acquisition.channels import Digitiser
from sim.chain import Chain
from sim.pendulum.acquisition import SampledSensors
from sim.pendulum.body import FreeBody, SwingingBody
from sim.pendulum.photogate import Photogate
from sim.pendulum.release import Release
from sim.pendulum.sensors import Sensor, Sensors

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
