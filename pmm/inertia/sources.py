"""Where a period comes from: records, light gates, a stopwatch, or a number."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analysis.inertia.gates import Passages, passages, read_gate_events
from analysis.inertia.lengthening import Lengthening, longer
from analysis.inertia.modulation import remove_modulation
from analysis.inertia.passage_fit import PassageFit, fit_passages
from analysis.inertia.record import RecordAnalysis, analyse_record, from_runs
from analysis.inertia.repeats import RepeatedValue, combine_runs
from analysis.inertia.series import Series
from analysis.inertia.stopwatch import stopwatch_period
from analysis.readers import read_recording
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from pmm.inertia.channels import chosen_series, true_angles
from pmm.inertia.period_source import PeriodSource
from pmm.inertia.reading import Job

_PARTS = 6  # of a single light gates' run
_WIDE_DEG = 10.0  # at which it is said what an amplitude does


@dataclass(frozen=True)
class PeriodRuns:
    """Periods of one set-up, with what they come from.

    Attributes
    ----------
    where
        Place in the job's file.
    how
        In words.
    periods
        Undamped, at no amplitude, longest first: one for each oscillation.
    single
        Each oscillation's period run by run, shape ``(oscillations, runs)``; empty where there are
        no runs.
    ratio
        Slow over fast period, where two oscillations are in each record.
    records, whole_records, gates
        What was analysed, for figures; ``whole`` is each record with what was not used of it.
    redundancy
        How repeated runs agree.
    """

    where: str
    how: str
    periods: tuple[Estimate, ...]
    single: tuple[tuple[float, ...], ...] = ()
    ratio: Estimate | None = None
    records: tuple[RecordAnalysis, ...] = ()
    whole_records: tuple[Series, ...] = ()
    gates: tuple[tuple[Passages, PassageFit], ...] = ()
    flags: tuple[Flag, ...] = ()
    redundancy: tuple[Redundancy, ...] = ()

    @property
    def period(self) -> Estimate:
        """The longest of the periods, s."""
        return self.periods[0]


def read_period(
    job: Job[Any],
    source: PeriodSource,
    where: str,
    *,
    modes: int = 1,
    lengthens: Lengthening | None = None,
) -> PeriodRuns:
    """Return the period of a source, with the scatter between its runs.

    Parameters
    ----------
    modes
        How many oscillations a record holds; light gates and stopwatches tell one.
    lengthens
        See :func:`analysis.inertia.record.analyse_record`.

    Raises
    ------
    ConfigurationError
        If a record's channel is not named, two oscillations are asked of what tells one, or an
        amplitude is stated where it is not known what it does.
    DataError
        If the data do not carry a period.
    """
    if source.records:
        return _from_records(job, source, where, modes, lengthens)
    if modes > 1:
        raise ConfigurationError(
            f"{job.path}: {where}: two oscillations need records of a displacement or an angle; "
            "give each period by itself"
        )
    if source.gates:
        return _from_gates(job, source, where, lengthens)
    if source.stopwatch:
        timed = stopwatch_period(
            source.stopwatch,
            reaction_s=source.reaction_s,
            known_scatter=source.known_scatter,
            subject=where,
        )
        small = _of_small_swings(job, timed, source, where, lengthens)
        how = f"stopwatch, {len(small.runs)} reading{'s' if len(small.runs) > 1 else ''}"
        return PeriodRuns(
            where, how, (small.estimate,), (small.runs,), flags=small.flags,
            redundancy=small.redundancy,
        )  # fmt: skip
    value = source.period_s if source.period_s is not None else 0.0
    freedom = source.period_degrees_of_freedom or float("inf")
    return PeriodRuns(where, "given", (Estimate.of(value, source.u_period_s, "s", freedom),))


def _of_small_swings(
    job: Job[Any],
    timed: RepeatedValue,
    source: PeriodSource,
    where: str,
    lengthens: Lengthening | None,
) -> RepeatedValue:
    """Return a mean period of some swings without what geometry does at the amplitude stated."""
    if lengthens is None:
        if source.amplitude_deg is not None:
            raise ConfigurationError(
                f"{job.path}: {where}.amplitude_deg: what an amplitude does to this period is not "
                "known; leave it out and count small swings, or take records"
            )
        return timed
    period = timed.estimate
    powers = lengthens(period.value)
    if source.amplitude_deg is None:
        per_cent = 100.0 * (float(longer(powers, np.array([math.radians(_WIDE_DEG)]))[0]) - 1.0)
        message = (
            f"{where}: the swings are taken for small ones; of {_WIDE_DEG:g} deg their period is "
            f"{per_cent:.2g} % long: state amplitude_deg, their mean amplitude"
        )
        flag = Flag("amplitude_unknown", Severity.NOTE, message)
        return replace(timed, flags=(*timed.flags, flag))
    stated = math.radians(source.amplitude_deg)
    off = math.radians(source.u_amplitude_deg)
    ratio, beyond = (float(longer(powers, np.array([size]))[0]) for size in (stated, stated + off))
    small = period.following(period.value / ratio, 1.0 / ratio)
    if off:
        small = small.widened(small.value * (beyond / ratio - 1.0))
    return replace(timed, estimate=small, runs=tuple(run / ratio for run in timed.runs))


def _from_records(
    job: Job[Any],
    source: PeriodSource,
    where: str,
    modes: int,
    lengthens: Lengthening | None,
) -> PeriodRuns:
    runs, all_series, flags = [], [], []
    for name in source.records:
        recording = read_recording(
            job.path_beside(name), job.columns, sample_rate_hz=source.sample_rate_hz
        )
        series, series_flags = chosen_series(job, recording, source.channel, where)
        if source.inclinometer_radius_m is not None:
            series, more = true_angles(job, series, source.inclinometer_radius_m, where)
            series_flags = (*series_flags, *more)
        run = analyse_record(series, modes=modes, lengthens=lengthens)
        runs.append(run)
        all_series.append(series)
        flags += [*series_flags, *run.flags]
    repeated = [_undamped(runs, mode, source, where) for mode in range(modes)]
    flags += [flag for joined in repeated for flag in joined.flags]
    return PeriodRuns(
        where,
        f"{len(runs)} record{'s' if len(runs) > 1 else ''}, {runs[0].part.series.channel}",
        tuple(joined.estimate for joined in repeated),
        tuple(joined.runs for joined in repeated),
        _ratio(runs, where) if modes == 2 else None,
        tuple(runs),
        tuple(all_series),
        flags=tuple(flags),
        redundancy=tuple(redundancy for joined in repeated for redundancy in joined.redundancy),
    )


def _undamped(
    runs: Sequence[RecordAnalysis], mode: int, source: PeriodSource, where: str
) -> RepeatedValue:
    """Join the runs' periods at no amplitude and take the damping of small swings out."""
    joined = from_runs(runs, mode, known_scatter=source.known_scatter, subject=where)
    period = joined.estimate.value
    factor = float(np.mean([run.modes[mode].rates.undamped(period) for run in runs])) / period
    estimate = joined.estimate.following(factor * joined.estimate.value, factor)
    return replace(joined, estimate=estimate, runs=tuple(factor * run for run in joined.runs))


