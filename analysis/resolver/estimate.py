"""From the sums of some periods to harmonics with their uncertainties.

The gate's harmonics solve the joint normal equations of its periods, so that they are exact for
any frequency, sampling and gate. A drift would leak ``-d / (n pi)`` per period into the in-phase
parts. A trend column in the same equations would cost: where harmonics beyond N are left out, they
leak through it. The drift is found instead from the periods' own means, in which harmonics
of every order cancel, and taken out before.

The uncertainty comes from the scatter between periods (Student's t), widened by what their sequence
shows of the noise's memory (:mod:`analysis.resolver.autocorrelation`); the residual's figure, white
only by assumption, is never used.
"""

from dataclasses import dataclass

import numpy as np

from analysis.recording import Recording
from analysis.resolver.autocorrelation import widened
from analysis.resolver.harmonics import DriftSource, Harmonics, IntervalSource
from analysis.resolver.period_values import PeriodValues, solve_periods, usable
from analysis.resolver.sums import PeriodSums
from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class GateScatter:
    """Uncertainty of a gate's coefficients from the scatter of a stretch's periods.

    Attributes
    ----------
    deviations
        Each period's deviations, scaled so that their products summed over the periods are the
        covariance of the gate's coefficients, also across channels, shape
        ``(periods, channels, K)``; NaN where there is but one period.
    degrees_of_freedom
        Shape ``(K,)``.
    widening
        How many times the noise's memory has widened them, shape ``(channels, K)``.
    """

    deviations: FloatArray
    degrees_of_freedom: FloatArray
    widening: FloatArray


@dataclass(frozen=True)
class Drift:
    """Slope of each channel per second and its variance, shapes ``(channels,)``."""

    slope: FloatArray
    variance: FloatArray
    source: DriftSource


def resolve(
    recording: Recording,
    gate: PeriodSums,
    *,
    around: PeriodSums | None = None,
    take_out_drift: bool = True,
    intervals: bool = True,
) -> Harmonics:
    """Return the harmonics of one gate.

    Parameters
    ----------
    recording
        Where the sums come from: names and units.
    gate
        The m periods of the gate.
    around
        The steady stretch in which the gate lies. Its periods give the scatter, and to a gate of
        one period the drift; by default the gate's own periods do.
    take_out_drift
        Whether a linear drift is taken out.
    intervals
        Whether the uncertainties are wanted; they take longer than all else.

    Raises
    ------
    DataError
        If every period has missing samples.
    """
    opened_s, closed_s, count = gate.opened_s[0], gate.closed_s[-1], gate.period_count
    gate = usable(gate)
    stretch = gate if around is None else usable(around)
    drift = fit_drift(gate, stretch) if take_out_drift else no_drift(gate)
    coefficients, ramp = _solve_gate(gate, drift.slope)
    scattered = stretch if intervals else stretch[:1]
    scatter = scatter_of(gate, scattered, drift)
    return Harmonics(
        run=recording.name,
        channel_names=gate.channel_names,
        units=tuple(recording.channels[recording.index(name)].unit for name in gate.channel_names),
        opened_s=float(opened_s),
        closed_s=float(closed_s),
        periods=count,
        coefficients=coefficients,
        deviations=_deviations(scatter, drift, ramp),
        degrees_of_freedom=scatter.degrees_of_freedom,
        widening=scatter.widening,
        drift_per_s=drift.slope,
        drift_source=drift.source,
        interval_source=_interval_source(gate, scattered),
    )


