"""One suspension's periods, and what follows from them: yaw, pitch or roll, depth."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.inertia.beats import BeatCount, count_beats
from analysis.inertia.bifilar import (
    resonance_flags,
    sway_period,
    yaw_from_beats,
    yaw_from_period,
    yaw_from_ratio,
)
from analysis.inertia.checks import check_sway_axis, check_yaw_axis
from analysis.inertia.double_pendulum import pitch_from_periods
from analysis.inertia.lengthening import bifilar_lengthening
from analysis.inertia.series import usable_part
from analysis.readers import read_recording
from analysis.readers.damage import check_whole
from analysis.uncertainty.estimate import Estimate, exactly
from analysis.uncertainty.monte_carlo import Assessment
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag
from pmm.inertia.air import without_air
from pmm.inertia.bifilar_tables import (
    BeatsTable,
    BifilarTable,
    PendulumTable,
    SuspensionTable,
    YawTable,
)
from pmm.inertia.channels import chosen_series
from pmm.inertia.lines import line_share, period_of_lines, pitch_off_lines, yaw_off_lines
from pmm.inertia.reading import Job
from pmm.inertia.sources import PeriodRuns, read_period
from pmm.inertia.stated_values import gravity_of, stated_value


@dataclass(frozen=True)
class SuspensionResult:
    """What one suspension gave.

    Attributes
    ----------
    yaw
        The yaw period, where it was measured.
    assessments
        Assessments by axis (or ``depth``), and for yaw by method too.
    """

    table: SuspensionTable
    yaw: Estimate | None
    assessments: dict[str, Assessment]
    periods: tuple[PeriodRuns, ...]
    flags: tuple[Flag, ...]


def hang(job: Job[BifilarTable], table: SuspensionTable) -> SuspensionResult:
    """Read all periods of a suspension and turn them into gyradii and depth.

    Raises
    ------
    ConfigurationError, DataError
        If a record does not carry what is asked, or shows another axis.
    """
    where = f'suspensions["{table.name}"]'
    assessments: dict[str, Assessment] = {}
    periods: list[PeriodRuns] = []
    flags: list[Flag] = []
    yaw, sway = None, None
    if table.sway is not None:
        runs = read_period(job, table.sway, f"{where}.sway")
        gravity = gravity_of(job.table).value
        check_sway_axis(f"{job.path.name}: {runs.where}", runs.period.value, table.line_m, gravity)
        periods.append(runs)
        sway = runs.period
    if table.yaw is not None:
        yaw, sway = _yaw(job, table.yaw, table, sway, assessments, periods, flags)
    if table.beats is not None:
        count = _beats(job, table.beats, f"{where}.beats")
        by_beats = yaw_from_beats(
            count,
            stated_value(table, "half_spacing_m", table.name),
            yaw_slower=table.beats.yaw_slower,
        )
        by_beats = yaw_off_lines(table, _share(job, table), by_beats, by_sway=True, seed=4)
        assessments["yaw by beats"] = without_air(job.table, by_beats, delayed="sway_coefficient")
    _double_pendulum(job, table, where, (yaw, sway), assessments, periods, flags)
    flags += [flag for runs in periods for flag in runs.flags]
    return SuspensionResult(table, yaw, assessments, tuple(periods), tuple(flags))


def _share(job: Job[BifilarTable], table: SuspensionTable) -> Estimate | None:
    return (
        line_share(table, stated_value(job.table.model, "mass_kg", "model"))
        if table.line_mass_kg
        else None
    )


def _beats(job: Job[BifilarTable], table: BeatsTable, where: str) -> BeatCount:
    """Return what was counted, or count it in the records, whose errors are alike."""
    if not table.records:
        return BeatCount(table.oscillations or 0.0, table.beats or 0.0, table.counting_error or 0.5)
    counts = []
    for name in table.records:
        recording = check_whole(
            read_recording(job.path_beside(name), job.columns, sample_rate_hz=table.sample_rate_hz)
        )
        series, _ = chosen_series(job, recording, table.channel, where)
        part = usable_part(series).series
        if not np.isfinite(part.values).all():
            raise DataError(f"{part.where}: beats are not counted over gaps; choose another record")
        counts.append(count_beats(part.time_s, part.values))
    return BeatCount(
        sum(count.oscillations for count in counts),
        sum(count.beats for count in counts),
        sum(count.counting_error for count in counts),
    )


def _yaw(
    job: Job[BifilarTable],
    source: YawTable,
    table: SuspensionTable,
    sway: Estimate | None,
    assessments: dict[str, Assessment],
    periods: list[PeriodRuns],
    flags: list[Flag],
) -> tuple[Estimate, Estimate | None]:
    """Yaw by its period and by the ratio; return the periods of yaw and, if known, of sway."""
    seed, where = job.table.monte_carlo_seed, f'suspensions["{table.name}"]'
    gravity, spacing = gravity_of(job.table), stated_value(table, "half_spacing_m", table.name)
    lengthens = bifilar_lengthening(table.half_spacing_m, table.line_m, gravity.value)
    runs = read_period(job, source, f"{where}.yaw", modes=source.oscillations, lengthens=lengthens)
    periods.append(runs)
    yaw, ratio = runs.period, None
    if source.oscillations == 2:
        place = _sway_mode(runs, table.line_m, gravity.value)
        measured_sway = runs.periods[place]
        check_sway_axis(
            f"{job.path.name}: {runs.where}", measured_sway.value, table.line_m, gravity.value
        )
        yaw, sway = runs.periods[1 - place], sway or measured_sway
        ratio = runs.ratio if place == 1 else _inverse(runs.ratio)
    flags += check_yaw_axis(runs.where, yaw.value, table.line_m, gravity.value)
    by_period = yaw_from_period(
        yaw, spacing, stated_value(table, "line_m", table.name), gravity, seed=seed
    )
    share = _share(job, table)
    by_period = yaw_off_lines(table, share, by_period, seed=seed + 4)
    assessments["yaw by period"] = without_air(job.table, by_period, seed=seed + 2)
    pair = (ratio, exactly(1.0)) if ratio is not None else (yaw, sway)
    if pair[1] is not None:
        by_ratio = yaw_from_ratio(pair[0], pair[1], spacing, seed=seed + 1)
        by_ratio = yaw_off_lines(table, share, by_ratio, by_sway=True, seed=seed + 5)
        assessments["yaw by ratio"] = without_air(
            job.table, by_ratio, delayed="sway_coefficient", seed=seed + 3
        )
    return yaw, sway


def _sway_mode(runs: PeriodRuns, line_m: float, gravity_m_s2: float) -> int:
    """Return which oscillation is sway: the one whose period is nearest to the lines'."""
    expected = sway_period(line_m, gravity_m_s2)
    off = [abs(math.log(period.value / expected)) for period in runs.periods]
    return off.index(min(off))


