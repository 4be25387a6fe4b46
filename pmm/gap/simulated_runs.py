"""Runs of a pursuit made on a simulated rig that is what a campaign file says it truly is."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.runs import Run
from pmm.campaign.simulation import simulate_runs
from pmm.gap.pursuit import Maker, recording_of
from pmm.recorder.campaign_owner import own_campaign
from sim.effects.effect import Effect


def simulated_by(path: Path, campaign: Campaign) -> Maker:
    """Return what makes runs on a simulated rig.

    Parameters
    ----------
    path
        The rig as it truly is: a campaign file, its effects among it.
    campaign
        That is pursued.

    Raises
    ------
    ConfigurationError
        If the file cannot be read or describes another oscillator.
    """
    truth = read_campaign(path)
    if truth.oscillator != campaign.oscillator:
        raise ConfigurationError(
            f"{path}: describes another oscillator than campaign {campaign.name!r}; simulate on "
            "the rig that the campaign was made on"
        )
    truth.rig()  # refuses what cannot be simulated, before anything is diagnosed
    return _Simulated(truth, truth.effects_on())


@dataclass(frozen=True)
class _Simulated:
    truth: Campaign
    effects: tuple[Effect, ...]

    def __call__(self, folder: Path, campaign: Campaign, runs: Sequence[Run]) -> None:
        whole = replace(self.truth, runs=(*campaign.runs, *runs), at_rest=campaign.at_rest)
        missing = [one for one in runs if recording_of(folder, one) is None]
        seed = self.truth.simulation.seed
        with own_campaign(folder):
            list(simulate_runs(whole, missing, folder, seed, overwrite=False, effects=self.effects))
