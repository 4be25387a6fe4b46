"""What a record tells, in units of its noise: lines over the shaft's angle, pulses, hum.

The lines of m whole revolutions, from 0 to 6 per revolution in steps of 1/m, hold harmonics, drift,
transients and what lies between the harmonics; each has a known variance. Nothing here is used to
make a recording.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from tests.sealed.generator.gauges import between
from tests.sealed.generator.parameters import FloatArray
from tests.sealed.generator.rig import CHANNELS, DITHER, Record, Rig, Run

ORDERS = 6
POINTS = 32  # per revolution; lines beyond 16 per revolution fold, the mains has lines of its own
HUM_HZ = 50.0
# Scatter of a pulse that a photocell of this kind has anyway, and of the set speed, run by run.
PULSE_RAD, FREQUENCY_RELATIVE = 2e-4, 1e-4


class StalledError(ValueError):
    """The shaft does not make its revolutions: nothing tells the phase."""


@dataclass(frozen=True)
class Reference:
    """Phase of the shaft: time of the first mark, period, and each pulse's deviation in turns."""

    opens_s: float
    period_s: float
    deviations: FloatArray

    def off(self, periods: int, late: float, slow: float) -> "Reference":
        """Return the line ``late`` and ``slow`` standard deviations off, as its pulses scatter."""
        scatter, n = PULSE_RAD / (2.0 * np.pi) * self.period_s, periods + 1
        slope = slow * scatter * np.sqrt(12.0 / n**3)
        opens = self.opens_s + late * scatter / np.sqrt(n) - 0.5 * periods * slope
        return Reference(opens, self.period_s + slope, self.deviations)


def upward_crossings(values: FloatArray, times: FloatArray) -> FloatArray:
    """Return where a noise-free signal passes its mean upwards."""
    level = values - 0.5 * (values.max() + values.min())
    at = np.flatnonzero((level[:-1] < 0.0) & (level[1:] >= 0.0))
    part = -level[at] / (level[at + 1] - level[at])
    return np.asarray(times[at] + part * (times[1] - times[0]))


def whole_turns(angle: FloatArray, times: FloatArray) -> FloatArray:
    """Return where a noise-free angle passes whole turns."""
    turns = angle / (2.0 * np.pi)
    if not np.isfinite(turns).all():
        return np.empty(0)
    wanted = np.arange(np.ceil(turns[0]), np.floor(turns[-1]) + 1.0)
    return np.asarray(np.interp(wanted, turns, times))


