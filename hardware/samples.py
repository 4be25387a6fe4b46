"""What devices hand over: cycles, readings, blocks of samples, pulses."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray

Sample = tuple[int, tuple[float, ...]]


@dataclass(frozen=True, slots=True)
class Cycle:
    """One turn of the control loop.

    Attributes
    ----------
    number
        Number of the SYNC, from 1, never wrapping.
    time_s
        ``number`` times the period: the rig's time. It comes from counting, not from a clock.
    lateness_s
        How late the cycle began on the host's clock; 0 when free-running.
    """

    number: int
    time_s: float
    lateness_s: float = 0.0


@dataclass(frozen=True)
class Reading:
    """A position as it was read: in the axis's unit, with its standard uncertainty."""

    value: float
    standard_uncertainty: float
    source: str  # "encoder", or what the operator read: "micrometer", "phase drum"


@dataclass(frozen=True)
class SampleBlock:
    """Consecutive samples of a device.

    Attributes
    ----------
    first
        Number of the first sample; a gap to the previous block is that many lost samples. Devices
        on the bus count SYNCs, others their own samples.
    values
        Shape ``(channels, samples)``, in the channels' units; NaN where a value is not valid.
    """

    first: int
    values: FloatArray


def blocks(samples: Sequence[Sample]) -> tuple[SampleBlock, ...]:
    """Put samples, each its number and its values over the channels, into blocks without gaps."""
    stretches: list[list[Sample]] = []
    for sample in samples:
        if not stretches or sample[0] != stretches[-1][-1][0] + 1:
            stretches.append([])
        stretches[-1].append(sample)
    return tuple(
        SampleBlock(part[0][0], np.array([values for _, values in part], dtype=np.float64).T)
        for part in stretches
    )


@dataclass(frozen=True)
class Pulse:
    """A pulse of the photocell: one per turn of the shaft.

    Attributes
    ----------
    number
        The device's own count, never wrapping.
    time_s
        When, in the rig's time.
    shaft_angle_rad
        Where the shaft was, if the device knows.
    """

    number: int
    time_s: float
    shaft_angle_rad: float = math.nan
