"""From what happens to what is recorded: gauges, amplifiers, converter, photocell."""

import math

import numpy as np

from tests.sealed.generator.gauges import between, loop_of, recursive
from tests.sealed.generator.mechanism import Truth, happen
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import DITHER, Record, Rig, Run

WARM_UP_S = 150.0


def _kelvin(p: FloatArray, hour: float) -> float:
    return float(p[P.KELVIN_HOUR] * hour)


def _clipped(force: FloatArray, high: float, low: float) -> FloatArray:
    """Return the force, bent over within 3 % of what the gauge can show."""
    for sign, limit in ((1.0, high), (-1.0, low)):
        soft = 0.03 * limit
        force = force - sign * soft * np.logaddexp(0.0, (sign * force - limit) / soft)
    return force


def _gauges(p: FloatArray, truth: Truth, times: FloatArray, run: Run) -> FloatArray:
    """Return what both dynamometers show, shape ``(2, samples)``."""
    force = truth.samples[3:5] + p[[P.CHECK_AFT, P.CHECK_FORE], None]
    drag = p[P.DRAG_TALK] * truth.samples[5] ** 2
    shown = force + p[[P.TALK_AFT, P.TALK_FORE], None] * force[::-1] + drag
    shown = shown + p[P.CURVATURE] * shown**2 / (1.0 + np.abs(shown) / 2000.0)
    if p[P.HYSTERESIS] != 0.0:
        shown = shown + np.array([loop_of(row.copy(), p[P.HYSTERESIS]) for row in shown])
    gain = p[[P.GAIN_AFT, P.GAIN_FORE], None] + p[P.GAIN_KELVIN] * _kelvin(p, run.hour)
    warming = WARM_UP_S * (1.0 - np.exp(-np.maximum(times, 0.0) / WARM_UP_S))
    zero = p[[P.ZERO_AFT, P.ZERO_FORE], None] + p[P.ZERO_KELVIN] * _kelvin(p, run.hour)
    shown = gain * shown + zero + p[[P.WARMING_AFT, P.WARMING_FORE], None] * warming
    if p[P.CLIP_HIGH] < 1e8 or p[P.CLIP_LOW] < 1e8:
        shown = _clipped(shown, p[P.CLIP_HIGH], p[P.CLIP_LOW])
    return np.asarray(shown)


def low_passed(signal: FloatArray, cutoff_hz: float, poles: int, rate_hz: float) -> FloatArray:
    """Return the signal behind equal poles, exact for what is straight between samples."""
    h = 2.0 * math.pi * cutoff_hz / rate_hz
    decay = math.exp(-h)
    late, early = 1.0 - (1.0 - decay) / h, (1.0 - decay) / h - decay
    for _ in range(poles):
        signal = np.array([recursive(row, decay, late, early) for row in signal])
    return np.asarray(signal)


def delayed(signal: FloatArray, delay_samples: float) -> FloatArray:
    """Return the signal of ``delay_samples`` ago."""
    count = len(signal)
    places = np.clip(np.arange(count) - delay_samples, 0.0, count - 1.0)
    return np.asarray(between(signal[None, :], places)[0])


def _amplifiers(p: FloatArray, shown: FloatArray, times: FloatArray, rate_hz: float) -> FloatArray:
    if p[P.LAG_HZ] > 0.0:
        shown = low_passed(shown, p[P.LAG_HZ], int(p[P.LAG_POLES]), rate_hz)
    if p[P.SKEW_AFT] or p[P.SKEW_FORE]:
        skews = p[[P.SKEW_AFT, P.SKEW_FORE]] * rate_hz
        shown = np.array([delayed(row, skew) for row, skew in zip(shown, skews, strict=True)])
    if p[P.HUM] == 0.0:
        return shown
    turn = 2.0 * math.pi * p[P.HUM_HZ] * times + p[P.HUM_PHASE]
    hum = p[P.HUM] * (np.sin(turn) + 0.2 * np.sin(3.0 * turn))
    return np.asarray(shown + hum)


def _noise(rig: Rig, count: int, rng: np.random.Generator) -> FloatArray:
    """Return noise of all channels, shape ``(6, count)``."""
    noise, draws = rig.noise, rng.standard_normal((8, count))
    keep = math.exp(-1.0 / (noise.colour_s * rig.sample_rate_hz))
    fresh = math.sqrt(1.0 - keep * keep)
    draws[6:, 0] *= (1.0 - keep) / fresh
    coloured = np.array([recursive(row, keep, fresh, 0.0) for row in draws[6:]])
    out = np.zeros((6, count))
    out[0] = DITHER * noise.step_rad * draws[0]
    out[1:3] = noise.displacement_m * draws[1:3]
    out[3:5] = noise.white_n * draws[3:5] + noise.coloured_n * coloured
    out[5] = noise.carriage_m_s * draws[5]
    return out


def _stepped(values: FloatArray, step: float) -> FloatArray:
    return np.asarray(np.round(values / step) * step)


def pulses(p: FloatArray, edges_s: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return the photocell's pulses: late, uneven, some of them missing."""
    if not len(edges_s):
        return edges_s
    scatter = p[P.JITTER] / max(p[P.OMEGA], 1e-9) * rng.standard_normal(len(edges_s))
    seen = np.sort(edges_s + p[P.PULSE_DELAY] + scatter)
    if p[P.MISSED] > 0.0:
        seen = seen[(np.arange(len(seen)) + 2) % max(int(p[P.MISSED]), 2) != 0]
    return np.asarray(seen)


def sense(
    p: FloatArray, truth: Truth, run: Run, rig: Rig, rng: np.random.Generator | None
) -> Record:
    """Return the record of a run; without ``rng`` neither noise nor converter is in it.

    The photocell's scatter is an effect, not noise: it is drawn from the run's name and is there
    either way.
    """
    rate = rig.sample_rate_hz
    times = (np.arange(truth.samples.shape[1]) - truth.before) / rate
    channels = truth.samples.copy()
    if run.kind == "injection":
        channels[0] = 2.0 * math.pi * run.frequency_hz * times
        channels[3:5] = p[P.INJECTED] * np.sin(channels[0])
    else:
        channels[3:5] = _gauges(p, truth, times, run)
    channels[3:5] = _amplifiers(p, channels[3:5], times, rate)
    channels[1:3] *= p[[P.SCALE_AFT, P.SCALE_FORE], None]
    channels = channels[:, truth.before :]
    edges = pulses(p, truth.edges_s, np.random.default_rng(list(run.name.encode())))
    if rng is not None:
        channels = channels + _noise(rig, channels.shape[1], rng)
        channels[0] = _stepped(channels[0], rig.noise.step_rad)
        channels[3:5] = _stepped(channels[3:5], rig.noise.step_n)
    return Record(rate, channels, edges)


def record(p: FloatArray, run: Run, rig: Rig, rng: np.random.Generator | None = None) -> Record:
    """Return the record of a run, everything from the motor to the converter."""
    from tests.sealed.generator.mechanism import set_run

    return sense(set_run(p, run), happen(p, run, rig), run, rig, rng)
