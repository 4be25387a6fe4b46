"""Harmonics of a long gate under a Hann taper, for records with interference between harmonics.

A plain gate lets interference at x times the fundamental through as ``1 / (m |x - n|)``; a Hann
taper over its m periods as the inverse cube, for 1.5 times the variance in white noise. The
uncertainty comes from the lines beside each harmonic, two and more bins away, where the taper lets
nothing of the harmonics through: noise of any colour that is level across them is seen as it is.
That of the mean comes from the scatter between periods, as without a taper.
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
_COST = 1.5  # variance in white noise, over that of whole periods


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
    orders = np.concatenate((harmonic_orders, bin_orders))

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
    deviations, freedom = _from_bins(residuals[:, size:], len(bins))
    return harmonics_by_bins(
        recording, plain, drift, coefficients, deviations, freedom, "Hann taper", _COST
    )


def noise_bins(periods: int) -> FloatArray:
    """Bins, counted from a harmonic, whose lines measure the noise beside it.

    Every other one, for neighbours under a Hann taper are correlated (2/3; next but one 1/6), and
    no farther than half-way to the next harmonic.
    """
    reach = min(periods // 2, _FARTHEST_BIN)
    positive = np.arange(2.0, reach + 1.0, 2.0)
    return np.concatenate((-positive[::-1], positive))


def _from_bins(lines: FloatArray, bins: int) -> tuple[FloatArray, FloatArray]:
    """Deviations and degrees of freedom from the sine and cosine parts of the noise lines."""
    line_power = (lines**2).reshape(len(lines), -1, 2 * bins).mean(axis=2)
    variance = np.repeat(line_power, 2, axis=1)
    deviations = np.diag(np.sqrt(variance).ravel())
    return deviations.reshape(*variance.shape, -1), np.full(variance.shape[1], 2.0 * bins)