def gate_sums(sums: PeriodSums, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the normal equations of all periods, a drift about mid-gate taken off."""
    gram, moment, ramp = (part.sum(axis=0) for part in (sums.gram, sums.moment, sums.ramp))
    middle = ramp[0] / gram[0, 0]
    return gram, moment - np.outer(slope, ramp - middle * gram[:, 0])


def harmonics_by_bins(
    recording: Recording,
    plain: PeriodSums,
    drift: Drift,
    coefficients: FloatArray,
    deviations: FloatArray,
    degrees_of_freedom: FloatArray,
    estimator: str,
    mean_cost: float,
) -> Harmonics:
    """Return harmonics whose uncertainty comes from the bins beside them.

    That of the mean comes from the scatter of the periods' means and its memory: no bins near zero
    frequency show how noise rises towards it.

    Parameters
    ----------
    plain
        The periods of the gate.
    coefficients, estimator
        As in :class:`analysis.resolver.harmonics.Harmonics`.
    deviations, degrees_of_freedom
        Of the harmonics, shapes ``(channels, 2 N, k)`` and ``(2 N,)``.
    mean_cost
        Variance of the mean in white noise, over that of whole periods.
    """
    scatter = scatter_of(plain, plain, drift)
    means = np.asarray(np.linalg.qr(scatter.deviations[:, :, 0], mode="r")).T * np.sqrt(mean_cost)
    channels, size = coefficients.shape
    every = np.zeros((channels, size, means.shape[1] + deviations.shape[2]))
    every[:, 0, : means.shape[1]] = means
    every[:, 1:, means.shape[1] :] = deviations
    widening = np.ones_like(coefficients)
    widening[:, 0] = scatter.widening[:, 0]
    return Harmonics(
        run=recording.name,
        channel_names=recording.channel_names,
        units=tuple(channel.unit for channel in recording.channels),
        opened_s=float(plain.opened_s[0]),
        closed_s=float(plain.closed_s[-1]),
        periods=plain.period_count,
        coefficients=coefficients,
        deviations=every,
        degrees_of_freedom=np.append(scatter.degrees_of_freedom[:1], degrees_of_freedom),
        widening=widening,
        drift_per_s=drift.slope,
        drift_source=drift.source,
        interval_source=IntervalSource.BINS,
        estimator=estimator,
    )


def _interval_source(gate: PeriodSums, stretch: PeriodSums) -> IntervalSource:
    if stretch.period_count < 2:
        return IntervalSource.NONE
    same_count = stretch.period_count == gate.period_count
    return IntervalSource.PERIODS if same_count else IntervalSource.NEIGHBOURS


def _solve_gate(gate: PeriodSums, slope: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Solve all periods together; return coefficients and those of the time from mid-gate."""
    gram, ramp = gate.gram.sum(axis=0), gate.ramp.sum(axis=0)
    time = np.linalg.solve(gram, ramp)
    ramp = ramp - time[0] * gram[:, 0]
    moment = gate.moment.sum(axis=0) - np.outer(slope, ramp)
    time[0] = 0.0
    return np.linalg.solve(gram, moment.T).T, time


def no_drift(gate: PeriodSums) -> Drift:
    """A drift that is not taken out."""
    zero = np.zeros(len(gate.channel_names))
    return Drift(zero, zero, DriftSource.NONE)


def fit_drift(gate: PeriodSums, stretch: PeriodSums) -> Drift:
    """Fit a line through the means of the gate's periods; of its neighbours if it is but one.

    Parameters
    ----------
    stretch
        The periods around the gate, the gate's own among them.
    """
    source, chosen = DriftSource.GATE, gate
    if gate.period_count < 2:
        reach = 1.5 * (gate.closed_s[0] - gate.opened_s[0])  # the next period, not the next but one
        adjacent = np.abs(stretch.opened_s - gate.opened_s[0]) < reach
        source, chosen = DriftSource.NEIGHBOURS, stretch[adjacent]
    if chosen.period_count < 2:
        return no_drift(gate)
    values = solve_periods(chosen)
    slope, spread = _line(values)
    return Drift(slope, _mean_variance(_about_line(values, slope)) / spread, source)


def _line(values: PeriodValues) -> tuple[FloatArray, float]:
    """Slope of the means over time, and the sum of squares of the times."""
    time = values.ramp[:, 0] - values.ramp[:, 0].mean()
    spread = float(time @ time)
    return time @ values.coefficients[:, :, 0] / spread, spread


def _about_line(values: PeriodValues, slope: FloatArray) -> FloatArray:
    """What is left of each period's coefficients without drift and their own mean."""
    residuals = values.coefficients - slope[:, None] * values.ramp[:, None, :]
    return np.asarray(residuals - residuals.mean(axis=0))


def _scores(stretch: PeriodSums, slope: FloatArray) -> FloatArray:
    """What each period moves the stretch's own coefficients by, times the number of periods.

    Of even samples it is what :func:`_about_line` gives. A period that uneven samples tell badly
    counts as little here as it does in the joint solution.
    """
    count, gram = stretch.period_count, stretch.gram
    coefficients, _ = _solve_gate(stretch, slope)
    time = np.linalg.solve(gram.sum(axis=0), stretch.ramp.sum(axis=0))[0]
    drifted = slope[:, None] * (stretch.ramp - time * gram[:, 0])[:, None, :]
    residuals = stretch.moment - drifted - coefficients @ gram
    return np.asarray(
        np.linalg.solve(
            gram.sum(axis=0) / count, residuals.reshape(-1, gram.shape[-1]).T
        ).T.reshape(residuals.shape)
    )


def _mean_variance(residuals: FloatArray) -> FloatArray:
    """Variance of one period's mean about the line, shape ``(channels,)``."""
    if len(residuals) > 2:
        return np.asarray((residuals[:, :, 0] ** 2).sum(axis=0) / (len(residuals) - 2))
    # Two means always lie on a line; noise puts half a harmonic part's variance on a mean.
    return np.asarray((residuals[:, :, 1:] ** 2).sum(axis=0).mean(axis=1) / 2.0)


def scatter_of(gate: PeriodSums, stretch: PeriodSums, drift: Drift) -> GateScatter:
    """Return the scatter of a gate's coefficients from the periods of the stretch around it."""
    values = solve_periods(stretch)
    count, channels, size = values.coefficients.shape
    freedom = np.full(size, max(count - 1.0, 0.0))
    if count < 2:
        no_deviations = np.full((count, channels, size), np.nan)
        return GateScatter(no_deviations, freedom, np.ones((channels, size)))
    drifting = drift.source is not DriftSource.NONE
    slope = _line(values)[0] if drifting else np.zeros(channels)
    residuals = _scores(stretch, slope) if stretch.uneven else _about_line(values, slope)
    if drifting:
        freedom[0] = count - 2.0
    wider = widened(residuals, stretch.opened_cycle, gate.period_count, drifting)
    squares, wider_squares = (residuals**2).sum(axis=0), (wider**2).sum(axis=0)
    ratio = np.divide(wider_squares, squares, out=np.ones_like(squares), where=squares > 0.0)
    divisor = np.where(freedom > 0.0, freedom, np.nan) * gate.period_count
    return GateScatter(wider / np.sqrt(divisor), freedom, np.sqrt(ratio))


def _deviations(scatter: GateScatter, drift: Drift, ramp: FloatArray) -> FloatArray:
    """Return what moves all channels' coefficients: the periods' scatter, and the drift's slopes.

    The slopes are correlated between channels as their means are.

    The result has the shape ``(channels, K, k)``, with no more deviates than there are
    coefficients.
    """
    periods, channels, size = scatter.deviations.shape
    flat = scatter.deviations.reshape(periods, -1)
    if drift.source is not DriftSource.NONE:
        slopes = np.sqrt(drift.variance)[:, None] * directions(scatter.deviations[:, :, 0])
        by_slope = np.einsum("cd,i->dci", slopes, ramp).reshape(-1, channels * size)
        flat = np.concatenate((flat, by_slope))
    if len(flat) > flat.shape[1]:
        flat = np.asarray(np.linalg.qr(flat, mode="r"))
    return np.asarray(flat.reshape(-1, channels, size).transpose(1, 2, 0))


def directions(means: FloatArray) -> FloatArray:
    """Return channels' shares in deviates that correlate as some means do, ``(channels, k)``.

    A channel whose means show no scatter has a deviate of its own.
    """
    spread = np.linalg.norm(means, axis=0)
    scattered = spread > 0.0
    shares = np.divide(means, spread, out=np.zeros_like(means), where=scattered)
    return np.concatenate((shares, np.diag(~scattered))).T
