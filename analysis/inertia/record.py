"""From one record to its periods, and from several records to one period with its scatter.

series -> usable part -> one regime -> checks -> fit -> parts of it -> period at no amplitude

A decay that is left alone goes by ``dA/dt = -(c_0 + c_1 A + c_2 A^2)``: Coulomb friction, linear
and quadratic damping, none of them negative. With friction each half swing is exact about a middle
that lies ``c = c_0 pi/(2 omega)`` towards where it comes from. Its turning points keep time, but
its fundamental is late: over half a swing the middle adds ``4 c/pi`` in quadrature, of which an
amplitude that falls evenly explains ``c/pi``, so that the phase stays behind by

    3 c/(pi A) = 3 c_0/(2 omega A)

which grows as the swing dies: without it the period would seem longer the smaller the amplitude.
Linear damping delays evenly, and what quadratic damping does goes with the square of the amplitude.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.inertia.amplitude import (
    PowerDecay,
    ZeroAmplitude,
    amplitude_integral,
    fit_power_decay,
    zero_amplitude_period,
)
from analysis.inertia.checks import check_amplitude_effect, check_record
from analysis.inertia.damped_fit import DampedFit, fit_damped
from analysis.inertia.lengthening import Lengthening
from analysis.inertia.local_periods import LocalPeriods, local_periods
from analysis.inertia.regime import of_one_regime
from analysis.inertia.repeats import KnownScatter, RepeatedValue, combine_runs, single_run
from analysis.inertia.series import Series, UsablePart, usable_part
from analysis.uncertainty.estimate import Estimate
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_SURE: Final = 4.0  # standard uncertainties that friction has to be above none


@dataclass(frozen=True)
class OwnDecay:
    """Rates at which an amplitude falls: evenly, in proportion to itself, and to its square.

    Attributes
    ----------
    friction
        ``c_0``, in the record's unit per second.
    viscous_1_s
        ``c_1``.
    quadratic
        ``c_2``, per unit and second.
    """

    friction: float
    viscous_1_s: float
    quadratic: float

    def undamped(self, period_s: float) -> float:
        """Return the undamped period of a small swing: ``T / sqrt(1 + (c_1 T/(2 pi))^2)``."""
        return period_s / float(np.hypot(1.0, self.viscous_1_s * period_s / (2.0 * np.pi)))


def own_decay(local: LocalPeriods) -> OwnDecay:
    """Fit the amplitudes of a record's parts; friction is none where it is not seen for sure."""
    from scipy.optimize import nnls

    time, amplitude = local.time_s, local.amplitude
    size, duration = float(amplitude.max()), float(time[-1] - time[0])
    columns = [np.ones(time.size)]
    columns += [-amplitude_integral(time, amplitude, p) / size**p / duration for p in (1, 2)]
    columns += [-(time - time[0]) / duration]
    (smooth, smooth_residual), (solved, friction_residual) = (
        nnls(np.column_stack(columns[:count]), amplitude / size) for count in (3, 4)
    )
    if smooth_residual**2 - friction_residual**2 < _SURE**2 * friction_residual**2 / max(
        time.size - 4, 1
    ):
        solved = np.append(smooth, 0.0)
    _, viscous, quadratic, friction = (solved / duration).tolist()
    return OwnDecay(friction * size, viscous, quadratic / size)


def without_lag(local: LocalPeriods, decay: OwnDecay) -> LocalPeriods:
    """Return the phases and periods that the parts would have without friction."""
    omega = local.omega_rad_s
    late = 1.5 * decay.friction / (omega * local.amplitude)
    falls = decay.friction / local.amplitude + decay.viscous_1_s + decay.quadratic * local.amplitude
    return replace(
        local,
        phase_rad=local.phase_rad + late,
        period_s=2.0 * np.pi / (omega + late * falls),
    )


@dataclass(frozen=True)
class ModeAnalysis:
    """One oscillation of a record: how its period and decay change with amplitude.

    Attributes
    ----------
    local
        Its parts, without what friction does to their phases.
    decay, rates
        By a power of the amplitude, and by friction, linear and quadratic damping.
    """

    local: LocalPeriods
    at_no_amplitude: ZeroAmplitude
    decay: PowerDecay
    rates: OwnDecay


