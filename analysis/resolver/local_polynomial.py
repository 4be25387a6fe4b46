"""Harmonics of a gate without its transient, by local polynomials beside each of them.

Over m whole periods a periodic motion has lines at the harmonics alone. What stands in the bins
between them, at ``n + k / m`` times the fundamental, is noise and what the transient of a system
that had not settled leaks; the latter is smooth in frequency. A polynomial of the second degree
through the bins beside a harmonic tells the leak at the harmonic, which is taken off, and its
residuals tell the noise there, whatever its colour (Pintelon, Schoukens, System Identification,
2nd ed., 2012, chapter 7). The periods before the gate may so be fewer than a settled run needs.

The price is the leak's own uncertainty: the variance is ``1 + v`` times that of whole periods, with
``v`` from the polynomial's design (:func:`cost`).
"""

from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.estimate import fit_drift, gate_sums, harmonics_by_bins, no_drift
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference import PhaseReference
from analysis.resolver.sums import period_sums
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import DataError

MIN_PERIODS = 3
DEGREE = 2
"""Of the polynomial. At 1 a transient's curvature stays in; at 4 the variance of eight periods
grows from 1.18 to 1.31 times that of whole ones."""
FARTHEST_BIN = 8
"""To either side. At 4 the variance of long gates grows from 1.15 to 1.34 times that of whole
periods; at 16 it is 1.07, and noise and transients bend more over twice the band."""
_AT_ONCE = 8  # harmonics whose bins are summed together


@dataclass(frozen=True)
class _Local:
    """Phasors of the bins beside each harmonic, shape ``(channels, harmonics, bins)``."""

    bins: FloatArray
    phasors: ComplexArray


def resolve_local(
    recording: Recording,
    reference: PhaseReference,
    edges_cycles: FloatArray,
    harmonics: int,
    *,
    take_out_drift: bool = True,
) -> Harmonics:
    """Return the harmonics of the gate between the first edge and the last, its transient off.

    The mean and its uncertainty are those of whole periods: a transient stays in it.

    Raises
    ------
    DataError
        With fewer than three periods, or with missing samples in the gate.
    """
    periods = len(edges_cycles) - 1
    if periods < MIN_PERIODS:
        raise DataError(
            f"{recording.name}: local polynomials need {MIN_PERIODS} periods or more, not {periods}"
        )
    plain = period_sums(recording, reference, harmonics, edges_cycles=edges_cycles)
    if not np.isfinite(plain.moment).all():
        raise DataError(
            f"{recording.name}: the gate has missing samples; local polynomials need them all"
        )
    drift = fit_drift(plain, plain) if take_out_drift else no_drift(plain)
    gram, moment = gate_sums(plain, drift.slope)
    coefficients: FloatArray = np.linalg.solve(gram, moment.T).T.astype(np.float64)
    local = _local_residuals(recording, reference, edges_cycles, coefficients, drift.slope)
    leak, residuals = _leaks(local)
    coefficients[:, 1::2] -= leak.real
    coefficients[:, 2::2] -= leak.imag
    spare = len(local.bins) - DEGREE - 1
    freedom = np.full(2 * harmonics, 2.0 * spare)
    deviations = _deviations(residuals, cost(periods), spare)
    return harmonics_by_bins(
        recording, plain, drift, coefficients, deviations, freedom, "local polynomials", 1.0
    )


def bins_of(periods: int) -> FloatArray:
    """Return the bins beside a harmonic, counted from it: none as far as the next harmonic."""
    positive = np.arange(1.0, min(periods - 1, FARTHEST_BIN) + 1.0)
    return np.concatenate((-positive[::-1], positive))


def cost(periods: int) -> float:
    """Return how many times the variance of whole periods a harmonic has."""
    return 1.0 + float((_at_harmonic(bins_of(periods)) ** 2).sum())


def _at_harmonic(bins: FloatArray) -> FloatArray:
    """Weights of the bins in the polynomial's value at the harmonic."""
    return np.asarray(np.linalg.pinv(_powers(bins))[0])


def _powers(bins: FloatArray) -> FloatArray:
    return np.asarray((bins / np.abs(bins).max())[:, None] ** np.arange(DEGREE + 1))


def _local_residuals(
    recording: Recording,
    reference: PhaseReference,
    edges_cycles: FloatArray,
    coefficients: FloatArray,
    slope: FloatArray,
) -> _Local:
    """Return what the harmonics leave in the bins, their phase counted from the gate's opening."""
    periods, size = len(edges_cycles) - 1, coefficients.shape[1]
    harmonic_orders, bins = np.arange(1.0, (size - 1) // 2 + 1.0), bins_of(periods)
    turned = np.exp(2j * np.pi * bins / periods * edges_cycles[0])
    residuals = []
    for first in range(0, len(harmonic_orders), _AT_ONCE):
        bin_orders = (harmonic_orders[first : first + _AT_ONCE, None] + bins / periods).reshape(-1)
        orders = np.concatenate((harmonic_orders, bin_orders))
        sums = period_sums(recording, reference, orders, edges_cycles=edges_cycles)
        gram, moment = gate_sums(sums, slope)
        remainder = 2.0 * (moment - coefficients @ gram[:size])[:, size:] / gram[0, 0]
        phasors = remainder[:, 0::2] + 1j * remainder[:, 1::2]
        residuals.append(phasors.reshape(len(remainder), -1, len(bins)) * turned)
    return _Local(bins, np.concatenate(residuals, axis=1))


def _leaks(local: _Local) -> tuple[ComplexArray, ComplexArray]:
    """Return the leak at each harmonic, and what the polynomials leave in the bins."""
    powers = _powers(local.bins)
    fitted = local.phasors @ (powers @ np.linalg.pinv(powers)).T
    return local.phasors @ _at_harmonic(local.bins), local.phasors - fitted


def _deviations(residuals: ComplexArray, inflation: float, spare: int) -> FloatArray:
    """Return the deviates of the harmonics' parts: each harmonic's own, common to the channels.

    Noise at a harmonic is taken for circular.
    """
    channels, harmonics, _ = residuals.shape
    width = 2 * channels
    deviations = np.zeros((channels, 2 * harmonics, harmonics * width))
    scale = np.sqrt(inflation / (2.0 * spare))
    for n in range(harmonics):
        residual = residuals[:, n].T  # (bins, channels)
        parts = np.stack((residual, 1j * residual)).reshape(-1, channels) * scale
        flat = np.stack((parts.real, parts.imag), axis=-1).reshape(len(parts), width)
        root = np.asarray(np.linalg.qr(flat, mode="r")).T.reshape(channels, 2, -1)
        at = n * width
        deviations[:, 2 * n : 2 * n + 2, at : at + root.shape[-1]] = root
    return deviations
