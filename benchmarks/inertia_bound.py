"""The scatter of fitted periods over the least that noise allows: the Cramer-Rao bound."""

from collections.abc import Sequence

import numpy as np

from analysis.inertia.damped_fit import DampedMode, fit_damped
from benchmarks.inertia_campaigns import series_of
from hardware.description.arrays import FloatArray
from sim.pendulum.effects import make_effect
from sim.pendulum.simulation import simulate_swing


def period_bounds(time_s: FloatArray, modes: Sequence[DampedMode], noise_rms: float) -> FloatArray:
    """Return the least standard deviation of each period, shape ``(modes,)``.

    By the Fisher information of all modes' periods, decays, amplitudes and phases and an offset, in
    white noise.
    """
    t = time_s - time_s[0]
    slopes = [np.ones(t.size)]
    for one in modes:
        angle = 2.0 * np.pi * t / one.period_s + one.phase_rad
        fall = np.exp(-one.decay_1_s * t)
        cosine, sine = fall * np.cos(angle), fall * np.sin(angle)
        size = one.amplitude
        slopes += [size * sine * 2.0 * np.pi * t / one.period_s**2]
        slopes += [-t * size * cosine, cosine, -size * sine]
    information = np.stack(slopes) @ np.stack(slopes).T / noise_rms**2
    return np.asarray(np.sqrt(np.diag(np.linalg.inv(information))[1::4]))


def bound_ratio(records: int, seed: int) -> float:
    """Return the scatter of the period of simulated swings over its bound.

    One swing, viscous damping, the noise new in each record.
    """
    damping = make_effect("viscous_damping", damping_ratio=0.004)
    body = {"upper_pivot": True, "duration_s": 60.0, "sample_rate_hz": 10.0}
    clean = series_of(simulate_swing(effects=[damping], seed=seed, **body), "angle")
    truth = fit_damped(clean.time_s, clean.values).modes
    return _ratio(clean.time_s, clean.values, truth, 2e-4, records, seed)


def bound_ratio_two(records: int, seed: int) -> float:
    """Return the same of two oscillations in one record, the larger of both ratios.

    Yaw of 4.39 s and sway of 3.83 s over 160 s at 32 Hz, so that the starts come from a thinned
    record; the noise is a hundredth of the larger.
    """
    truth = (DampedMode(4.39, 0.0048, 0.02, 0.3), DampedMode(3.83, 0.0081, 0.01, -1.0))
    t = np.arange(0.0, 160.0, 1.0 / 32.0)
    clean = np.zeros(t.size)
    for one in truth:
        wave = np.cos(2.0 * np.pi * t / one.period_s + one.phase_rad)
        clean += one.amplitude * np.exp(-one.decay_1_s * t) * wave
    return _ratio(t, clean, truth, 2e-4, records, seed)


def _ratio(
    time_s: FloatArray,
    clean: FloatArray,
    truth: Sequence[DampedMode],
    noise_rms: float,
    records: int,
    seed: int,
) -> float:
    generator = np.random.default_rng(seed)
    found = []
    for _ in range(records):
        values = clean + noise_rms * generator.standard_normal(time_s.size)
        fit = fit_damped(time_s, values, modes=len(truth))
        found.append([one.period_s for one in fit.modes])
    scatter = np.std(found, axis=0, ddof=1)
    return float(np.max(scatter / period_bounds(time_s, truth, noise_rms)))
