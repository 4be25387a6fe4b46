"""Harmonics of a long gate under a Hann taper, for records with interference between harmonics.

A plain gate lets interference at x times the fundamental through as ``1 / (m |x - n|)``; a Hann
taper over its m periods as the inverse cube, for 1.5 times the variance in white noise. The
uncertainty comes from the lines beside each harmonic, two and more bins away, where the taper lets
nothing of the harmonics through: noise of any colour that is level across them is seen as it is.
"""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.estimate import fit_drift, gate_sums, harmonics_by_bins, no_drift
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.reference import PhaseReference
from analysis.resolver.sums import period_sums
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

MIN_PERIODS = 5
_FARTHEST_BIN = 8


def resolve_hann(
    recording: Recording,
    reference: PhaseReference,
    edges_cycles: FloatArray,
    harmonics: int,
    *,
    take_out_drift: bool = True,
) -> Harmonics:
    """Return the harmonics of the gate between the first edge and the last, under a Hann taper.

    Raises
    ------
    DataError
        With fewer than five periods, or with missing samples in the gate.
    """
    periods = len(edges_cycles) - 1
    if periods < MIN_PERIODS:
        raise DataError(
            f"{recording.name}: a Hann taper needs {MIN_PERIODS} periods or more, not {periods}"
        )
    harmonic_orders = np.arange(1.0, harmonics + 1.0)
    bins = noise_bins(periods)
    bin_orders = (harmonic_orders[:, None] + bins / periods).reshape(-1)
    low = bins[bins > 0] / periods
    orders = np.concatenate((harmonic_orders, bin_orders, low))

    def taper(cycles: FloatArray) -> FloatArray:
        turned = (cycles - edges_cycles[0]) / periods
        return np.asarray(1.0 - np.cos(2.0 * np.pi * turned))

    plain = period_sums(recording, reference, harmonics, edges_cycles=edges_cycles)
    sums = period_sums(recording, reference, orders, edges_cycles=edges_cycles, taper=taper)
    if not np.isfinite(sums.moment).all():
        raise DataError(f"{recording.name}: the gate has missing samples; a taper needs them all")
    drift = fit_drift(plain, plain) if take_out_drift else no_drift(plain)
    gram, moment = gate_sums(sums, drift.slope)
    size = 2 * harmonics + 1
    coefficients = np.asarray(np.linalg.solve(gram[:size, :size], moment[:, :size].T).T, np.float64)
    residuals = 2.0 * (moment - coefficients @ gram[:size]) / gram[0, 0]
    deviations, freedom = _from_bins(residuals[:, size:], harmonics, len(bins), len(low))
    return harmonics_by_bins(
        recording, plain, drift, coefficients, deviations, freedom, "Hann taper"
    )


def noise_bins(periods: int) -> FloatArray:
    """Bins, counted from a harmonic, whose lines measure the noise beside it.

    Every other one, for neighbours under a Hann taper are correlated (2/3; next but one 1/6), and
    no farther than half-way to the next harmonic.
    """
    reach = min(periods // 2, _FARTHEST_BIN)
    positive = np.arange(2.0, reach + 1.0, 2.0)
    return np.concatenate((-positive[::-1], positive))


def _from_bins(
    lines: FloatArray, harmonics: int, bins: int, low: int
) -> tuple[FloatArray, FloatArray]:
    """Deviations and degrees of freedom from the sine and cosine parts of the noise lines."""
    power = (lines**2).reshape(len(lines), -1, 2).mean(axis=2)
    line_power = power[:, : harmonics * bins].reshape(len(lines), harmonics, bins).mean(axis=2)
    variance = np.empty((len(lines), 2 * harmonics + 1))
    # A mean takes half the variance of a sine or cosine part.
    variance[:, 0] = power[:, harmonics * bins :].mean(axis=1) / 2.0
    variance[:, 1::2] = variance[:, 2::2] = line_power
    freedom = np.full(2 * harmonics + 1, 2.0 * bins)
    freedom[0] = 2.0 * low
    deviations = np.diag(np.sqrt(variance).ravel())
    return deviations.reshape(*variance.shape, -1), freedom
