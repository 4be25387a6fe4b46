"""A frequency response and its distortions as rows of numbers, for tables, figures and programs."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from analysis.uncertainty.freedom import student_factor

if TYPE_CHECKING:
    from analysis.resolver.harmonics import Harmonics


@dataclass(frozen=True)
class ResponseRow:
    """One line of the response of ``output`` on ``input``.

    Attributes
    ----------
    gain, gain_half_width, unit
        Size of output over input; the half-width is that of either part of it.
    phase_deg, phase_half_width_deg
        Of the output ahead of the input.
    coherence
        Part of the output's power in one period that goes with the input.
    """

    input: str
    output: str
    unit: str
    line: int
    frequency_hz: float
    gain: float
    gain_half_width: float
    phase_deg: float
    phase_half_width_deg: float
    coherence: float


@dataclass(frozen=True)
class DistortionRow:
    """What stands at the harmonics of one parity that were not excited, in the output's unit.

    Attributes
    ----------
    level, half_width
        Root mean square amplitude of a line, what noise adds taken off.
    noise
        Root mean square amplitude of noise alone.
    relative
        The level over that of the lines that were excited.
    chance
        With which noise alone would be as large.
    """

    output: str
    unit: str
    degree: str
    lines: tuple[int, ...]
    level: float
    half_width: float
    noise: float
    relative: float
    chance: float
    told: bool


@dataclass(frozen=True)
class ResponseRows:
    """The responses of a gate's channels on one of them."""

    lines: tuple[ResponseRow, ...]
    distortions: tuple[DistortionRow, ...]


def response_rows(
    reading: "Harmonics", motion: str, orders: Sequence[int], level: float
) -> ResponseRows:
    """Return the response of every other channel of a gate, and its distortions.

    Raises
    ------
    DataError
        If the motion was not resolved, or does not move at a line given.
    """
    lines: list[ResponseRow] = []
    distortion_rows: list[DistortionRow] = []
    for output in reading.channel_names:
        if output != motion:
            channel_lines, channel_distortions = _of(reading, motion, output, orders, level)
            lines += channel_lines
            distortion_rows += channel_distortions
    return ResponseRows(tuple(lines), tuple(distortion_rows))


def _of(
    reading: "Harmonics", motion: str, output: str, orders: Sequence[int], level: float
) -> tuple[Iterator[ResponseRow], Iterator[DistortionRow]]:
    from analysis.response.distortion import distortions
    from analysis.response.frequency_response import frequency_response

    response = frequency_response(reading, motion, output, orders)
    half = student_factor(response.degrees_of_freedom, level) * np.sqrt(response.variance / 2.0)
    gain = np.abs(response.values)
    turn = np.degrees(np.minimum(half / np.maximum(gain, 1e-300), math.pi))
    lines = (
        ResponseRow(
            motion,
            output,
            response.unit,
            line,
            float(response.frequencies_hz[k]),
            float(gain[k]),
            float(half[k]),
            float(np.degrees(np.angle(response.values[k]))),
            float(turn[k]),
            float(response.coherence[k]),
        )
        for k, line in enumerate(response.orders)
    )
    unit = response.unit.rpartition("/")[0]
    distortion_rows = (
        DistortionRow(
            output,
            unit,
            str(distortion.degree),
            distortion.orders,
            distortion.level,
            float(student_factor(np.array([np.inf]), level)[0]) * distortion.uncertainty,
            float(np.sqrt((distortion.noise**2).mean())),
            distortion.relative,
            distortion.chance,
            distortion.is_significant,
        )
        for distortion in distortions(reading, response)
    )
    return lines, distortion_rows
