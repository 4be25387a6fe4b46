"""Whole runs of an exact rig, in memory: sampled with noise, or its averaged cycle."""

from dataclasses import dataclass

import numpy as np

from hardware.description.channels import (
    DISPLACEMENT_AFT,
    DISPLACEMENT_FORE,
    FORCE_AFT,
    FORCE_FORE,
    FORCE_X,
)
from tests.exact.forces import Array, at_rest, state
from tests.exact.jet import Values, wave
from tests.exact.rig import ExactRig

# A turntable's force and moment stand in the places of the struts'.
READINGS = (FORCE_AFT.name, FORCE_FORE.name, FORCE_X.name)
DISPLACEMENTS = (DISPLACEMENT_AFT.name, DISPLACEMENT_FORE.name)
_ANGLES = 512


@dataclass(frozen=True, eq=False)
class Record:
    """A run's samples: ``channels`` by name in SI units, pulses of the photocell at theta = 0."""

    sample_rate_hz: float
    channels: dict[str, Array]
    photocell_edges_s: Array


def readings(rig: ExactRig, theta: Array, *, tared: bool = False) -> Array:
    """Return what the gauges read, shape ``(3, angles)``; tared at rest where the drift sets it."""
    found = state(rig, theta).readings
    return np.asarray(found - at_rest(rig)[:, None] if tared else found)


def harmonics(values: Array, orders: int) -> Values:
    """Return H[0] to H[orders] of values at equidistant angles, shape ``(orders + 1, rows)``.

    As :attr:`ExactRig.coordinates`: the mean is real, ``y_n = Im(H[n] exp(i n theta))``.
    """
    spectrum = np.fft.rfft(values, axis=-1).T[: orders + 1] / values.shape[-1]
    return np.asarray(np.concatenate((spectrum[:1], 2j * spectrum[1:])))


def cycle(rig: ExactRig, orders: int, *, tared: bool = False) -> Values:
    """Return the exact harmonics of the gauges over a cycle, shape ``(orders + 1, 3)``."""
    theta = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES
    return harmonics(readings(rig, theta, tared=tared), orders)


def record(
    rig: ExactRig,
    sample_rate_hz: float,
    periods: float,
    *,
    noise: Array | float = 0.0,
    displacement_noise_m: float = 0.0,
    seed: int = 0,
    tared: bool = False,
) -> Record:
    """Return a run's samples.

    Parameters
    ----------
    noise
        Standard deviation of each reading's white noise, one number or three, N (N m).
    seed
        Of the noise.
    """
    count = round(periods / rig.frequency_hz * sample_rate_hz) + 1
    time = np.arange(count) / sample_rate_hz
    theta = rig.omega * time
    draw = np.random.default_rng(seed)
    read = readings(rig, theta, tared=tared)
    read = read + np.reshape(noise, (-1, 1)) * draw.standard_normal(read.shape)
    moved = np.stack([wave(one, rig.omega, theta).value.real for one in rig.coordinates.T])
    moved = moved + displacement_noise_m * draw.standard_normal(moved.shape)
    names = (*DISPLACEMENTS, *READINGS)
    channels = dict(zip(names, (*moved, *read), strict=True))
    edges = np.arange(int(np.floor(periods)) + 1) / rig.frequency_hz
    return Record(sample_rate_hz, channels, edges)
