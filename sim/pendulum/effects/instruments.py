"""Effects on what watches the body: sensors, recorder and clock.

An empty ``channel`` means every sensor of the test.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from hardware.description.errors import ConfigurationError
from sim.acquisition.channels import Digitiser
from sim.effects.parameter import parameter
from sim.pendulum.bench import PendulumBench
from sim.pendulum.sensors import Sensor

# From each a delay is found that turns the phase by less than half a turn more, up to 5 Hz.
_DELAYS_S = (0.01, *(sign * 0.1 * step for step in range(1, 5) for sign in (1.0, -1.0)))


@dataclass(frozen=True)
class WrongClock:
    """A recorder or timer whose clock runs fast."""

    clock_error: float = parameter(1e-4, -0.01, 0.01, "1", "reading over true time, less one")
    channel: str = ""

    name = "wrong_clock"
    stage = "acquisition"
    summary = "all recorded times are the true ones times 1 + error"
    signature = "every period longer by the same share; inertia by twice that"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        _check_stamped(bench, self.name, self.channel)
        error = (1.0 + bench.clock_error) * (1.0 + self.clock_error) - 1.0
        return replace(bench, clock_error=error)


@dataclass(frozen=True)
class SensorDelay:
    """A recorder that stamps a sensor late, or early: its clock was set wrong, or it takes time."""

    delay_s: float = parameter(
        0.01, -0.5, 0.5, "s", "stamp less true time, the same at any frequency", starts=_DELAYS_S
    )
    channel: str = ""

    name = "sensor_delay"
    stage = "acquisition"
    summary = "all recorded times are the true ones plus a constant"
    signature = "phase against the force later by w delay; amplitude as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        _check_stamped(bench, self.name, self.channel)
        return replace(bench, delay_s=bench.delay_s + self.delay_s)


@dataclass(frozen=True)
class SensorLag:
    """First-order lag of a sensor."""

    lag_s: float = parameter(0.05, 0.0, 1.0, "s", "its time constant")
    channel: str = ""

    name = "sensor_lag"
    stage = "sensors"
    summary = "1/(1 + s lag)"
    signature = "amplitude / sqrt(1 + (w lag)^2), later by atan(w lag); T as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _sensors(
            bench, self.channel, lambda sensor: replace(sensor, lag_s=sensor.lag_s + self.lag_s)
        )


@dataclass(frozen=True)
class SensorOffset:
    """A sensor that does not read zero at rest."""

    offset: float = parameter(1e-3, -0.1, 0.1, "rad or m", "reading at zero")
    channel: str = ""

    name = "sensor_offset"
    stage = "sensors"
    summary = "a constant on top of the reading"
    signature = "mean of the record; static fits without offset are biased"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _sensors(
            bench, self.channel, lambda sensor: replace(sensor, offset=sensor.offset + self.offset)
        )


@dataclass(frozen=True)
class SensorGain:
    """A sensor whose scale is off."""

    gain_error: float = parameter(0.005, -0.1, 0.1, "1", "reading over truth, less one")
    channel: str = ""

    name = "sensor_gain"
    stage = "sensors"
    summary = "the reading times 1 + error"
    signature = "static lever falls by the error; T as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        gain = 1.0 + self.gain_error
        return _sensors(
            bench, self.channel, lambda sensor: replace(sensor, gain=sensor.gain * gain)
        )


@dataclass(frozen=True)
class SensorSign:
    """A sensor, or a column of its record, whose positive direction is the other one."""

    channel: str = ""

    name = "sensor_sign"
    stage = "sensors"
    summary = "the reading with the other sign"
    signature = "phase by half a turn at any frequency; amplitude as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _sensors(bench, self.channel, lambda sensor: replace(sensor, gain=-sensor.gain))


@dataclass(frozen=True)
class SensorNoise:
    """White noise on a channel."""

    noise_rms: float = parameter(1e-4, 0.0, 0.05, "rad or m", "standard deviation of each sample")
    channel: str = ""

    name = "sensor_noise"
    stage = "acquisition"
    summary = "noise of each sample, independent"
    signature = "white residual; scatter of T falls with record length^-3/2"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _digitisers(
            bench,
            self.channel,
            lambda how: replace(how, noise_rms=math.hypot(how.noise_rms, self.noise_rms)),
        )


@dataclass(frozen=True)
class SensorDrift:
    """A zero that goes on at an even rate, as a sensor or its amplifier warms."""

    drift_per_s: float = parameter(1e-4, -1e-3, 1e-3, "rad/s or m/s", "slope of the reading")
    channel: str = ""

    name = "sensor_drift"
    stage = "acquisition"
    summary = "a straight line in time on top of the reading"
    signature = "means rise evenly; amplitude and T as is"

    def __call__(self, bench: PendulumBench) -> PendulumBench:
        """Return the test with the effect on."""
        return _digitisers(
            bench,
            self.channel,
            lambda how: replace(how, drift_per_s=how.drift_per_s + self.drift_per_s),
        )


def _digitisers(
    bench: PendulumBench, channel: str, change: Callable[[Digitiser], Digitiser]
) -> PendulumBench:
    chosen = _sensors_of(bench, channel)
    changed = tuple(
        change(how) if sensor in chosen else how
        for sensor, how in zip(bench.sensors, bench.digitisers, strict=True)
    )
    return replace(bench, digitisers=changed)


def _check_stamped(bench: PendulumBench, effect: str, channel: str) -> None:
    """Refuse another clock for one of several sensors: a test has one recorder."""
    if len(_sensors_of(bench, channel)) < len(bench.sensors):
        raise ConfigurationError(
            f"{effect}: one clock stamps all sensors of this test; leave channel = {channel!r} out"
        )


def _sensors_of(bench: PendulumBench, channel: str) -> tuple[Sensor, ...]:
    """Return the sensors of that channel, or all."""
    chosen = tuple(sensor for sensor in bench.sensors if channel in ("", sensor.channel.name))
    if not chosen:
        names = ", ".join(sensor.channel.name for sensor in bench.sensors)
        raise ConfigurationError(f"no sensor {channel!r} in this test (sensors: {names})")
    return chosen


def _sensors(
    bench: PendulumBench, channel: str, change: Callable[[Sensor], Sensor]
) -> PendulumBench:
    chosen = _sensors_of(bench, channel)
    return bench.change_sensors(lambda sensor: change(sensor) if sensor in chosen else sensor)
