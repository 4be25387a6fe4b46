"""How others get harmonics 1 to 3 out of a record, each as its own documentation says.

Every function takes samples, shape ``(channels, samples)``, of a motion that passes zero upwards at
the first sample, and returns ``[A0, S1, C1, ...]`` of each channel, shape ``(channels, 7)``; NaN
where the method gives no mean.
"""

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_ORDERS = (1, 2, 3)


def sine_and_cosine(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Take a sine and a cosine of every sample, for each channel and harmonic anew."""
    time_s = np.arange(samples.shape[1]) / rate_hz
    found = np.empty((len(samples), 7))
    for row, values in enumerate(samples):
        found[row, 0] = values.mean()
        for n in _ORDERS:
            found[row, 2 * n - 1] = 2.0 * np.mean(
                values * np.sin(2.0 * np.pi * n * frequency_hz * time_s)
            )
            found[row, 2 * n] = 2.0 * np.mean(
                values * np.cos(2.0 * np.pi * n * frequency_hz * time_s)
            )
    return found


def trigonometry_reused(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Take sines and cosines once for all channels."""
    theta = 2.0 * np.pi * frequency_hz * (np.arange(samples.shape[1]) / rate_hz)
    found = np.empty((len(samples), 7))
    found[:, 0] = samples.mean(axis=1)
    for n in _ORDERS:
        found[:, 2 * n - 1] = 2.0 * (samples @ np.sin(n * theta)) / len(theta)
        found[:, 2 * n] = 2.0 * (samples @ np.cos(n * theta)) / len(theta)
    return found


def nearest_bins(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Transform the whole run and read the nearest bins."""
    count = samples.shape[1]
    lines = np.fft.rfft(samples, axis=1) / count
    found = np.empty((len(samples), 7))
    found[:, 0] = lines[:, 0].real
    for n in _ORDERS:
        line = lines[:, round(n * frequency_hz * count / rate_hz)]
        found[:, 2 * n - 1], found[:, 2 * n] = -2.0 * line.imag, 2.0 * line.real
    return found


def curve_fit(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Fit mean, three harmonics and the frequency, eight parameters, with SciPy's defaults.

    The frequency starts 1e-4 off, the rest at zero.
    """
    from scipy import optimize

    time_s = np.arange(samples.shape[1]) / rate_hz

    def model(time_s: FloatArray, frequency: float, mean: float, *parts: float) -> FloatArray:
        total = np.full(len(time_s), mean)
        for n in _ORDERS:
            theta = 2.0 * np.pi * n * frequency * time_s
            total += parts[2 * n - 2] * np.sin(theta) + parts[2 * n - 1] * np.cos(theta)
        return total

    start = [frequency_hz * (1.0 + 1e-4), *np.zeros(7)]
    return np.array([optimize.curve_fit(model, time_s, row, p0=start)[0][1:] for row in samples])


def ulia(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Lock in to a cosine, each harmonic executed; average the middle as its manual does."""
    from ulia import ULIA

    count = samples.shape[1]
    reference = np.cos(2.0 * np.pi * frequency_hz * (np.arange(count) / rate_hz))
    found = np.full((len(samples), 7), np.nan)
    middle = slice(int(0.3 * count), int(0.9 * count))
    for row, values in enumerate(samples):
        lock_in = ULIA(count, rate_hz, 5.0 / frequency_hz, 2, 0.2)
        for n in _ORDERS:
            lock_in.load_data(reference, values)  # executing a harmonic overwrites the reference
            lock_in.execute(n)
            found[row, 2 * n - 1] = -2.0 * lock_in.y[middle].mean()
            found[row, 2 * n] = 2.0 * lock_in.x[middle].mean()
    return found


def rota_order(samples: FloatArray, rate_hz: float, frequency_hz: float) -> FloatArray:
    """Track three orders over eight revolutions; average the envelopes away from the ends."""
    from rota.extract import tracked_harmonics

    speed_rpm = np.full(samples.shape[1], 60.0 * frequency_hz)
    tracked = tracked_harmonics(samples.T, rate_hz, speed_rpm, _ORDERS, window_revs=8.0)
    away = int(8.0 * rate_hz / frequency_hz)
    envelope = tracked.envelopes[away : samples.shape[1] - away].mean(axis=0)
    found = np.full((samples.shape[0], 7), np.nan)
    found[:, 1::2], found[:, 2::2] = -envelope.imag.T, envelope.real.T
    return found