@dataclass(frozen=True)
class RecordAnalysis:
    """One record, analysed.

    Attributes
    ----------
    part
        What of it was used, and why.
    fit
        All oscillations at once, longest period first.
    modes
        Each of them along the record.
    flags
        Everything noticed on the way.
    """

    part: UsablePart
    fit: DampedFit
    modes: tuple[ModeAnalysis, ...]
    flags: tuple[Flag, ...]

    def period(self, mode: int = 0) -> Estimate:
        """Return a period at no amplitude with this record's own error; see :func:`from_runs`."""
        return self.modes[mode].at_no_amplitude.period


def analyse_record(
    series: Series, *, modes: int = 1, lengthens: Lengthening | None = None
) -> RecordAnalysis:
    """Find the usable part of a record, check it, fit it and follow it to no amplitude.

    Parameters
    ----------
    modes
        How many oscillations are in the record (2 for yaw with sway, or both pitch modes).
    lengthens
        How the period of a single oscillation lengthens with its angle by geometry. Of a channel in
        radians that is taken out, and degrees given as radians are told by it.

    Raises
    ------
    DataError
        If nothing swings, swings are too few, the record is aliased, angles are degrees, or the
        fit does not settle.
    """
    part = usable_part(series)
    flags = list(part.series.flags)
    if modes == 1:
        part, changed = of_one_regime(series, part)
        flags += changed
    flags += check_record(part)
    time_s, values = part.series.time_s, part.series.values
    fit = fit_damped(time_s, values, modes=modes, where=series.where)
    flags += fit.flags
    void = [flag for flag in fit.flags if flag.severity is Severity.VOID]
    if void:
        raise DataError(void[0].message)
    is_known = lengthens is not None and series.unit == "rad" and modes == 1
    known = lengthens(fit.modes[0].period_s) if is_known and lengthens is not None else ()
    analyses = []
    for mode in range(modes):
        local = local_periods(time_s, values, fit, mode=mode, where=series.where)
        flags += local.flags
        decay = fit_power_decay(local.time_s, local.amplitude)
        if not decay.converged:
            message = f"{series.where}: the decay of oscillation {mode + 1} could not be fitted"
            flags.append(Flag("decay_not_converged", Severity.WARNING, message, series.channel))
        rates = own_decay(local)
        lag_free = without_lag(local, rates)
        still = zero_amplitude_period(lag_free, known)
        analyses.append(ModeAnalysis(lag_free, still, decay, rates))
    if known:
        flags += check_amplitude_effect(series.where, analyses[0].local, known)
    return RecordAnalysis(part, fit, tuple(analyses), tuple(flags))


def from_runs(
    runs: Sequence[RecordAnalysis],
    mode: int = 0,
    *,
    known_scatter: KnownScatter | None = None,
    subject: str = "period",
) -> RepeatedValue:
    """Return the period of several releases with the scatter between them.

    One run alone rests on the scatter known from elsewhere or on that between its own parts, and is
    flagged.

    Raises
    ------
    DataError
        For no run.
    """
    if len(runs) == 1 and known_scatter is None:
        analysis = runs[0].modes[mode]
        return single_run(analysis.local, analysis.at_no_amplitude.period, subject=subject)
    return combine_runs(
        [run.period(mode) for run in runs],
        known_scatter=known_scatter,
        subject=subject,
        names=[run.part.series.name for run in runs],
    )


def damping_of(records: Sequence[RecordAnalysis]) -> Estimate:
    """Return the damping ratio of whole records, their mean; one alone has the scatter along it."""
    ratios = np.array([record.fit.modes[0].damping_ratio for record in records])
    if ratios.size > 1:
        spread = float(ratios.std(ddof=1)) / np.sqrt(ratios.size)
        return Estimate.of(float(ratios.mean()), float(spread), "1", float(ratios.size - 1))
    local, mode = records[0].modes[0].local, records[0].fit.modes[0]
    rates = -np.diff(np.log(local.amplitude)) / np.diff(local.time_s)
    local_ratios = rates * mode.period_s / (2.0 * np.pi)
    return Estimate.of(
        float(ratios[0]), float(local_ratios.std(ddof=1)), "1", float(local_ratios.size - 1)
    )
