"""Instruments on the body or beside it: the reading of each from the motion."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.acquisition.noise import draw_normal, start_stream
from sim.pendulum.coordinates import ANGLE, PITCH, SWAY, YAW, Coordinate
from sim.signals import Signal, Signals
from sim.solve.linear_system import LinearSystem, causal_hold
from sim.stage import Block

INCLINOMETER_RANGE_RAD = math.radians(3.0)


@dataclass(frozen=True)
class Sensor:
    """One instrument: a weighted sum of signals, through its faults.

    Attributes
    ----------
    channel
        What its record is called; ``full_scale`` is the instrument's range to either side.
    weights
        The signals that it feels and how much of each.
    gain
        Reading over truth.
    offset
        What it reads at zero, in the channel's unit.
    lag_s
        Time constant of its first-order lag; exact for a signal straight from sample to sample.
    non_linearity
        Largest deviation from a straight line within the range, over twice the full scale.
    non_repeatability
        Standard deviation, from run to run, of its zero, over twice the full scale.
    """

    channel: Channel
    weights: tuple[tuple[Signal, float], ...]
    gain: float = 1.0
    offset: float = 0.0
    lag_s: float = 0.0
    non_linearity: float = 0.0
    non_repeatability: float = 0.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.lag_s) and self.lag_s >= 0.0):
            raise ConfigurationError(
                f"{self.channel.name}: lag_s = {self.lag_s:g} must be finite and not negative"
            )
        if self.channel.full_scale is None and (self.non_linearity or self.non_repeatability):
            raise ConfigurationError(
                f"{self.channel.name}: non-linearity and non-repeatability are shares of the full "
                "scale, which the channel does not state; state it"
            )

    @property
    def signal(self) -> Signal:
        """What the acquisition is fed with."""
        return Signal(f"sensed_{self.channel.name}", self.channel.unit)


@dataclass(frozen=True)
class SensorState:
    """What an instrument remembers: its zero in this run, its lagged signal and the last input."""

    zero: float
    lagged: float
    last: float | None


@dataclass(frozen=True)
class Sensors:
    """All instruments of a test."""

    sensors: tuple[Sensor, ...]

    name = "sensors"

    @property
    def reads(self) -> tuple[Signal, ...]:
        """The signals that any of them feels."""
        felt = (signal for sensor in self.sensors for signal, _ in sensor.weights)
        return tuple(dict.fromkeys(felt))

    @property
    def writes(self) -> tuple[Signal, ...]:
        """One signal per instrument."""
        return tuple(sensor.signal for sensor in self.sensors)

    def start(self, sample_rate_hz: float, seed: int) -> tuple[SensorState, ...]:
        """Return settled instruments with this run's zeros."""
        return tuple(
            SensorState(_zero(sensor, self.name, seed), 0.0, None) for sensor in self.sensors
        )

    def run(
        self, state: tuple[SensorState, ...], block: Block, inputs: Signals
    ) -> tuple[tuple[SensorState, ...], Signals]:
        """Return the readings over the block."""
        pairs = [
            _read(sensor, before, block, inputs)
            for sensor, before in zip(self.sensors, state, strict=True)
        ]
        readings = {
            sensor.signal.name: out for sensor, (_, out) in zip(self.sensors, pairs, strict=True)
        }
        return tuple(after for after, _ in pairs), readings


def inclinometer(radius_m: float) -> Sensor:
    """Return a gravity-referenced inclinometer of +-3 degrees, carried at a radius.

    It feels the tangential acceleration too and reads ``alpha + alpha'' r/g``, so
    ``alpha (1 - w^2 r/g)`` at the angular frequency w; of small angles, 0.14 % of the second term
    being left out at 3 degrees.

    Parameters
    ----------
    radius_m
        Depth of the instrument below the pivot; negative above it.
    """
    weights = ((ANGLE.displacement, 1.0), (ANGLE.acceleration, radius_m / STANDARD_GRAVITY_M_S2))
    channel = Channel("inclinometer_angle", "rad", INCLINOMETER_RANGE_RAD)
    return Sensor(channel, weights, non_linearity=5e-4, non_repeatability=2e-4)


def motion_capture(coordinate: Coordinate) -> Sensor:
    """Return cameras that see one coordinate as it is, under the coordinate's name."""
    channel = Channel(coordinate.name, coordinate.unit)
    return Sensor(channel, ((coordinate.displacement, 1.0),))


def stern_range(lever_m: float) -> Sensor:
    """Return a range finder that sees the athwartships motion of a point aft of the middle.

    ``sway - lever * yaw``: the displacement of equation 15, to starboard.
    """
    channel = Channel("stern_displacement", "m")
    return Sensor(channel, ((SWAY.displacement, 1.0), (YAW.displacement, -lever_m)))


def rate_gyro(coordinate: Coordinate = PITCH) -> Sensor:
    """Return a gyro, a phone's for example, that reads the rate of one angle."""
    channel = Channel(f"{coordinate.name}_rate", f"{coordinate.unit}/s")
    return Sensor(channel, ((coordinate.rate, 1.0),))


def _zero(sensor: Sensor, stage: str, seed: int) -> float:
    if not sensor.non_repeatability or sensor.channel.full_scale is None:
        return 0.0
    _, draw = draw_normal(start_stream(seed, stage, sensor.channel.name, "zero"), 1)
    return float(sensor.non_repeatability * 2.0 * sensor.channel.full_scale * draw[0])


def _read(
    sensor: Sensor, state: SensorState, block: Block, inputs: Signals
) -> tuple[SensorState, FloatArray]:
    """Return one instrument's readings."""
    felt: FloatArray = np.zeros(block.count)
    for signal, weight in sensor.weights:
        felt = felt + weight * inputs[signal.name]
    if not block.count:
        return state, felt
    lagged = _lag(sensor.lag_s, state, block, felt)
    after = SensorState(state.zero, float(lagged[-1]), float(felt[-1]))
    return after, _distort(sensor, sensor.gain * lagged + sensor.offset + state.zero)


def _lag(lag_s: float, state: SensorState, block: Block, felt: FloatArray) -> FloatArray:
    """Return the signal behind the first-order lag, settled on the first sample."""
    if not lag_s:
        return felt
    first = felt[0] if state.last is None else state.last
    before = felt[0] if state.last is None else state.lagged
    rate = np.array([[1.0 / lag_s]])
    unity = np.ones((1, 1))
    hold = causal_hold(LinearSystem(-rate, rate, unity, 0.0 * unity), 1.0 / block.sample_rate_hz, 1)
    lagged = hold.run(np.array([before]), np.concatenate([[first], felt])[:, np.newaxis])
    return np.ascontiguousarray(lagged[:, 0])


def _distort(sensor: Sensor, reading: FloatArray) -> FloatArray:
    """Bend within the range, stop at its ends.

    The bow is the cubic that is zero at zero and at both ends, and largest at 1/sqrt(3) of them.
    """
    limit = sensor.channel.full_scale
    if limit is None:
        return reading
    x = np.clip(reading / limit, -1.0, 1.0)
    bow = 1.5 * math.sqrt(3.0) * x * (1.0 - x * x)
    bent: FloatArray = limit * (x + 2.0 * sensor.non_linearity * bow)
    return np.clip(bent, -limit, limit)