def reference(record: Record, run: Run, sensors: tuple[str, ...]) -> Reference:
    """Return the straight line through pulses, the encoder's turns or the aft strut's crossings.

    Raises
    ------
    StalledError
        Where half of the revolutions are missing.
    """
    edges = record.edges_s
    if "photocell" not in sensors and "shaft_angle" in sensors:
        edges = whole_turns(record.channels[0], record.times_s)
    elif "photocell" not in sensors:
        edges = upward_crossings(record.channels[1], record.times_s)
    if len(edges) < max(2, (run.periods + 1) // 2):
        raise StalledError(f"{run.name}: {len(edges)} revolutions of {run.periods}")
    turns = np.round((edges - edges[0]) * run.frequency_hz)
    period, opens = np.polyfit(turns, edges, 1)
    deviations = np.diff(edges) / period - 1.0
    wanted = np.zeros(run.periods)
    wanted[: min(len(deviations), run.periods)] = deviations[: run.periods]
    return Reference(float(opens), float(period), wanted)


def resampled(record: Record, ref: Reference, periods: int) -> FloatArray:
    """Return all channels at even angles of whole revolutions, the shaft's less a straight one."""
    times = ref.opens_s + ref.period_s * np.arange(periods * POINTS) / POINTS
    values = between(np.ascontiguousarray(record.channels), times * record.sample_rate_hz)
    values[0] -= 2.0 * np.pi * (times - ref.opens_s) / ref.period_s
    return values


def line_spectrum(values: FloatArray, periods: int) -> FloatArray:
    """Return mean, then in-phase and quadrature of every line up to 6 per revolution, in a row."""
    n = values.shape[-1]
    lines = np.fft.rfft(values, axis=-1)[..., : ORDERS * periods + 1] / n
    mean = lines[..., :1].real
    return np.concatenate([mean, -2.0 * lines[..., 1:].imag, 2.0 * lines[..., 1:].real], axis=-1)


def harmonics(values: FloatArray, periods: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return mean, in-phase and quadrature parts of orders 1 to 6 of resampled channels."""
    spectrum = line_spectrum(values, periods)
    half = ORDERS * periods
    own = np.arange(1, ORDERS + 1) * periods
    return spectrum[..., 0], spectrum[..., own], spectrum[..., half + own]


def density(rig: Rig, channel: int, frequency_hz: FloatArray, loud: float = 1.0) -> FloatArray:
    """Return the spectral density of a channel's noise, a sample's variance for white noise."""
    noise = rig.noise
    flat = (
        noise.step_rad**2 * (1.0 / 12.0 + DITHER**2),
        noise.displacement_m**2 + noise.step_m**2 / 12.0,
        noise.displacement_m**2 + noise.step_m**2 / 12.0,
        noise.white_n**2 + noise.step_n**2 / 12.0,
        noise.white_n**2 + noise.step_n**2 / 12.0,
        noise.carriage_m_s**2,
    )[channel]
    out = np.full(frequency_hz.shape, flat)
    if channel in (3, 4):
        turn = np.exp(-2j * np.pi * frequency_hz / rig.sample_rate_hz)
        out += correlated(noise.coloured_n, noise.colour_s * rig.sample_rate_hz, turn)
        out *= loud**2
        if noise.wander_n > 0.0:
            out += correlated(noise.wander_n, noise.wander_s * rig.sample_rate_hz, turn)
    return out


def correlated(rms: float, samples: float, turn: NDArray[np.complex128]) -> FloatArray:
    """Return the spectral density of what is exponentially correlated over so many samples."""
    keep = np.exp(-1.0 / samples)
    return np.asarray(rms**2 * (1.0 - keep**2) / np.abs(1.0 - keep * turn) ** 2)


@lru_cache(maxsize=512)
def line_sigma(rig: Rig, run: Run, channel: int) -> FloatArray:
    """Return the standard deviation of each number of :func:`line_spectrum`."""
    count = run.periods / run.frequency_hz * rig.sample_rate_hz
    lines = np.arange(ORDERS * run.periods + 1) / run.periods * run.frequency_hz
    sigma = np.sqrt(2.0 * density(rig, channel, lines, run.loud) / count)
    if channel == 0:  # the encoder and the pulses share no zero: its mean tells nothing
        sigma[0] = 1e3
    else:
        sigma[0] /= np.sqrt(2.0)
    return np.concatenate([sigma, sigma[1:]])


def recorded(sensors: tuple[str, ...]) -> list[int]:
    """Return the rows of the channels that are there."""
    return [i for i, name in enumerate(CHANNELS) if name in sensors]


def _mains(record: Record, rows: list[int]) -> FloatArray:
    window = np.hanning(record.channels.shape[1])
    turn = np.exp(-2j * np.pi * HUM_HZ * record.times_s) * window / window.sum()
    lines = 2.0 * record.channels[rows] @ turn
    return np.column_stack([lines.real, lines.imag]).ravel()


def _of_still(record: Record, run: Run, rig: Rig, rows: list[int]) -> FloatArray:
    """Return mean and one line of a record without motion, in sigma."""
    count = record.channels.shape[1]
    frequency = run.frequency_hz or 1.0
    turn = np.exp(-2j * np.pi * frequency * record.times_s)
    line = 2.0 / count * record.channels[rows] @ turn
    lines = np.array([0.0, frequency])
    sigma = np.sqrt([density(rig, row, lines, run.loud) / count for row in rows])
    return np.column_stack(
        [
            record.channels[rows].mean(axis=1) / sigma[:, 0],
            line.real / sigma[:, 1] / np.sqrt(2.0),
            line.imag / sigma[:, 1] / np.sqrt(2.0),
        ]
    ).ravel()


def features(
    record: Record, run: Run, rig: Rig, *, late: float = 0.0, slow: float = 0.0
) -> FloatArray:
    """Return all numbers of a noise-free record, each divided by its standard deviation.

    ``late`` and ``slow`` put the line through the pulses off, in its standard deviations.
    """
    rows = recorded(rig.sensors)
    forces = [row for row in rows if row in (3, 4)]
    if not run.turns:
        return _of_still(record, run, rig, forces)
    ref = reference(record, run, rig.sensors).off(run.periods, late, slow)
    spectrum = line_spectrum(resampled(record, ref, run.periods)[rows], run.periods)
    sigma = np.array([line_sigma(rig, run, row) for row in rows])
    count = run.periods / run.frequency_hz * rig.sample_rate_hz
    mains_hz = np.array([HUM_HZ])
    hum_sigma = [np.sqrt(3.0 * density(rig, r, mains_hz, run.loud)[0] / count) for r in forces]
    mains = _mains(record, forces) / np.repeat(hum_sigma, 2)
    turn = PULSE_RAD / (2.0 * np.pi) * np.sqrt(12.0 / (run.periods + 1) ** 3)
    frequency = np.log(ref.period_s * run.frequency_hz) / turn
    pulses = ref.deviations * 2.0 * np.pi / (np.sqrt(2.0) * PULSE_RAD)
    if "photocell" not in rig.sensors:
        pulses = 0.0 * pulses
    return np.concatenate([(spectrum / sigma).ravel(), mains, [frequency], pulses])


def embedded(short: FloatArray, brief: Run, run: Run, rig: Rig) -> FloatArray:
    """Return the features of a steady state from those of a few of its periods.

    Harmonics keep their places, with the longer record's smaller sigma; nothing lies between.
    """
    channels = len(recorded(rig.sensors))
    few, many = brief.periods, run.periods
    tail = 2 * sum(name.startswith("force") for name in rig.sensors) + 1
    size = 2 * ORDERS * few + 1
    table = short[: channels * size].reshape(channels, size) * np.sqrt(many / few)
    out = np.zeros((channels, 2 * ORDERS * many + 1))
    out[:, 0] = table[:, 0]
    for half in (0, 1):
        own = np.arange(1, ORDERS + 1)
        out[:, half * ORDERS * many + own * many] = table[:, half * ORDERS * few + own * few]
    ending = short[channels * size :][:tail].copy()
    ending[-1] *= ((many + 1) / (few + 1)) ** 1.5
    return np.concatenate([out.ravel(), ending, np.zeros(many)])
