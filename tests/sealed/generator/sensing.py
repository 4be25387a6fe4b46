"""From what happens to what is recorded: gauges, amplifiers, converter, photocell."""

import math

import numpy as np

from tests.sealed.generator.filters import bessel, butterworth, filtered
from tests.sealed.generator.gauges import between, bouc_wen_of, loop_of, recursive
from tests.sealed.generator.mechanism import Truth, happen
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import DITHER, Record, Rig, Run

WARM_UP_S = 150.0


def _kelvin(p: FloatArray) -> float:
    return float(p[P.KELVIN_HOUR] * p[P.HOUR])


def _clipped(force: FloatArray, high: float, low: float, bend: float) -> FloatArray:
    """Return the force, bent over within a part of what the gauge can show."""
    for sign, limit in ((1.0, high), (-1.0, low)):
        soft = bend * limit
        force = force - sign * soft * np.logaddexp(0.0, (sign * force - limit) / soft)
    return force


def _warmed(p: FloatArray, times: FloatArray) -> FloatArray:
    """Return how far a zero has gone, by its slope at the start of a record."""
    since = np.maximum(times, 0.0)
    if p[P.WARMING_SHAPE] > 0.0:
        return np.asarray(2.0 * np.sqrt(since + 1.0) - 2.0)
    return np.asarray(WARM_UP_S * (1.0 - np.exp(-since / WARM_UP_S)))


def _gauges(p: FloatArray, truth: Truth, times: FloatArray) -> FloatArray:
    """Return what both dynamometers show, shape ``(2, samples)``."""
    force = truth.samples[3:5] + p[[P.CHECK_AFT, P.CHECK_FORE], None]
    drag = p[P.DRAG_TALK] * truth.samples[5] ** 2
    shown = force + p[[P.TALK_AFT, P.TALK_FORE], None] * force[::-1] + drag
    if p[P.CURVE_SHAPE] > 0.0:
        shown = shown + p[P.CURVATURE] * 100.0**0.3 * np.abs(shown) ** 1.7  # equal at 100 N
    else:
        shown = shown + p[P.CURVATURE] * shown**2 / (1.0 + np.abs(shown) / 2000.0)
    if p[P.HYSTERESIS] != 0.0:
        loop = bouc_wen_of if p[P.LOOP_SHAPE] > 0.0 else loop_of
        shown = shown + np.array([loop(row.copy(), p[P.HYSTERESIS]) for row in shown])
    gain = p[[P.GAIN_AFT, P.GAIN_FORE], None] + p[P.GAIN_KELVIN] * _kelvin(p)
    zero = p[[P.ZERO_AFT, P.ZERO_FORE], None] + p[P.ZERO_KELVIN] * _kelvin(p)
    shown = gain * shown + zero + p[[P.WARMING_AFT, P.WARMING_FORE], None] * _warmed(p, times)
    if p[P.CLIP_HIGH] < 1e8 or p[P.CLIP_LOW] < 1e8:
        shown = _clipped(shown, p[P.CLIP_HIGH], p[P.CLIP_LOW], p[P.CLIP_SOFT])
    return np.asarray(shown)


def low_passed(signal: FloatArray, cutoff_hz: float, poles: int, rate_hz: float) -> FloatArray:
    """Return the signal behind equal poles, exact for what is straight between samples."""
    h = 2.0 * math.pi * cutoff_hz / rate_hz
    decay = math.exp(-h)
    late, early = 1.0 - (1.0 - decay) / h, (1.0 - decay) / h - decay
    for _ in range(poles):
        signal = np.array([recursive(row, decay, late, early) for row in signal])
    return np.asarray(signal)


def delayed(signal: FloatArray, delay_samples: float, *, straight: bool = False) -> FloatArray:
    """Return the signal of ``delay_samples`` ago; ``straight`` between samples, else smooth."""
    count = len(signal)
    places = np.clip(np.arange(count) - delay_samples, 0.0, count - 1.0)
    if straight:
        return np.asarray(np.interp(places, np.arange(count), signal))
    return np.asarray(between(signal[None, :], places)[0])


