"""A campaign's zero runs as the gap diagnosis wants them."""

from collections.abc import Sequence
from pathlib import Path

from analysis.gap.observe.at_rest import run_at_rest
from analysis.gap.observe.components import GapRun
from analysis.recording import Recording
from hardware.description.channels import DISPLACEMENTS
from hardware.description.errors import DataError, PmmError
from hardware.description.flags import Flag
from hardware.description.kinds import RunKind
from hardware.description.setpoint import Medium
from pmm.campaign.campaign import Campaign
from pmm.campaign.order import Clock, place_in
from pmm.campaign.recording_source import RecordingSource, open_recording
from pmm.campaign.runs import AtRest, Run


def records_at_rest(
    campaign: Campaign, folder: Path, sensors: Sequence[str] = (), clock: Clock | None = None
) -> tuple[tuple[GapRun, ...], dict[str, str], dict[str, tuple[Flag, ...]]]:
    """Read and observe the zero runs of a campaign.

    Other records at rest carry a load that is not the simulation's.

    The runs that can be used come first; then by name why the others cannot, and what is not what
    was written.

    Parameters
    ----------
    sensors
        Channels to use; all if empty.
    clock
        When all were made, if that is known.
    """
    runs: list[GapRun] = []
    left_out: dict[str, str] = {}
    damaged: dict[str, tuple[Flag, ...]] = {}
    for record in campaign.at_rest:
        if record.kind is not RunKind.ZERO:
            continue
        try:
            check_recorded_alike(record)
            recording = open_recording(RecordingSource.of(campaign, record, folder))
            damaged |= damage_of(record.name, recording)
            runs.append(_observed(campaign, record, recording, sensors, clock))
        except (PmmError, OSError) as error:
            left_out[record.name] = str(error).removeprefix(f"{record.name}: ")
    return tuple(runs), left_out, damaged


def check_recorded_alike(run: Run | AtRest) -> None:
    """Refuse what was recorded with another rig or model: one simulation stands for all runs.

    Raises
    ------
    DataError
        Naming what was another.
    """
    if run.recorded_with is not None:
        raise DataError(f"{run.name}: recorded with another rig or model: {'; '.join(run.differs)}")


def damage_of(name: str, recording: Recording) -> dict[str, tuple[Flag, ...]]:
    """Return what of a run's recording is not what was written, under its name, if anything."""
    flags = tuple(flag for flag in recording.flags if flag.damaged)
    return {name: flags} if flags else {}


def _observed(
    campaign: Campaign,
    record: AtRest,
    recording: Recording,
    sensors: Sequence[str],
    clock: Clock | None,
) -> GapRun:
    names = [name for name in recording.channel_names if not sensors or name in sensors]
    recording = recording.select(names)
    if not _place_matters_not(campaign, record, recording):
        raise DataError(
            f"no channel {' and '.join(DISPLACEMENTS)} tells where its struts stand, and the "
            "water pushes them back"
        )
    return run_at_rest(recording, place_in(campaign, record, clock), record.set_point)


def _place_matters_not(campaign: Campaign, record: AtRest, recording: Recording) -> bool:
    """Tell whether it is known where the struts stand, or makes no difference."""
    restored = record.medium is Medium.WATER and any(map(any, campaign.hull.restoring))
    return not restored or {*DISPLACEMENTS} <= {*recording.channel_names}
