"""An oscillation in waves: what goes with the shaft and what with the waves, told apart at once.

One regression over the steady stretch has the mean, a drift, the harmonics of the shaft and the
lines of the waves: the encounter frequency e, twice it, and its sums and differences with the
shaft's f. Two lines closer than one over the stretch cannot be told apart.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import FORCE_X, FORCES, ROLL_MOMENT, WAVE_PROBE
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.setpoint import SetPoint
from hardware.description.waves import encounter_hz

ENCOUNTER, TWICE, SUM, DIFFERENCE = "e", "2 e", "e + f", "e - f"
_LOADS: Final = (*FORCES, FORCE_X.name, ROLL_MOMENT.name)
_APART: Final = 1.5  # times one over the stretch: closer lines are one
_SOUGHT: Final = 0.2  # of the expected frequency to either side
_HEARD: Final = 8.0  # times the usual line beside: a peak of the probe that is a wave
_STRONG: Final = 0.1  # of the probe's strongest line: a wave is that, or nearly
_UNLIKE: Final = 2.0  # times what was asked for: wave makers are a tenth off, units ten times
_WHOLE: Final = 0.8  # of the samples
_BESIDE: Final = 12  # lines of the spectrum to either side, whose mean is the noise of a line
_HARMONICS: Final = 5
_SWEEPS: Final = 8


@dataclass(frozen=True, eq=False)
class WaveLine:
    """One line of the waves.

    Attributes
    ----------
    values
        Of each channel: amplitude and lead over the first sample, ``x = Re(X e^(i w t))``.
    uncertainty
        Standard uncertainty of either part, by the noise beside the line.
    """

    name: str
    frequency_hz: float
    values: ComplexArray
    uncertainty: FloatArray


@dataclass(frozen=True, eq=False)
class InWaves:
    """What a run in waves tells of them.

    Attributes
    ----------
    expected_hz
        The encounter frequency, by maker, speed and depth.
    channels
        In the order of the lines' values; the probe comes first.
    lines
        That of the encounter first; lines that fall on others are left out.
    """

    run: str
    point: SetPoint
    expected_hz: float
    frequency_hz: float
    channels: tuple[str, ...]
    lines: tuple[WaveLine, ...]

    @property
    def wave(self) -> complex:
        """The probe's amplitude and phase at the encounter frequency."""
        return complex(self.lines[0].values[0])

    @property
    def flags(self) -> tuple[Flag, ...]:
        """What is wrong where the probe shows another wave than was asked for."""
        asked, read = self.point.wave_amplitude_m, abs(self.wave)
        if not asked or 1.0 / _UNLIKE <= read / asked <= _UNLIKE:
            return ()
        message = (
            f"the probe shows waves of {1e3 * read:.3g} mm where {1e3 * asked:.3g} mm were asked "
            "for, and loads are taken per wave amplitude: is the probe's unit right?"
        )
        return (Flag("wave_differs", Severity.WARNING, message, WAVE_PROBE.name),)


def in_waves(
    recording: Recording, analysis: Analysis, point: SetPoint, depth_m: float | None
) -> tuple[InWaves, Recording]:
    """Return what the waves do, and the recording without their lines in its gauges.

    Parameters
    ----------
    analysis
        Of the recording as it is: its shaft's phase and its steady stretch count.
    depth_m
        Of the tank; ``None`` for deep water.

    Raises
    ------
    DataError
        If there is no probe, it shows no wave near the encounter frequency, or that falls on a
        harmonic of the shaft.
    """
    if WAVE_PROBE.name not in recording.channel_names:
        raise DataError(
            f"{recording.name}: it ran in waves and has no channel {WAVE_PROBE.name}; record the "
            "elevation at a probe on the carriage"
        )
    sums = analysis.steady_sums
    chosen = recording.between(float(sums.opened_s[0]), float(sums.closed_s[-1]))
    recording.check_even("telling waves from an oscillation")
    names = (WAVE_PROBE.name, *(name for name in _LOADS if name in recording.channel_names))
    time_s = chosen.time_s()
    values = np.stack([chosen.values(name) for name in names])
    complete = np.isfinite(values).all(axis=0)
    if complete.mean() < _WHOLE:
        raise DataError(
            f"{recording.name}: only {100 * complete.mean():.0f} % of the samples have all of "
            f"{', '.join(names)}, and {100 * _WHOLE:g} % are needed to tell the waves; repeat it"
        )
    for row in values:
        row[~complete] = np.interp(time_s[~complete], time_s[complete], row[complete])
    shaft_hz = point.frequency_hz
    expected = abs(
        encounter_hz(
            point.wave_frequency_hz, point.carriage_speed_m_s, point.wave_heading_rad, depth_m
        )
    )
    span_s = time_s[-1] - time_s[0]
    wave_hz = _measured_hz(recording.name, time_s, values[0], expected)
    lines = _line_frequencies(recording.name, wave_hz, shaft_hz, span_s)
    turns = analysis.reference.cycles_at(time_s)
    line_waves = [_wave(time_s - time_s[0], frequency) for frequency in lines.values()]
    harmonics = [_wave(turns, float(n)) for n in range(1, _HARMONICS + 1)]
    trend = np.stack((np.ones_like(time_s), (time_s - time_s.mean()) / span_s))
    design = np.concatenate((trend, *line_waves, *harmonics)).T
    solved, *_ = np.linalg.lstsq(design[complete], values.T[complete], rcond=None)
    residual = np.where(complete, values - (design @ solved).T, 0.0)
    wave_lines = tuple(
        WaveLine(
            name, hz, solved[2 + 2 * k] - 1j * solved[3 + 2 * k], _noise(residual, hz * span_s)
        )
        for k, (name, hz) in enumerate(lines.items())
    )
    result = InWaves(recording.name, point, expected, wave_hz, names, wave_lines)
    return result, _without_waves(recording, result, time_s[0])