def _amplifiers(p: FloatArray, shown: FloatArray, times: FloatArray, rate_hz: float) -> FloatArray:
    if p[P.LAG_HZ] > 0.0:
        count = int(p[P.LAG_POLES])
        if p[P.LAG_SHAPE] == 0.0:
            shown = low_passed(shown, p[P.LAG_HZ], count, rate_hz)
        elif p[P.LAG_SHAPE] == 1.0:
            shown = filtered(shown, butterworth(count, p[P.LAG_HZ]), rate_hz)
        else:
            shown = filtered(shown, bessel(p[P.LAG_HZ]), rate_hz)
    if p[P.SKEW_AFT] or p[P.SKEW_FORE]:
        skews = p[[P.SKEW_AFT, P.SKEW_FORE]] * rate_hz
        straight = bool(p[P.SKEW_SHAPE] > 0.0)
        both = zip(shown, skews, strict=True)
        shown = np.array([delayed(row, skew, straight=straight) for row, skew in both])
    if p[P.HUM] == 0.0:
        return shown
    turn = 2.0 * math.pi * p[P.HUM_HZ] * times + p[P.HUM_PHASE]
    if p[P.HUM_SHAPE] > 0.0:  # half waves
        return np.asarray(shown + 2.0 * p[P.HUM] * np.maximum(np.sin(turn), 0.0))
    hum = p[P.HUM] * (np.sin(turn) + 0.2 * np.sin(3.0 * turn))
    return np.asarray(shown + hum)


def _noise(rig: Rig, run: Run, count: int, rng: np.random.Generator) -> FloatArray:
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
    out[3:5] *= run.loud
    if noise.wander_n > 0.0:
        keep = math.exp(-1.0 / (noise.wander_s * rig.sample_rate_hz))
        fresh, more = math.sqrt(1.0 - keep * keep), rng.standard_normal((2, count))
        more[:, 0] *= (1.0 - keep) / fresh  # at once as far off as ever after
        out[3:5] += noise.wander_n * np.array([recursive(row, keep, fresh, 0.0) for row in more])
    out[5] = noise.carriage_m_s * draws[5]
    return out


def _stepped(values: FloatArray, step: float) -> FloatArray:
    return np.asarray(np.round(values / step) * step)


def pulses(p: FloatArray, edges_s: FloatArray, rng: np.random.Generator) -> FloatArray:
    """Return the photocell's pulses: late, uneven, some of them missing."""
    if not len(edges_s):
        return edges_s
    scatter = rng.standard_normal(len(edges_s))
    if p[P.JITTER_SHAPE] > 0.0:
        scatter = math.sqrt(3.0) * rng.uniform(-1.0, 1.0, len(edges_s))
    scatter = p[P.JITTER] / max(p[P.OMEGA], 1e-9) * scatter
    seen = np.sort(edges_s + p[P.PULSE_DELAY] + scatter)
    if p[P.MISSED] > 0.0 and p[P.MISSED_SHAPE] > 0.0:
        seen = seen[rng.random(len(seen)) > 1.0 / max(p[P.MISSED], 2.0)]
    elif p[P.MISSED] > 0.0:
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
        channels[3:5] = _gauges(p, truth, times)
    channels[3:5] = _amplifiers(p, channels[3:5], times, rate)
    channels[1:3] *= p[[P.SCALE_AFT, P.SCALE_FORE], None]
    channels = channels[:, truth.before :]
    edges = pulses(p, truth.edges_s, np.random.default_rng(list(run.name.encode())))
    if rng is not None:
        channels = channels + _noise(rig, run, channels.shape[1], rng)
        channels[0] = _stepped(channels[0], rig.noise.step_rad)
        channels[3:5] = _stepped(channels[3:5], rig.noise.step_n)
        if rig.noise.step_m > 0.0:
            channels[1:3] = _stepped(channels[1:3], rig.noise.step_m)
        if rig.still_reads_zero and run.carriage_speed_m_s == 0.0:
            channels[5] = 0.0
    return Record(rate, channels, edges)


def record(p: FloatArray, run: Run, rig: Rig, rng: np.random.Generator | None = None) -> Record:
    """Return the record of a run, everything from the motor to the converter."""
    from tests.sealed.generator.mechanism import set_run

    return sense(set_run(p, run), happen(p, run, rig), run, rig, rng)