def _ratio(runs: Sequence[RecordAnalysis], where: str) -> Estimate | None:
    """Slow over fast period, run by run: what both share (a drifting clock) drops out."""
    if len(runs) < 2:
        return None
    ratios = [
        derived("ratio", lambda slow, fast: slow / fast, slow=run.period(0), fast=run.period(1))
        for run in runs
    ]
    return combine_runs(ratios, subject=f"{where}, ratio").estimate


def _from_gates(
    job: Job[Any], source: PeriodSource, where: str, lengthens: Lengthening | None
) -> PeriodRuns:
    fits: list[tuple[Passages, PassageFit]] = []
    flags: list[Flag] = []
    for name in source.gates:
        path = job.path_beside(name)
        events = read_gate_events(path, time=source.time_column, gates=source.gate_columns)
        gate_passages = passages(events)
        fits.append((gate_passages, fit_passages(gate_passages)))
        flags += [*events.flags, *gate_passages.flags]
    periods = [
        _demodulated(gate_passages) if source.remove_modulation else fit.period
        for gate_passages, fit in fits
    ]
    if len(periods) == 1 and source.known_scatter is None:
        joined = _single_gate_run(*fits[0], periods[0], where)
    else:
        joined = combine_runs(
            periods, known_scatter=source.known_scatter, subject=where, names=source.gates
        )
    if source.remove_modulation:
        joined = _of_small_swings(job, joined, source, where, lengthens)
    how = f"light gates, {len(fits)} run{'s' if len(fits) > 1 else ''}"
    return PeriodRuns(
        where,
        how,
        (joined.estimate,),
        (joined.runs,),
        gates=tuple(fits),
        flags=(*flags, *joined.flags),
        redundancy=joined.redundancy,
    )


def _demodulated(gate_passages: Passages) -> Estimate:
    """Return the period of whole swings without their modulation."""
    number, time_s = gate_passages.number, gate_passages.time_s
    rows = number[2:] - number[:-2] == 2
    result = remove_modulation(time_s[1:-1][rows], (time_s[2:] - time_s[:-2])[rows])
    freedom = float(max(int(rows.sum()) - result.fit.covariance.shape[0], 1))
    return Estimate.of(result.period_s, result.uncertainty_s, "s", freedom)


def _single_gate_run(
    gate_passages: Passages, fit: PassageFit, period: Estimate, where: str
) -> RepeatedValue:
    """Let the scatter between a run's parts stand in for that between runs, undivided."""
    parts = np.array_split(np.arange(gate_passages.number.size), _PARTS)
    number, late_s = gate_passages.number, fit.residual_s
    slopes = [2.0 * np.polyfit(number[part], late_s[part], 1)[0] for part in parts]
    spread = float(np.std(slopes, ddof=1))
    estimate = period.widened(spread, float(_PARTS - 1))
    message = (
        f"{where}: one run only; the scatter between its {_PARTS} parts ({spread:.2g} s) stands in "
        "for that between runs: repeat the release, or give known_scatter_s"
    )
    flag = Flag("single_run", Severity.WARNING, message)
    return RepeatedValue(estimate, (period.value,), spread, (flag,))
