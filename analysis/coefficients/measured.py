"""From readings of the resolver to phasors of the struts, with the covariance across channels.

Both struts feel the same carriage and the same waves, so their scatter is not independent. A
reading's own covariance is by channel; from the sums of its periods the covariance of all channels
together follows in the same way. Where only the reading is at hand the channels are taken as
independent, and a flag says so.
"""

from collections.abc import Sequence

import numpy as np

from analysis.coefficients.phasors import Phasors, Source
from analysis.resolver.analyse import Analysis
from analysis.resolver.estimate import fit_drift, no_drift, scatter_of, usable
from analysis.resolver.harmonics import DriftSource, Harmonics
from analysis.resolver.sums import PeriodSums
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

MOTION_ASKED = Flag(
    "motion_from_set_point",
    Severity.NOTE,
    "no strut displacements were measured: the set-point's are used, without uncertainty; state "
    "those of amplitude, strut phase and the photocell's latency",
)


def joint_covariance(
    gate: PeriodSums, around: PeriodSums | None = None, *, take_out_drift: bool = True
) -> tuple[FloatArray, FloatArray]:
    """Return the covariance of all channels' coefficients together.

    As :func:`analysis.resolver.estimate.resolve` does by channel: the scatter between the periods
    about their drift, and what the drift's own slope leaves uncertain.

    Returns
    -------
    covariance
        Shape ``(channels, K, channels, K)``; NaN where there is but one period.
    degrees_of_freedom
        Shape ``(K,)``.
    """
    size = gate.period_count
    gate = usable(gate)
    stretch = gate if around is None or around.period_count == size else usable(around)
    drift = fit_drift(gate, stretch) if take_out_drift else no_drift(gate)
    scatter = scatter_of(gate, stretch, drift)
    covariance = np.einsum("pci,pdj->cidj", scatter.deviations, scatter.deviations)
    if drift.source is not DriftSource.NONE:
        covariance = covariance + _drift_part(gate, drift.variance, covariance)
    return covariance, scatter.degrees_of_freedom


def _drift_part(gate: PeriodSums, variance: FloatArray, scatter: FloatArray) -> FloatArray:
    """What the uncertain slopes add, correlated between channels as their means are."""
    gram, ramp = gate.gram.sum(axis=0), gate.ramp.sum(axis=0)
    time = np.linalg.solve(gram, ramp)
    time[0] = 0.0
    means = scatter[:, 0, :, 0]
    spread = np.sqrt(np.diagonal(means))
    with np.errstate(invalid="ignore", divide="ignore"):
        correlation = np.nan_to_num(means / np.outer(spread, spread))
    np.fill_diagonal(correlation, 1.0)
    slopes = correlation * np.sqrt(np.outer(variance, variance))
    return np.asarray(np.einsum("cd,i,j->cidj", slopes, time, time))


def reading_phasors(
    reading: Harmonics,
    names: Sequence[str],
    order: int = 1,
    joint: tuple[FloatArray, FloatArray] | None = None,
) -> Phasors:
    """Return the phasors of some channels of a reading.

    Parameters
    ----------
    order
        The harmonic; 0 gives the means as real numbers.
    joint
        Of :func:`joint_covariance`; without it the channels count as independent.

    Raises
    ------
    DataError
        If the reading has no such channel or harmonic.
    """
    missing = [name for name in names if name not in reading.channel_names]
    if missing or not 0 <= order <= reading.order:
        raise DataError(
            f"{reading.run}: no harmonic {order} of {', '.join(missing or names)}; resolved are "
            f"harmonics up to {reading.order} of {', '.join(reading.channel_names)}"
        )
    rows = [reading.channel_names.index(name) for name in names]
    parts = [2 * order - 1, 2 * order] if order else [0]
    values = reading.coefficients[np.ix_(rows, parts)]
    if joint is None:
        covariance = np.zeros((len(rows), len(parts), len(rows), len(parts)))
        for k, row in enumerate(rows):
            covariance[k, :, k, :] = reading.covariance[row][np.ix_(parts, parts)]
    else:
        covariance = joint[0][np.ix_(rows, parts, rows, parts)]
    full = np.zeros((len(rows), 2, len(rows), 2))
    full[:, : len(parts), :, : len(parts)] = covariance
    phasors = values[:, 0].astype(np.complex128)
    if order:
        phasors += 1j * values[:, 1]
    freedom = reading.degrees_of_freedom if joint is None else joint[1]
    size = 2 * len(rows)
    label = f"scatter of {reading.run}"
    source = Source(label, full.reshape(size, size), float(freedom[parts[0]]))
    return Phasors(tuple(names), tuple(reading.units[r] for r in rows), phasors, (source,))


def joint_of(
    analysis: Analysis, reading_index: int
) -> tuple[tuple[FloatArray, FloatArray] | None, tuple[Flag, ...]]:
    """Return the covariance of all channels of a reading, or ``None`` and a flag that says why."""
    if analysis.settings.hann:
        text = "tapered gates have no periods: the channels' scatter is taken as independent"
        return None, (Flag("channels_independent", Severity.NOTE, text),)
    size = analysis.readings[reading_index].periods
    steady = analysis.steady_sums
    gate = steady[reading_index * size : (reading_index + 1) * size]
    drifting = analysis.settings.take_out_drift
    return joint_covariance(gate, steady, take_out_drift=drifting), ()
