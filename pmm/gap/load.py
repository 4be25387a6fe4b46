"""A campaign's folder as the gap diagnosis wants it."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final

from analysis.gap.observe.components import GapRun
from analysis.gap.observe.following import Following, following
from analysis.gap.observe.observation import Observed, observe
from analysis.gap.observe.sensors import as_recorded, with_resolution
from analysis.recording import Recording
from hardware.description.channels import COMMANDS
from hardware.description.errors import ConfigurationError, DataError, PmmError
from hardware.description.flags import Flag
from hardware.description.oscillator import Range
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.clock import clock_of
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.order import Clock, place_in
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
class LoadedCampaign:
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
) -> LoadedCampaign:
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
    readings: list[_Read] = []
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
            observed = observe(
                _sensors_alone(recording, sensors), campaign.reference, campaign.analysis
            )
            followed, unlike[run.name] = _followed(recording)
            readings.append((run, observed, followed))
        except (PmmError, OSError) as error:
            left_out[run.name] = str(error).removeprefix(f"{run.name}: ")
    reference = _usual_reference(readings)
    for run, observed_run, _ in readings:
        if observed_run.reference_channel != reference:
            channel = observed_run.reference_channel or "the photocell"
            left_out[run.name] = f"its phase comes from {channel}, not as in most runs"
    used_readings = [reading for reading in readings if reading[0].name not in left_out]
    clock = clock_of(campaign, path.parent)
    runs = tuple(_gap_runs(campaign, used_readings, clock))
    at_rest, unused, harmed = records_at_rest(campaign, path.parent, sensors, clock)
    cut = {
        run.name: said
        for run, observed_run, _ in used_readings
        if (said := cut_short(observed_run.analysis))
    }
    rig = as_recorded(rig, (*runs, *at_rest), reference)
    resolved_runs, still = with_resolution(rig, (*runs, *at_rest))
    usable, usable_at_rest = resolved_runs[: len(runs)], resolved_runs[len(runs) :]
    return LoadedCampaign(
        campaign, rig, usable, left_out | unused, reference, usable_at_rest,
        _by_name(cut, still, unlike), damaged | harmed,
    )  # fmt: skip


def _by_name(*notes: Mapping[str, str]) -> dict[str, str]:
    """Return what some notes on runs say of each, in one text."""
    names = dict.fromkeys(name for note in notes for name, said in note.items() if said)
    return {name: "; ".join(filter(None, (note.get(name) for note in notes))) for name in names}


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
    if "runs" not in keys and keys & {"measured", "suspensions", "forced"}:
        raise ConfigurationError(
            f"{path} describes a pendulum or a free decay, no campaign: see pmm gap pendulum and "
            "pmm gap add-pendulum"
        )
    return read_campaign(path)


def unlimited(rig: SimulatedRig) -> SimulatedRig:
    """Return a rig that refuses no run that was made: settings are off by a tolerance.

    A run at the oscillator's highest frequency has to be simulated a little above it too.
    """
    oscillator = rig.oscillator
    frequency_hz, eccentricity_m = (
        Range(0.0, _ABOVE * span.high)
        for span in (oscillator.frequency_hz, oscillator.eccentricity_m)
    )
    free = replace(
        oscillator,
        frequency_hz=frequency_hz,
        eccentricity_m=eccentricity_m,
        force_per_strut_n=math.inf,
    )
    return replace(rig, oscillator=free)


def _followed(recording: Recording) -> tuple[Following, str]:
    """Compare struts with their commands; say what needs samples on a grid and is left out."""
    if recording.stamps_s is None:
        return following(recording)
    note = ", no commands with positions" if {*COMMANDS} & {*recording.channel_names} else ""
    return {}, f"uneven time stamps: only means and harmonics are compared{note}"


def _usual_reference(readings: Sequence[_Read]) -> str | None:
    """Return the reference that most runs have: phases from different ones cannot be compared."""
    references = [observed.reference_channel for _, observed, _ in readings]
    return max(references, key=references.count) if references else None


def _at_once(recording: Recording) -> Recording:
    """Return a short recording with its samples read: else its file is opened for each channel."""
    count = recording.sample_count
    if count * len(recording.channels) > _SHORT:
        return recording
    return replace(recording, samples=recording.samples[:, 0:count])


def _sensors_alone(recording: Recording, sensors: Sequence[str]) -> Recording:
    if not sensors:
        return recording
    edges = recording.photocell_edges_s if "photocell" in sensors else None
    names = [name for name in recording.channel_names if name in sensors]
    return replace(recording.select(names), photocell_edges_s=edges)


def _gap_runs(campaign: Campaign, readings: Sequence[_Read], clock: Clock) -> Iterator[GapRun]:
    for run, observed, followed in readings:
        yield GapRun(
            run.name,
            run.set_point,
            place_in(campaign, run, clock),
            observed.observation,
            observed.analysis.stretch.period_count,
            observed.analysis.recording.sample_rate_hz,
            observed.lead_s,
            following=followed,
        )