def _inverse(ratio: Estimate | None) -> Estimate | None:
    if ratio is None:
        return None
    return ratio.following(1.0 / ratio.value, -1.0 / ratio.value**2)


def _double_pendulum(
    job: Job[BifilarTable],
    table: SuspensionTable,
    where: str,
    yaw_and_sway: tuple[Estimate | None, Estimate | None],
    assessments: dict[str, Assessment],
    periods: list[PeriodRuns],
    flags: list[Flag],
) -> None:
    """Pitch (or roll) and depth, from both modes and the lines' own period.

    Parameters
    ----------
    yaw_and_sway
        Periods of yaw and sway, as far as they were measured.
    """
    yaw, sway = yaw_and_sway
    for axis in ("pitch", "roll"):
        source: PendulumTable | None = getattr(table, axis)
        if source is None:
            continue
        slow, fast = _two_periods(job, source, f"{where}.{axis}", periods)
        gravity = gravity_of(job.table)
        share, seed = _share(job, table), job.table.monte_carlo_seed + 20
        lines = sway or period_of_lines(stated_value(table, "line_m", table.name), gravity, share)
        result = pitch_from_periods(slow, fast, lines, gravity, seed=seed)
        result = pitch_off_lines(share, result, seed=seed + 2)
        assessments[axis], assessments["depth"] = result.gyradius, result.depth
        if axis == "pitch" and yaw is not None:
            flags += resonance_flags(yaw.value, slow.value)


def _two_periods(
    job: Job[BifilarTable], source: PendulumTable, where: str, periods: list[PeriodRuns]
) -> tuple[Estimate, Estimate]:
    if source.both is not None:
        runs = read_period(job, source.both, f"{where}.both", modes=2)
        periods.append(runs)
        return runs.periods[0], runs.periods[1]
    if source.slow is None or source.fast is None:
        raise ConfigurationError(f"{job.path}: {where} needs slow and fast, or both")
    slow = read_period(job, source.slow, f"{where}.slow")
    fast = read_period(job, source.fast, f"{where}.fast")
    periods += [slow, fast]
    return slow.period, fast.period
