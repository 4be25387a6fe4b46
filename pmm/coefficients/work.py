"""A campaign's recordings, sorted into what is to be done with each."""

from collections import Counter
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
from pmm.coefficients.tasks import MeasuringChain, Task

_BY_STEERING = "`pmm steering FOLDER` takes such runs"
_LAID = f"it oscillates with a laid rudder; {_BY_STEERING}"
_OTHER_RATE = f"its propeller turns at another rate than in most runs; {_BY_STEERING}"
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
    every: tuple[Run | AtRest, ...] = (*campaign.at_rest, *campaign.runs)
    rates = Counter(one.revolutions_hz for one in every if one.kind.oscillates or one.kind.towed)
    usual = rates.most_common(1)[0][0] if rates else 0.0
    for one in every:
        why = _why_not(one, leave_out)
        if why is None and one.kind is not RunKind.ZERO:
            why = _other_steering(one, usual, with_steering=with_steering)
        if why is not None:
            flags += [_left_out(one.name, why)] if why else []
            continue
        source = RecordingSource.of(campaign, one, folder.resolve())
        if not source.path.exists() and isinstance(one, Run) and one.file is None:
            missing.append(one.name)
            continue
        own = campaign.as_recorded(one.name)
        overtones = _OVERTONES * max((line.order for line in one.set_point.lines), default=0)
        task = Task(
            source,
            one.kind,
            own.oscillator or oscillator,
            _set_point(one),
            own.reference,
            replace(settings, harmonics=max(harmonics, overtones)),
            one.number,
            chain,
            (one.zero_before, one.zero_after),
            tared=campaign.tared,
            hashed=hashed,
            sensors=campaign.attitude,
            heel=campaign.heel,
            depth_m=None if campaign.water is None else campaign.water.depth_m,
        )
        kept = zeros if one.kind is RunKind.ZERO else dry if _is_dry(one) else runs
        kept.append(task)
    return Work(tuple(zeros), tuple(runs), tuple(dry), tuple(missing), tuple(flags))


def _other_steering(one: Run | AtRest, usual_hz: float, *, with_steering: bool) -> str | None:
    """Say why a run's rudder or propeller is not as it is wanted, as :func:`_why_not` does."""
    if with_steering:
        return None if one.rudder_angle_rad or one.revolutions_hz else _NO_STEERING
    if one.rudder_angle_rad and one.kind.oscillates:
        return _LAID
    return _OTHER_RATE if one.revolutions_hz != usual_hz else None


def _why_not(one: Run | AtRest, leave_out: Sequence[str]) -> str | None:
    """Say why a run is not used; without words where nobody expects it to be."""
    if one.name in leave_out:
        return "it was asked for"
    if one.outcome != COMPLETE:
        return f"its outcome is {one.outcome!r}"
    unused = one.kind is RunKind.KNOWN_MASS or (
        isinstance(one, AtRest) and one.kind is not RunKind.ZERO and not one.kind.towed
    )
    return "" if unused else None


def _left_out(name: str, why: str) -> Flag:
    return Flag("run_left_out", Severity.NOTE, f"left out: {why}", None, (name,))


def _is_dry(one: Run | AtRest) -> bool:
    return one.kind is RunKind.DRY or one.medium is Medium.AIR


def _set_point(one: Run | AtRest) -> SetPoint:
    if isinstance(one, AtRest):
        return one.set_point
    medium = Medium.AIR if _is_dry(one) else one.medium
    return replace(one.set_point, medium=medium)
