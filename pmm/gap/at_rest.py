"""A campaign's zero runs as the gap diagnosis wants them."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from analysis.gap.at_rest import run_at_rest
from analysis.gap.components import GapRun
from analysis.gap.observe import STRUTS
from analysis.readers import read_recording
from analysis.recording import Recording
from hardware.description.errors import DataError, PmmError
from hardware.description.setpoint import Medium
from pmm.calibrated import calibrated
from pmm.campaign import AtRest, Campaign
from pmm.campaign_order import place_in
from pmm.coefficients.reading import gated
from pmm.plan.kinds import RunKind


def records_at_rest(
    campaign: Campaign, folder: Path, sensors: Sequence[str] = ()
) -> tuple[tuple[GapRun, ...], dict[str, str]]:
    """Read and observe the zero runs of a campaign.

    Other records at rest carry a load that is not the simulation's.

    Parameters
    ----------
    sensors
        Channels to use; all if empty.

    Returns
    -------
    tuple
        Those that can be used, and by name why the others cannot.
    """
    found: list[GapRun] = []
    left_out: dict[str, str] = {}
    for one in campaign.at_rest:
        if one.kind is not RunKind.ZERO:
            continue
        try:
            found.append(_observed(campaign, one, folder, sensors))
        except (PmmError, OSError) as error:
            left_out[one.name] = str(error)
    return tuple(found), left_out


def _observed(campaign: Campaign, one: AtRest, folder: Path, sensors: Sequence[str]) -> GapRun:
    if one.outcome != "complete":
        raise DataError(f"its outcome is {one.outcome!r}")
    path = one.recording_path(folder)
    recording = gated(calibrated(read_recording(path, campaign.columns)), path)
    names = [name for name in recording.channel_names if not sensors or name in sensors]
    recording = replace(recording.select(names), name=one.name)
    if not _place_matters_not(campaign, one, recording):
        raise DataError(
            f"no channel {' and '.join(STRUTS)} tells where its struts stand, and the water pushes "
            "them back"
        )
    return run_at_rest(recording, place_in(campaign, one), one.carriage_speed_m_s, one.medium)


def _place_matters_not(campaign: Campaign, one: AtRest, recording: Recording) -> bool:
    """Tell whether it is known where the struts stand, or makes no difference."""
    restored = one.medium is Medium.WATER and any(map(any, campaign.hull.restoring))
    return not restored or {*STRUTS} <= {*recording.channel_names}
