"""The modes of 1963 beside the new estimator, on one gate of one recording."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.arrays import FloatArray

if TYPE_CHECKING:
    from analysis.resolver.analysis import Analysis


GATES = (1, 2, 3, 4)  # periods, as on the apparatus


@dataclass(frozen=True)
class ClassicRow:
    """What one mode reads of one channel: ``[S1, C1, S2, C2, ...]``, NaN where it reads nothing."""

    mode: str
    channel: str
    unit: str
    parts: tuple[float, ...]


def classic_rows(analysis: "Analysis") -> tuple[ClassicRow, ...]:
    """Read the first gate's window with every mode; channel by channel, the new estimator first.

    The needles of the running average are read at the window's end, if they have settled by then;
    a gate of m periods is the first that fits the window.
    """
    reading = analysis.readings[0]
    readings = {f"new: {reading.estimator}": reading.coefficients[:, 1:]}
    for periods in GATES:
        readings[f"gated integration, m = {periods}"] = _gated(analysis, periods)
    readings["gate cut to whole samples, m = 1"] = _rounded(analysis)
    readings["running average, 1.5 periods"] = _needles(analysis)
    return tuple(
        ClassicRow(mode, name, reading.units[row], tuple(parts[row].tolist()))
        for row, name in enumerate(reading.channel_names)
        for mode, parts in readings.items()
    )


def _edges_s(analysis: "Analysis") -> FloatArray:
    steady, periods = analysis.steady_sums, analysis.readings[0].periods
    return np.append(steady.opened_s[:periods], steady.closed_s[periods - 1])


def _empty_rows(analysis: "Analysis") -> FloatArray:
    reading = analysis.readings[0]
    return np.full((len(reading.channel_names), 2 * reading.order), np.nan)


def _interleaved(in_phase: FloatArray, quadrature: FloatArray) -> FloatArray:
    return np.stack((in_phase, quadrature), axis=-1).reshape(len(in_phase), -1)


def _gated(analysis: "Analysis", periods: int) -> FloatArray:
    from analysis.resolver.classic_recording import gated_readings

    edges_s = _edges_s(analysis)
    if len(edges_s) <= periods:
        return _empty_rows(analysis)
    first = gated_readings(
        analysis.recording,
        analysis.reference,
        periods=periods,
        harmonics=analysis.settings.harmonics,
        pulses_s=edges_s[: periods + 1],
    )[0]
    return _interleaved(first.in_phase, first.quadrature)


def _rounded(analysis: "Analysis") -> FloatArray:
    from analysis.resolver.classic_recording import rounded_gate

    opened_s, closed_s = _edges_s(analysis)[:2]
    reading = rounded_gate(
        analysis.recording,
        analysis.reference,
        float(opened_s),
        float(closed_s),
        analysis.settings.harmonics,
    )
    return _interleaved(reading.in_phase, reading.quadrature)


def _needles(analysis: "Analysis") -> FloatArray:
    from analysis.resolver.classic_recording import running_average

    reading = analysis.readings[0]
    window = analysis.recording.between(reading.opened_s, reading.closed_s)
    needles = running_average(window, analysis.reference, harmonics=analysis.settings.harmonics)
    if not needles.settled[-1]:
        return _empty_rows(analysis)
    return _interleaved(needles.in_phase[..., -1], needles.quadrature[..., -1])
