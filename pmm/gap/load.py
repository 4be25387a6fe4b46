"""A campaign's folder as the gap diagnosis wants it."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from analysis.gap.components import GapRun
from analysis.gap.observe import Observed, observe
from analysis.readers import read_recording
from hardware.description.errors import DataError, PmmError
from pmm.campaign import CAMPAIGN_FILE, Campaign, Run
from pmm.campaign_file import read_campaign
from sim.rig import SimulatedRig


@dataclass(frozen=True, eq=False)
class Loaded:
    """A campaign, read and observed.

    Attributes
    ----------
    left_out
        Runs that could not be used, by name, with the reason.
    reference_channel
        The channel whose fundamental is phase 0; ``None`` with a photocell.
    """

    campaign: Campaign
    rig: SimulatedRig
    runs: tuple[GapRun, ...]
    left_out: dict[str, str]
    reference_channel: str | None


def load_campaign(
    path: Path, withheld: Sequence[str] = (), progress: Callable[[str], None] = lambda _: None
) -> Loaded:
    """Read and observe the runs of a campaign that oscillate.

    Parameters
    ----------
    path
        The folder, or its ``campaign.toml``.
    withheld
        Runs that are left out, by name: nobody looks at them.

    Raises
    ------
    ConfigurationError
        If the campaign does not say what the simulation needs.
    DataError
        If runs have different references: some with a photocell, some without.
    """
    path = path / CAMPAIGN_FILE if path.is_dir() else path
    campaign = read_campaign(path)
    rig = campaign.rig()
    left_out: dict[str, str] = {}
    found: list[tuple[Run, Observed]] = []
    for run in campaign.runs:
        if run.name in withheld or not run.frequency_hz > 0.0:
            continue
        progress(run.name)
        try:
            found.append((run, _observed(campaign, run, path.parent)))
        except (PmmError, OSError) as error:
            left_out[run.name] = str(error)
    references = {one.reference_channel for _, one in found}
    if len(references) > 1:
        raise DataError(
            f"{path}: some runs have a photocell and some have none; diagnose them apart"
        )
    runs = tuple(_gap_runs(campaign, found))
    return Loaded(campaign, rig, runs, left_out, next(iter(references), None))


def _observed(campaign: Campaign, run: Run, folder: Path) -> Observed:
    recording = read_recording(run.recording_path(folder), campaign.columns)
    latency_s = campaign.reference.latency_s
    return observe(replace(recording, name=run.name, set_point=run.set_point), latency_s)


def _gap_runs(campaign: Campaign, found: Sequence[tuple[Run, Observed]]) -> Iterator[GapRun]:
    for run, one in found:
        yield GapRun(
            run.name,
            run.set_point,
            campaign.place(run),
            one.observation,
            one.analysis.stretch.period_count,
            one.analysis.recording.sample_rate_hz,
        )
