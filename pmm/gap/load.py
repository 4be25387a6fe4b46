"""A campaign's folder as the gap diagnosis wants it."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from analysis.gap.observe.components import GapRun
from analysis.gap.observe.following import Following, following
from analysis.gap.observe.observation import Observed, observe
from analysis.gap.observe.sensors import as_recorded, resolved
from analysis.recording import Recording
from hardware.description.channels import COMMANDS
from hardware.description.errors import ConfigurationError, DataError, PmmError
from hardware.description.flags import Flag
from hardware.description.oscillator import Range
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.order import place_in
from pmm.campaign.recording_source import RecordingSource, open_recording
from pmm.campaign.runs import Run
from pmm.configuration import read_toml
from pmm.gap.at_rest import check_recorded_alike, damage_of, records_at_rest
from pmm.gap.cut_short import cut_short
from sim.rig import SimulatedRig

_Read = tuple[Run, Observed, Following]
_SHORT: Final = 200_000  # values of a recording, 1.6 MB: read whole
_ABOVE: Final = 1.2  # of the oscillator's largest frequency and eccentricity


@dataclass(frozen=True, eq=False)
class Loaded:
    """A campaign, read and observed.

    Attributes
    ----------
    left_out
        Runs that could not be used, by name, with the reason.
    at_rest
        The campaign's zero runs.
    reference_channel
        The channel whose fundamental is phase 0; ``None`` with a photocell.
    cut_short
        Runs of which many periods are not used, or some for want of samples, by name, with the
        reason.
    damaged
        What is not what was written, by run.
    """

    campaign: Campaign
    rig: SimulatedRig
    runs: tuple[GapRun, ...]
    left_out: dict[str, str]
    reference_channel: str | None
    at_rest: tuple[GapRun, ...] = ()
    cut_short: dict[str, str] = field(default_factory=dict)
    damaged: dict[str, tuple[Flag, ...]] = field(default_factory=dict)


def load_campaign(
    path: Path,
    withheld: Sequence[str] = (),
    progress: Callable[[str], None] = lambda _: None,
    sensors: Sequence[str] = (),
) -> Loaded:
    """Read and observe the runs of a campaign that oscillate, and its zero runs.

    Parameters
    ----------
    path
        The folder, or its ``campaign.toml``.
    withheld
        Runs that are left out, by name: nobody looks at them.
    sensors
        Channels to use, ``"photocell"`` among them; all if empty.

    Raises
    ------
    ConfigurationError
        If the campaign does not say what the simulation needs.
    """
    path = path / CAMPAIGN_FILE if path.is_dir() else path
    campaign = campaign_of(path)
    rig = unlimited(campaign.rig())
    left_out: dict[str, str] = {}
    damaged: dict[str, tuple[Flag, ...]] = {}
    found: list[_Read] = []
    unlike: dict[str, str] = {}
    for run in campaign.runs:
        if run.name in withheld or not run.frequency_hz > 0.0:
            continue
        progress(run.name)
        try:
            check_recorded_alike(run)
            _check_single(run)
            recording = _at_once(open_recording(RecordingSource.of(campaign, run, path.parent)))
            damaged |= damage_of(run.name, recording)
            observed = observe(_only(recording, sensors), campaign.reference, campaign.analysis)
            followed, unlike[run.name] = _followed(recording)
            found.append((run, observed, followed))
        except (PmmError, OSError) as error:
            left_out[run.name] = str(error).removeprefix(f"{run.name}: ")
    reference = _usual_reference(found)
    for run, one, _ in found:
        if one.reference_channel != reference:
            own = one.reference_channel or "the photocell"
            left_out[run.name] = f"its phase comes from {own}, not as in most runs"
    kept = [three for three in found if three[0].name not in left_out]
    runs = tuple(_gap_runs(campaign, kept))
    at_rest, unused, harmed = records_at_rest(campaign, path.parent, sensors)
    cut = {run.name: said for run, one, _ in kept if (said := cut_short(one.analysis))}
    rig = as_recorded(rig, (*runs, *at_rest), reference)
    known, still = resolved(rig, (*runs, *at_rest))
    usable, usable_at_rest = known[: len(runs)], known[len(runs) :]
    return Loaded(
        campaign, rig, usable, left_out | unused, reference, usable_at_rest,
        _by_name(cut, still, unlike), damaged | harmed,
    )  # fmt: skip


def _by_name(*notes: Mapping[str, str]) -> dict[str, str]:
    """Return what some notes on runs say of each, in one text."""
    names = dict.fromkeys(name for some in notes for name, said in some.items() if said)
    return {name: "; ".join(filter(None, (one.get(name) for one in notes))) for name in names}


def _check_single(run: Run) -> None:
    if run.lines:
        raise DataError(
            f"{run.name}: moved at {len(run.lines)} frequencies at once, a diagnosis compares runs "
            "of one; pmm coefficients takes it"
        )


def campaign_of(path: Path) -> Campaign:
    """Read a campaign's file; that of a pendulum is said to be one.

    Raises
    ------
    ConfigurationError
        If it is no campaign.
    """
    keys = read_toml(path).keys()
    if "runs" not in keys and keys & {"measured", "suspensions"}:
        raise ConfigurationError(
            f"{path} describes a pendulum or a free decay, no campaign: see pmm gap pendulum and "
            "pmm gap add-pendulum"
        )
    return read_campaign(path)


def unlimited(rig: SimulatedRig) -> SimulatedRig:
    """Return a rig that refuses no run that was made: settings are off by a tolerance.

    A run at the oscillator's highest frequency has to be simulated a little above it too.
    """
    own = rig.oscillator
    frequency_hz, eccentricity_m = (
        Range(0.0, _ABOVE * one.high) for one in (own.frequency_hz, own.eccentricity_m)
    )
    free = replace(
        own,
        frequency_hz=frequency_hz,
        eccentricity_m=eccentricity_m,
        force_per_strut_n=math.inf,
    )
    return replace(rig, oscillator=free)


def _followed(recording: Recording) -> tuple[Following, str]:
    """Compare struts with their commands; say what needs samples on a grid and is left out."""
    if recording.stamps_s is None:
        return following(recording)
    told = ", no commands with positions" if {*COMMANDS} & {*recording.channel_names} else ""
    return {}, f"uneven time stamps: only means and harmonics are compared{told}"


def _usual_reference(found: Sequence[_Read]) -> str | None:
    """Return the reference that most runs have: phases from different ones cannot be compared."""
    references = [one.reference_channel for _, one, _ in found]
    return max(references, key=references.count) if references else None


def _at_once(recording: Recording) -> Recording:
    """Return a short recording with its samples read: else its file is opened for each channel."""
    count = recording.sample_count
    if count * len(recording.channels) > _SHORT:
        return recording
    return replace(recording, samples=recording.samples[:, 0:count])


def _only(recording: Recording, sensors: Sequence[str]) -> Recording:
    if not sensors:
        return recording
    edges = recording.photocell_edges_s if "photocell" in sensors else None
    names = [one for one in recording.channel_names if one in sensors]
    return replace(recording.select(names), photocell_edges_s=edges)


def _gap_runs(campaign: Campaign, found: Sequence[_Read]) -> Iterator[GapRun]:
    for run, one, followed in found:
        yield GapRun(
            run.name,
            run.set_point,
            place_in(campaign, run),
            one.observation,
            one.analysis.stretch.period_count,
            one.analysis.recording.sample_rate_hz,
            one.lead_s,
            following=followed,
        )
