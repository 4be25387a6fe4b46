"""How one channel is sampled: filter, delay, drift, noise, limits and steps."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim.acquisition.amplifier import BridgeCarrier, LowPass, delay_weights
from sim.acquisition.noise import NoiseState, draw_normal
from sim.stage import Block


@dataclass(frozen=True)
class Digitiser:
    """How one channel is sampled; all values in the channel's unit.

    The signal passes the low-pass and the carrier, is sampled, gets drift and noise, and is limited
    and rounded.

    Attributes
    ----------
    noise_rms
        Standard deviation of white noise.
    drift_per_s
        Slope of a linear drift that is zero at the beginning of each record.
    drifted
        What has drifted at time 0.
    resolution
        Step of the converter; 0 for none.
    full_scale
        Converter's range to either side of zero; beyond it the samples stay at it. ``None`` for no
        limit.
    walk_per_sqrt_s
        The drift part of the noise: a random walk whose standard deviation after t seconds is this
        times the root of t.
    walk_corner_hz
        Frequency below which the walk is white noise: it forgets with a time constant of
        1 / (2 pi) of a period of it. 0 for a walk that never does.
    offset
        Added to the signal: a zero offset, or the mounting angle of an encoder.
    gain
        Factor of the amplifier.
    low_pass
        Amplifier filter; ``None`` for none.
    carrier
        ``None`` for a direct-current bridge.
    delay_s
        The sample at time t shows the signal at t less this: skew of a scanned channel.
    hum, hum_hz, hum_phase_rad
        Amplitude, frequency and phase of a disturbance from the mains; it is sampled as it is, so
        that it folds.

    Raises
    ------
    ConfigurationError
        If the delay is negative.
    """

    noise_rms: float = 0.0
    drift_per_s: float = 0.0
    drifted: float = 0.0
    resolution: float = 0.0
    full_scale: float | None = None
    walk_per_sqrt_s: float = 0.0
    walk_corner_hz: float = 0.0
    offset: float = 0.0
    gain: float = 1.0
    low_pass: LowPass | None = None
    carrier: BridgeCarrier | None = None
    delay_s: float = 0.0
    hum: float = 0.0
    hum_hz: float = 50.0
    hum_phase_rad: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        if not self.delay_s >= 0.0:
            raise ConfigurationError(
                f"delay_s = {self.delay_s:g} must not be negative; delay the other channels instead"
            )

    def response(self, s: ComplexArray) -> ComplexArray:
        """Return what filter, carrier, gain and delay make of harmonics at ``s``."""
        factor: ComplexArray = np.exp(-s * self.delay_s) * np.complex128(self.gain)
        if self.low_pass is not None:
            factor = factor * self.low_pass.response(s)
        if self.carrier is not None:
            factor = factor * math.cos(self.carrier.phase_error_rad)
        return factor


class LineState(NamedTuple):
    """State of a channel between two blocks.

    Attributes
    ----------
    walk, level
        Stream and present value of the random walk.
    filtered
        States of the low-pass; ``None`` before the first sample.
    before, after
        The last values before and after the low-pass, newest last.
    """

    noise: NoiseState
    walk: NoiseState
    level: float = 0.0
    filtered: tuple[float, ...] | None = None
    before: tuple[float, ...] | None = None
    after: tuple[float, ...] | None = None


def digitise(
    how: Digitiser, state: LineState, block: Block, values: FloatArray
) -> tuple[LineState, FloatArray]:
    """Filter and delay, add drift and noise, then limit and round, as the converter does."""
    if not block.count:
        return state, values
    state, values = _analog(how, state, block, values)
    if how.drift_per_s or how.drifted:
        values = values + (how.drifted + how.drift_per_s * block.time_s)
    if how.hum:
        turned = 2.0 * math.pi * how.hum_hz * block.time_s + how.hum_phase_rad
        values = values + how.hum * np.sin(turned)
    if how.noise_rms:
        noise, deviates = draw_normal(state.noise, block.count)
        state, values = state._replace(noise=noise), values + how.noise_rms * deviates
    if how.walk_per_sqrt_s:
        walk, deviates = draw_normal(state.walk, block.count)
        levels = _walked(how, state.level, deviates, block.sample_rate_hz)
        state, values = state._replace(walk=walk, level=float(levels[-1])), values + levels
    if how.full_scale is not None:
        values = np.clip(values, -how.full_scale, how.full_scale)
    if how.resolution:
        values = np.round(values / how.resolution) * how.resolution
    return state, values


def _walked(
    how: Digitiser, level: float, deviates: FloatArray, sample_rate_hz: float
) -> FloatArray:
    """Return the levels of a walk that forgets, step by step exactly (Ornstein and Uhlenbeck)."""
    rate = 2.0 * math.pi * how.walk_corner_hz
    if not rate:
        steps = how.walk_per_sqrt_s / math.sqrt(sample_rate_hz) * deviates
        return np.cumsum(np.concatenate([[level], steps]))[1:]
    from scipy.signal import lfilter

    decay = math.exp(-rate / sample_rate_hz)
    steps = how.walk_per_sqrt_s * math.sqrt((1.0 - decay**2) / (2.0 * rate)) * deviates
    return np.asarray(lfilter([1.0], [1.0, -decay], steps, zi=[decay * level])[0], np.float64)


def _analog(
    how: Digitiser, state: LineState, block: Block, values: FloatArray
) -> tuple[LineState, FloatArray]:
    """Do what happens before the converter: offset, filter, delay, carrier and gain."""
    if how.offset:
        values = values + how.offset
    if how.low_pass is not None:
        state, values = _filtered(how.low_pass, state, block, values)
    if how.delay_s:
        state, values = _delayed(how.delay_s, state, block, values)
    factor = how.gain if how.carrier is None else how.gain * how.carrier.modulation(block.time_s)
    return state, values if how.carrier is None and how.gain == 1.0 else values * factor


def _filtered(
    low_pass: LowPass, state: LineState, block: Block, values: FloatArray
) -> tuple[LineState, FloatArray]:
    hold = low_pass.hold(1.0 / block.sample_rate_hz)
    if state.before is None or state.filtered is None:
        first = float(values[0])
        # As if the signal had been at its first value all the time: one step changes nothing.
        state = state._replace(
            before=(first,) * hold.past, filtered=tuple(low_pass.settled(first).tolist())
        )
    joined = np.concatenate([state.before or (), values])
    states = hold.run(np.array(state.filtered), joined[:, np.newaxis])
    state = state._replace(
        before=tuple(joined[-hold.past :].tolist()), filtered=tuple(states[-1].tolist())
    )
    return state, states[:, 0].copy()


def _delayed(
    delay_s: float, state: LineState, block: Block, values: FloatArray
) -> tuple[LineState, FloatArray]:
    weights = delay_weights(delay_s, block.sample_rate_hz)
    past = weights.size - 1
    earlier = state.after if state.after is not None else (float(values[0]),) * past
    joined = np.concatenate([earlier, values])
    state = state._replace(after=tuple(joined[-past:].tolist()))
    return state, np.convolve(joined, weights, mode="valid")
