"""Frequency response of one channel on another at the lines of a motion, and its coherence.

``G(n) = Y(n) / U(n)`` of the harmonics that were excited. Its variance follows from the deviates
that both channels share, so that noise which enters both (a motion's own) counts as often as it
does in truth.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.resolver.harmonics import Harmonics
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError

EXCITED = 0.05
"""Of the largest harmonic of the motion: what is as large is a line. Halved, a joint's play may
pass for one; doubled, a line that was given a tenth of the others' amplitude is not seen."""


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """Output over input at some lines.

    Attributes
    ----------
    orders
        Harmonics of the base frequency, shape ``(lines,)``.
    frequencies_hz
        Theirs.
    values
        ``G``, in units of the output over those of the input, shape ``(lines,)``.
    variance
        Of the complex number: each part has half of it. Shape ``(lines,)``.
    coherence
        Part of the output's power in one period that goes with the input, 0 to 1.
    degrees_of_freedom
        For Student's t, shape ``(lines,)``.
    """

    input: str
    output: str
    unit: str
    orders: tuple[int, ...]
    frequencies_hz: FloatArray
    values: ComplexArray
    variance: FloatArray
    coherence: FloatArray
    degrees_of_freedom: FloatArray

    def at(self, orders: FloatArray) -> ComplexArray:
        """Return the response at harmonics between the lines, straight from one to the next."""
        parts = (self.values.real, self.values.imag)
        real, imaginary = (np.interp(orders, self.orders, part) for part in parts)
        return np.asarray(real + 1j * imaginary)


def phasors_of(reading: Harmonics, channel: str) -> ComplexArray:
    """Return ``S + i C`` of a channel's harmonics, shape ``(N,)``.

    Raises
    ------
    DataError
        If the channel was not resolved.
    """
    row = row_of(reading, channel)
    return np.asarray(reading.in_phase[row] + 1j * reading.quadrature[row])


def deviates_of(reading: Harmonics, channel: str) -> ComplexArray:
    """Return the deviates of a channel's phasors, shape ``(N, k)``."""
    deviations = reading.deviations[row_of(reading, channel)]
    return np.asarray(deviations[1::2] + 1j * deviations[2::2])


def row_of(reading: Harmonics, channel: str) -> int:
    """Return the row of a channel.

    Raises
    ------
    DataError
        If it was not resolved.
    """
    if channel not in reading.channel_names:
        raise DataError(
            f"{reading.run}: no channel {channel!r} was resolved; there are "
            f"{', '.join(reading.channel_names)}"
        )
    return reading.channel_names.index(channel)


def excited_lines(reading: Harmonics, channel: str) -> tuple[int, ...]:
    """Return the harmonics at which a channel moves: 5 % of the largest, or more."""
    size = np.abs(phasors_of(reading, channel))
    return tuple((1 + np.flatnonzero(size >= EXCITED * size.max())).tolist())


def frequency_response(
    reading: Harmonics, motion: str, output: str, orders: Sequence[int] | None = None
) -> FrequencyResponse:
    """Return the response of one channel on another.

    Parameters
    ----------
    motion
        The input: a channel that moves at the lines.
    orders
        The lines; those at which the input moves where they are not given.

    Raises
    ------
    DataError
        If a channel was not resolved, a line lies beyond the highest harmonic, or the input does
        not move there.
    """
    lines = tuple(orders or excited_lines(reading, motion))
    beyond = [n for n in lines if not 1 <= n <= reading.order]
    if beyond:
        raise DataError(
            f"{reading.run}: line {beyond[0]} was not resolved; resolve {max(lines)} harmonics"
        )
    at = np.array(lines) - 1
    u, y = phasors_of(reading, motion)[at], phasors_of(reading, output)[at]
    if not np.all(np.abs(u) > 0.0):
        raise DataError(f"{reading.run}: {motion} does not move at every line given")
    values = y / u
    residual = deviates_of(reading, output)[at] - values[:, None] * deviates_of(reading, motion)[at]
    variance = (np.abs(residual) ** 2).sum(axis=1)
    power = np.abs(y) ** 2
    units = [reading.units[row_of(reading, name)] for name in (output, motion)]
    return FrequencyResponse(
        motion,
        output,
        "/".join(units),
        lines,
        np.array(lines) * reading.frequency_hz,
        values,
        variance / np.abs(u) ** 2,
        power / np.maximum(power + reading.periods * variance, 1e-300),
        reading.degrees_of_freedom[1 + 2 * at],
    )
