"""Leakage of a vibration that is no harmonic through an estimator."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, resolve_by_bins
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.sums import period_sums
from analysis.resolver.weights import REACH
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError

_AT_ONCE = 16  # frequencies tried together


def boxcar_leakage(orders: FloatArray, periods: int, harmonics: int) -> FloatArray:
    """Worst leakage of a plain gate, in closed form: shape ``(orders, harmonics)``.

    ``|sinc(m (x - n))| + |sinc(m (x + n))|`` per unit of interference at x times the fundamental,
    for densely sampled signals; zero where ``x m`` is whole and x is not n.
    """
    n = np.arange(1, harmonics + 1)
    x = np.asarray(orders)[:, None]
    return np.asarray(np.abs(np.sinc(periods * (x - n))) + np.abs(np.sinc(periods * (x + n))))


def measured_leakage(
    recording: Recording,
    estimator: Callable[[Recording], Harmonics],
    frequencies_hz: FloatArray,
) -> FloatArray:
    """Worst leakage of an estimator as it is, by feeding it the interference.

    It is the amplitude that appears in each harmonic per unit of interference at its worst phase,
    shape ``(frequencies, harmonics)``.

    Parameters
    ----------
    recording
        Gives length and sampling; its samples are not used.
    estimator
        Resolves any recording of that length in the gate in question.
    frequencies_hz
        Of the interference, shape ``(frequencies,)``.
    """
    parts = [
        _respond(recording, estimator, frequencies_hz[k : k + _AT_ONCE])
        for k in range(0, len(frequencies_hz), _AT_ONCE)
    ]
    return np.concatenate(parts)


def _respond(
    recording: Recording, estimator: Callable[[Recording], Harmonics], frequencies_hz: FloatArray
) -> FloatArray:
    phase = 2.0 * np.pi * np.outer(frequencies_hz, recording.time_s())
    values = np.concatenate((np.sin(phase), np.cos(phase)))
    channels = tuple(Channel(f"interference_{k}") for k in range(len(values)))
    probe = replace(recording, name="interference", channels=channels, samples=values, flags=())
    result = estimator(probe)
    # Rows: in phase and quadrature; columns: a sine's and a cosine's.
    count = len(frequencies_hz)
    response = np.stack(
        (
            np.stack((result.in_phase[:count], result.in_phase[count:]), axis=-1),
            np.stack((result.quadrature[:count], result.quadrature[count:]), axis=-1),
        ),
        axis=-2,
    )
    return np.asarray(np.linalg.svd(response, compute_uv=False)[..., 0])


def let_through(analysis: Analysis, frequencies_hz: FloatArray) -> FloatArray:
    """Return how much of a vibration that is no harmonic leaks into each harmonic of a gate.

    Found by feeding the very gate of the first reading with them; see :func:`measured_leakage`.

    It is the part of the vibration's amplitude that appears in each harmonic at the worst phase,
    shape ``(frequencies, harmonics)``.

    Raises
    ------
    ConfigurationError
        If a frequency is not below half the sample rate.
    """
    nyquist_hz = analysis.recording.sample_rate_hz / 2.0
    if not np.all((frequencies_hz > 0.0) & (frequencies_hz < nyquist_hz)):
        raise ConfigurationError(
            f"a vibration's frequency must lie between 0 and {nyquist_hz:g} Hz, half the sample "
            "rate; faster ones appear at another frequency"
        )
    start = analysis.stretch.start
    gate = analysis.sums[start : start + analysis.readings[0].periods]
    reference, settings = analysis.reference, analysis.settings

    def estimator(probe: Recording) -> Harmonics:
        if settings.hann or settings.local_polynomials:
            return resolve_by_bins(probe, reference, gate, settings)
        edges = gate.edges_cycles
        sums = period_sums(probe, reference, settings.harmonics, edges_cycles=edges)
        return resolve(probe, sums, take_out_drift=settings.take_out_drift)

    beside_s = 2.0 * REACH / analysis.recording.sample_rate_hz
    probed = analysis.recording.between(gate.opened_s[0] - beside_s, gate.closed_s[-1] + beside_s)
    return measured_leakage(probed, estimator, frequencies_hz)