def _wave(time: FloatArray, frequency: float) -> FloatArray:
    phase = 2.0 * math.pi * frequency * time
    return np.stack((np.cos(phase), np.sin(phase)))


def _measured_hz(run: str, time_s: FloatArray, probe: FloatArray, expected_hz: float) -> float:
    """Return the encounter frequency by the probe: its peak, sharpened by least squares."""
    since, tapered = time_s - time_s[0], (probe - probe.mean()) * np.hanning(probe.size)
    step_hz = 1.0 / (since[-1] * (1.0 + 1.0 / (probe.size - 1)))
    power = np.abs(np.fft.rfft(tapered)) ** 2
    lowest = max(1, math.floor((1.0 - _SOUGHT) * expected_hz / step_hz))
    band = power[lowest : math.ceil((1.0 + _SOUGHT) * expected_hz / step_hz) + 1]
    heard = max(_HEARD * float(np.median(power[1:])), _STRONG**2 * float(power[1:].max()))
    if band.size == 0 or not band.max() > heard:
        raise DataError(
            f"{run}: the probe shows no wave within {100 * _SOUGHT:g} % of {expected_hz:.4g} Hz, "
            "the encounter frequency; check wave_frequency_hz, wave_heading_deg, the speed, and "
            f"the channel {WAVE_PROBE.name}"
        )
    wave_hz = float(step_hz * (lowest + int(band.argmax())))
    for _ in range(_SWEEPS):
        cosine, sine = _wave(since, wave_hz)
        design = np.stack((np.ones_like(since), cosine, sine), axis=1)
        mean_, a, b = np.linalg.lstsq(design, probe, rcond=None)[0]
        slope = 2.0 * math.pi * since * (b * cosine - a * sine)
        columns = np.column_stack((design, slope))
        change = np.linalg.lstsq(columns, probe - design @ (mean_, a, b), rcond=None)[0][3]
        wave_hz += float(np.clip(change, -step_hz, step_hz))
    return wave_hz


def _line_frequencies(run: str, wave_hz: float, shaft_hz: float, span_s: float) -> dict[str, float]:
    """Return the frequencies of the lines that can be told from all before them, by name."""
    least_hz = _APART / span_s
    taken_hz = [0.0, *(n * shaft_hz for n in range(1, _HARMONICS + 1))]
    nearest_hz = min(taken_hz, key=lambda hz_taken: abs(hz_taken - wave_hz))
    if abs(nearest_hz - wave_hz) < least_hz:
        taken_by = (
            f"harmonic {nearest_hz / shaft_hz:.0f} of the shaft" if nearest_hz else "the mean"
        )
        raise DataError(
            f"{run}: the encounter frequency of {wave_hz:.4g} Hz cannot be told from {taken_by} "
            f"({nearest_hz:.4g} Hz) within {span_s:.3g} s; choose another frequency, or more "
            "periods"
        )
    lines = {ENCOUNTER: wave_hz}
    taken_hz.append(wave_hz)
    for name, hz in (
        (TWICE, 2.0 * wave_hz),
        (SUM, wave_hz + shaft_hz),
        (DIFFERENCE, abs(wave_hz - shaft_hz)),
    ):
        if min(abs(hz_taken - hz) for hz_taken in taken_hz) >= least_hz:
            lines[name] = hz
            taken_hz.append(hz)
    return lines


def _noise(residual: FloatArray, cycles: float) -> FloatArray:
    """Return the standard uncertainty of either part of a line by what is left over beside it."""
    size = residual.shape[1]
    power = np.abs(np.fft.rfft(residual, axis=1)) ** 2 / size
    middle = round(cycles)
    noise_bins = power[:, max(middle - _BESIDE, 1) : middle + _BESIDE + 1]
    return np.asarray(np.sqrt(2.0 * noise_bins.mean(axis=1) / size))


def _without_waves(recording: Recording, waves: InWaves, start_s: float) -> Recording:
    """Return the recording with the waves' lines taken off its gauges, over its whole length."""
    rows = [recording.index(name) for name in waves.channels[1:]]
    channel_rows = list(range(len(recording.channels)))
    values = np.array(recording.samples[channel_rows, 0 : recording.sample_count])
    since = recording.time_s() - start_s
    for line in waves.lines:
        turn = np.exp(2j * math.pi * line.frequency_hz * since)
        values[rows] -= (line.values[1:, None] * turn).real
    return replace(recording, samples=values)


def transfer(waves: InWaves, name: str, weights: Sequence[float]) -> tuple[complex, float]:
    """Return a load per wave amplitude (squared for a second-order line), and its uncertainty.

    Parameters
    ----------
    name
        Of the line: its first order is over the wave, its lead that over the crest at the probe.
        Second orders are over the wave squared; those with the shaft over its size squared.
    weights
        Of the channels behind the probe.
    """
    line = next(candidate for candidate in waves.lines if candidate.name == name)
    weight = np.array(weights)
    value = complex(weight @ line.values[1:])
    spread = float(np.sqrt((weight**2) @ line.uncertainty[1:] ** 2))
    wave = waves.wave
    by: complex = wave if name == ENCOUNTER else wave**2
    by = by if name in (ENCOUNTER, TWICE) else complex(abs(wave))
    return value / by, spread / abs(by)
