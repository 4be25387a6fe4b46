"""Exact motions: sums of sines, evaluated at exactly warped times, with noise of a known size."""

from dataclasses import dataclass, replace

import numpy as np

from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel


@dataclass(frozen=True)
class Motion:
    """A sum of sines: frequencies in Hz, amplitudes, phases in rad."""

    frequencies_hz: FloatArray
    amplitudes: FloatArray
    phases_rad: FloatArray

    def at(self, time_s: FloatArray, order: int = 0) -> FloatArray:
        """A derivative of the motion at some times."""
        turn = 2.0 * np.pi * self.frequencies_hz
        angle = np.outer(time_s, turn) + self.phases_rad + order * np.pi / 2.0
        return np.asarray(np.sin(angle) @ (self.amplitudes * turn**order))


def irregular(rng: np.random.Generator, middle_hz: float = 0.8) -> Motion:
    """Forty waves around a frequency."""
    frequencies_hz = middle_hz * rng.uniform(0.4, 1.9, 40)
    sizes = np.exp(-(((frequencies_hz / middle_hz - 1.0) / 0.3) ** 2)) * rng.rayleigh(size=40)
    return Motion(frequencies_hz, sizes, rng.uniform(0.0, 2.0 * np.pi, 40))


def harmonic(rng: np.random.Generator, *parts: float) -> Motion:
    """A fundamental of 0.5 to 1.5 Hz and its harmonics, of amplitudes 1 and ``parts``."""
    orders = np.arange(1.0, 2.0 + len(parts))
    sizes = np.array([1.0, *parts])
    return Motion(rng.uniform(0.5, 1.5) * orders, sizes, rng.uniform(0.0, 2.0 * np.pi, len(orders)))


@dataclass(frozen=True)
class Truth:
    """``second(t) = gain first^(order)(t - lag - rate (t - mid))``."""

    gain: float
    lag_s: float
    rate: float
    mid_s: float
    order: int = 0

    def on_first(self, time_s: FloatArray) -> FloatArray:
        """Times on the first clock."""
        return np.asarray(time_s - self.lag_s - self.rate * (time_s - self.mid_s))


def recorded(name: str, values: FloatArray, rate_hz: float, start_s: float, unit: str) -> Recording:
    """A recording of one channel ``x``."""
    return Recording(name, (Channel("x", unit),), values[None, :], rate_hz, start_s)


def pair(
    motion: Motion,
    truth: Truth,
    rng: np.random.Generator,
    *,
    duration_s: float = 60.0,
    noise: float | tuple[float, float] = 0.01,
    rates_hz: tuple[float, float] = (100.0, 240.0),
) -> tuple[Recording, Recording]:
    """Two recordings of a motion, each with white noise of that part of its own spread."""
    of_first, of_second = noise if isinstance(noise, tuple) else (noise, noise)
    first_s = -1.0 + np.arange(int(duration_s * rates_hz[0])) / rates_hz[0]
    second_s = -0.5 + np.arange(int(duration_s * rates_hz[1])) / rates_hz[1]
    first = motion.at(first_s)
    second = truth.gain * motion.at(truth.on_first(second_s), truth.order)
    first = first + of_first * first.std() * rng.standard_normal(first.size)
    second = second + of_second * second.std() * rng.standard_normal(second.size)
    return (
        recorded("camera", first, rates_hz[0], -1.0, "m"),
        recorded("sensor", second, rates_hz[1], -0.5, "m"),
    )


def uneven(
    motion: Motion,
    truth: Truth,
    rng: np.random.Generator,
    *,
    rates_hz: tuple[float, float] = (100.0, 60.0),
    noise: float = 0.01,
) -> tuple[Recording, Recording]:
    """Two recordings whose stamps jitter by 0.4 intervals and of which a fifth is lost."""
    made = []
    for name, rate_hz in zip(("camera", "sensor"), rates_hz, strict=True):
        count = int(60.0 * rate_hz)
        stamps_s = (np.arange(count) + rng.uniform(-0.4, 0.4, count)) / rate_hz
        stamps_s = stamps_s[rng.random(count) > 0.2]
        values = motion.at(stamps_s)
        if name == "sensor":
            values = truth.gain * motion.at(truth.on_first(stamps_s), truth.order)
        values = values + noise * values.std() * rng.standard_normal(values.size)
        even = recorded(name, values, (values.size - 1) / np.ptp(stamps_s), stamps_s[0], "m")
        made.append(replace(even, stamps_s=stamps_s))
    return made[0], made[1]
