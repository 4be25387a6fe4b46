"""The photocell: a pulse each time the shaft passes the mark."""

import math
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from sim import signals
from sim.acquisition.crossings import quintic, root
from sim.acquisition.noise import NoiseState, draw_normal, start_stream
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block

_TURN = 2.0 * math.pi
_MOST_STEPS = 100


@dataclass(frozen=True)
class PhotocellState:
    """State after the last sample, so that pulses between two blocks are found.

    Attributes
    ----------
    last
        Angle, speed and acceleration of the shaft at the last sample; ``None`` before the first.
    jitter
        The stream of random delays.
    passed
        How often the mark has passed.
    """

    last: tuple[float, float, float] | None
    jitter: NoiseState
    passed: int = 0


@dataclass(frozen=True)
class PhotocellStage:
    """Times at which the shaft passes the mark, found between samples.

    Between two samples the angle is the polynomial of fifth degree that has the angle, speed and
    acceleration of both: exact for a steady shaft and, wherever the sampling resolves the change of
    speed, to rounding. The very first sample counts as before the mark.

    Attributes
    ----------
    mark_angle_rad
        Shaft angle at which the pulse comes.
    latency_s
        Delay of every pulse behind the mark.
    jitter_rms_s
        Standard deviation of the delay from pulse to pulse.
    missed_every
        One pulse in so many is missing: those whose number, from 1, it divides; 0 for none.
    extra_every, extra_after_s
        After one pulse in so many comes another, so much later; 0 for none.
    """

    mark_angle_rad: float = 0.0
    latency_s: float = 0.0
    jitter_rms_s: float = 0.0
    missed_every: int = 0
    extra_every: int = 0
    extra_after_s: float = 0.01

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    name = "photocell"
    reads = (
        signals.SHAFT_ANGLE,
        signals.SHAFT_SPEED,
        signals.SHAFT_ACCELERATION,
    )
    writes = (signals.PHOTOCELL_EDGE_TIME,)

    def start(self, sample_rate_hz: float, seed: int) -> PhotocellState:
        """Return the state before the first sample."""
        return PhotocellState(None, start_stream(seed, self.name))

    def run(
        self, state: PhotocellState, block: Block, inputs: Signals
    ) -> tuple[PhotocellState, Signals]:
        """Return the times of the pulses up to the block's last sample.

        Raises
        ------
        ConfigurationError
            If the shaft turns so fast that two marks fall between two samples.
        """
        shaft = np.stack([inputs[signal.name] for signal in self.reads])
        first = block.first
        if state.last is not None:
            shaft = np.hstack([np.array(state.last)[:, np.newaxis], shaft])
            first -= 1
        last = _last(shaft)
        shaft[0] -= self.mark_angle_rad
        edges = (first + _passages(shaft, block.sample_rate_hz)) / block.sample_rate_hz
        jitter = state.jitter
        if self.jitter_rms_s > 0.0:
            jitter, deviates = draw_normal(jitter, edges.size)
            edges = edges + self.jitter_rms_s * deviates
        after = PhotocellState(last, jitter, state.passed + edges.size)
        pulses = self._pulses(state.passed, edges + self.latency_s)
        return after, {signals.PHOTOCELL_EDGE_TIME.name: pulses}

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the time of the pulse within the period, ``(1,)``; each period has the same.

        Jitter and false pulses do not repeat and are left out.
        """
        beyond = inputs[signals.SHAFT_ANGLE.name]
        time_s = self.mark_angle_rad / period.omega_rad_s
        for _ in range(_MOST_STEPS):
            waves = beyond * np.exp(period.s * time_s)
            missing = self.mark_angle_rad - period.omega_rad_s * time_s - float(waves.sum().real)
            step = missing / (period.omega_rad_s + float((period.s * waves).sum().real))
            time_s += step
            if abs(step) < 1e-15 / period.frequency_hz:
                break
        return period, {signals.PHOTOCELL_EDGE_TIME.name: np.array([time_s + self.latency_s + 0j])}

    def _pulses(self, passed: int, edges: FloatArray) -> FloatArray:
        """Leave out the pulses that are missed, and add the extra ones."""
        number = passed + 1 + np.arange(edges.size)
        pulses = edges if not self.missed_every else edges[number % self.missed_every != 0]
        if not self.extra_every:
            return pulses
        extra = edges[number % self.extra_every == 0] + self.extra_after_s
        return np.sort(np.concatenate([pulses, extra]))


def _last(shaft: FloatArray) -> tuple[float, float, float] | None:
    if not shaft.shape[1]:
        return None
    angle, speed, acceleration = (float(value) for value in shaft[:, -1])
    return angle, speed, acceleration


def _passages(shaft: FloatArray, sample_rate_hz: float) -> FloatArray:
    """Return where the angle passes whole turns, in samples after the first one.

    ``shaft`` has the rows angle, speed and acceleration, in radians and seconds.
    """
    turns = _whole_turns(shaft[0])
    steps = np.diff(turns)
    (at,) = np.nonzero(steps)
    if at.size and np.abs(steps[at]).max() > 1:
        raise ConfigurationError(
            f"the shaft passes the photocell's mark more than once between two samples at "
            f"{sample_rate_hz:g} Hz; sample faster"
        )
    marks = _TURN * np.maximum(turns[at], turns[at + 1])
    # Derivatives by the fraction of a sample interval.
    scale = np.array([1.0, 1.0 / sample_rate_hz, 1.0 / sample_rate_hz**2])[:, np.newaxis]
    before, after = shaft[:, at] * scale, shaft[:, at + 1] * scale
    before[0] -= marks
    after[0] -= marks
    passages: FloatArray = at + root(quintic(before, after), after[0])
    return passages


def _whole_turns(angle: FloatArray) -> FloatArray:
    """Return the largest n with ``n * 2 pi <= angle``, as floating point multiplies.

    The quotient alone may round up to a whole number from just below the mark; the root search
    would then look for it between the wrong samples.
    """
    turns = np.floor(angle / _TURN)
    turns -= angle < turns * _TURN
    turns += angle >= (turns + 1.0) * _TURN
    return turns
