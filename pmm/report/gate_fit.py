"""One gate of an analysis: its reading, its periods, and the curve that was fitted to it."""

import numpy as np

from analysis.resolver.analysis import Analysis
from analysis.resolver.basis import harmonic_basis
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.period_values import solve_periods, usable
from analysis.resolver.sums import PeriodSums
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from pmm.document.notation import counted

# What a window is called by how it was come by.
WINDOWS = {
    "found steady": "steady stretch",
    "given": "window given",
    "run's gate": "the run's own gate",
    "not steady": "all periods, not steady",
}


def reading_of(analysis: Analysis, reading_index: int) -> Harmonics:
    """Return one reading.

    Raises
    ------
    ConfigurationError
        If there is no such reading.
    """
    count = len(analysis.readings)
    if not 0 <= reading_index < count:
        raise ConfigurationError(
            f"{analysis.recording.name}: no reading {reading_index}; "
            f"it has {count}, numbered from 0 to {count - 1}"
        )
    return analysis.readings[reading_index]


def gate_sums(analysis: Analysis, reading: Harmonics) -> PeriodSums:
    """Return the periods of a reading's gate, those with missing samples included."""
    sums = analysis.sums
    slack = 1e-6 * (sums.closed_s[0] - sums.opened_s[0])
    inside = (sums.opened_s > reading.opened_s - slack) & (sums.closed_s < reading.closed_s + slack)
    return sums[np.asarray(inside)]


def fitted(analysis: Analysis, reading: Harmonics, time_s: FloatArray) -> FloatArray:
    """Return mean, harmonics and drift of a reading at some times, shape ``(channels, times)``."""
    gate = usable(gate_sums(analysis, reading))
    # The mean belongs to the middle of the periods that were used, from the first sample on.
    middle_s = np.linalg.solve(gate.gram.sum(axis=0), gate.ramp.sum(axis=0))[0]
    elapsed_s = time_s - analysis.recording.start_s - middle_s
    basis = harmonic_basis(analysis.reference.cycles_at(time_s), gate.orders)
    return np.asarray(reading.coefficients @ basis + np.outer(reading.drift_per_s, elapsed_s))


def single_periods(analysis: Analysis, reading: Harmonics) -> FloatArray:
    """Return ``(S_n, C_n)`` of each period of the gate, shape ``(periods, channels, N, 2)``.

    The drift that was taken out of the reading is taken out of them too; periods with missing
    samples are left out.
    """
    values = solve_periods(usable(gate_sums(analysis, reading)))
    steady = values.coefficients - reading.drift_per_s[:, None] * values.ramp[:, None, :]
    return steady[:, :, 1:].reshape(*steady.shape[:2], reading.order, 2)


def caption(reading: Harmonics) -> str:
    """Return where a gate lies, in words."""
    return (
        f"gate of {counted(reading.periods, 'period')}, {reading.opened_s:.3f} s to "
        f"{reading.closed_s:.3f} s, {reading.frequency_hz:.5g} Hz"
    )
