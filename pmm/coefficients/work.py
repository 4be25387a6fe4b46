"""A campaign's recordings, sorted into what is to be done with each."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from hardware.description.flags import Flag, Severity
from hardware.description.kinds import RunKind
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign import Campaign
from pmm.campaign.recording_source import COMPLETE, RecordingSource
from pmm.campaign.runs import AtRest, Run
from pmm.coefficients.steered_runs import usual_rate_hz, why_steered
from pmm.coefficients.tasks import MeasuringChain, Task

_NO_STEERING = (
    "it states neither rudder_angle_deg nor revolutions_hz in the campaign file; give them where a "
    "propeller turned or a rudder was there"
)

_OVERTONES: Final = 2
"""Of the highest line: what the products of lines make of angles and loads is resolved so far. At 1
the turning of the gauges is short of them: 2 % of a small coefficient at 7 degrees; at 3 the same
as at 2."""


@dataclass(frozen=True, eq=False)
class Work:
    """A campaign's recordings, sorted by what they are for.

    Attributes
    ----------
    zeros, runs, dry
        Records at rest without load; runs in water and tows; runs in air.
    not_recorded, left_out
        Names, and for the latter why.
    """

    zeros: tuple[Task, ...]
    runs: tuple[Task, ...]
    dry: tuple[Task, ...]
    not_recorded: tuple[str, ...]
    left_out: tuple[Flag, ...]


def work_of(
    campaign: Campaign,
    folder: Path,
    oscillator: Oscillator,
    chain: MeasuringChain,
    *,
    harmonics: int,
    leave_out: Sequence[str] = (),
    hashed: bool = False,
    with_steering: bool = False,
) -> Work:
    """Sort a campaign's runs and records at rest into tasks.

    Parameters
    ----------
    with_steering
        Whether all runs with a propeller or a rudder are wanted, and not those of the ship as it
        mostly ran.
    """
    settings = replace(campaign.analysis, harmonics=harmonics, gate_periods=None)
    zeros: list[Task] = []
    runs: list[Task] = []
    dry: list[Task] = []
    missing: list[str] = []
    flags: list[Flag] = []
    all_runs: tuple[Run | AtRest, ...] = (*campaign.at_rest, *campaign.runs)
    usual_hz = usual_rate_hz(all_runs)
    for run in all_runs:
        reason = _why_not(run, leave_out)
        if reason is None and run.kind is not RunKind.ZERO:
            reason = _other_steering(run, usual_hz, with_steering=with_steering)
        if reason is not None:
            flags += [_left_out(run.name, reason)] if reason else []
            continue
        source = RecordingSource.of(campaign, run, folder.resolve())
        if not source.path.exists() and isinstance(run, Run) and run.file is None:
            missing.append(run.name)
            continue
        recorded = campaign.as_recorded(run.name)
        overtones = _OVERTONES * max((line.order for line in run.set_point.lines), default=0)
        task = Task(
            source,
            run.kind,
            recorded.oscillator or oscillator,
            _set_point(run),
            recorded.reference,
            replace(settings, harmonics=max(harmonics, overtones)),
            run.number,
            chain,
            (run.zero_before, run.zero_after),
            tared=campaign.tared,
            hashed=hashed,
            sensors=campaign.attitude,
            heel=campaign.heel,
            depth_m=None if campaign.water is None else campaign.water.depth_m,
        )
        tasks = zeros if run.kind is RunKind.ZERO else dry if _is_dry(run) else runs
        tasks.append(task)
    return Work(tuple(zeros), tuple(runs), tuple(dry), tuple(missing), tuple(flags))


def _other_steering(run: Run | AtRest, usual_hz: float, *, with_steering: bool) -> str | None:
    """Say why a run's rudder or propeller is not as it is wanted, as :func:`_why_not` does."""
    if with_steering:
        return None if run.rudder_angle_rad or run.revolutions_hz else _NO_STEERING
    return why_steered(run, usual_hz)


def _why_not(run: Run | AtRest, leave_out: Sequence[str]) -> str | None:
    """Say why a run is not used; without words where nobody expects it to be."""
    if run.name in leave_out:
        return "it was asked for"
    if run.outcome != COMPLETE:
        return f"its outcome is {run.outcome!r}"
    unused = run.kind is RunKind.KNOWN_MASS or (
        isinstance(run, AtRest) and run.kind is not RunKind.ZERO and not run.kind.towed
    )
    return "" if unused else None


def _left_out(name: str, reason: str) -> Flag:
    return Flag("run_left_out", Severity.NOTE, f"left out: {reason}", None, (name,))


def _is_dry(run: Run | AtRest) -> bool:
    return run.kind is RunKind.DRY or run.medium is Medium.AIR


def _set_point(run: Run | AtRest) -> SetPoint:
    if isinstance(run, AtRest):
        return run.set_point
    medium = Medium.AIR if _is_dry(run) else run.medium
    return replace(run.set_point, medium=medium)
