"""A campaign's file simulated into a folder: planned and checked first, then carried out."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.runs import AtRest, Run
from pmm.campaign.simulation import (
    SimulatedRun,
    at_rest_runs,
    check_target,
    copy_campaign,
    simulate_at_rest,
    simulate_runs,
)
from pmm.recorder.campaign_owner import own_new_campaign
from sim.effects.catalogue import build, user_effects
from sim.effects.effect import Effect


@dataclass(frozen=True)
class SimulatedCampaign:
    """The recordings that were made: of the runs, and the files of those at rest."""

    runs: tuple[SimulatedRun, ...]
    at_rest: tuple[str, ...]


@dataclass(frozen=True)
class PlannedSimulation:
    """What is to be simulated, and where it is written.

    Attributes
    ----------
    file
        The campaign's own.
    folder
        Gets a copy of that file and a recording per run.
    zeros
        Runs at rest that are simulated too.
    seed
        Of all noise.
    overwrite
        Whether recordings that are there are replaced.
    """

    file: Path
    campaign: Campaign
    folder: Path
    runs: tuple[Run, ...]
    zeros: tuple[AtRest, ...]
    effects: tuple[Effect, ...]
    seed: int
    overwrite: bool

    def carry_out(
        self, progress: Callable[[Sequence[Run]], Iterable[Run]] = iter
    ) -> SimulatedCampaign:
        """Simulate and write.

        Parameters
        ----------
        progress
            Hands the runs on one by one and may show how far it is.

        Raises
        ------
        ConfigurationError
            As :func:`pmm.campaign.simulation.simulate_runs` does.
        OwnedElsewhereError
            If another process writes into the folder.
        """
        with own_new_campaign(self.folder):
            runs = simulate_runs(
                self.campaign,
                progress(self.runs),
                self.folder,
                self.seed,
                overwrite=self.overwrite,
                effects=self.effects,
            )
            zeros = simulate_at_rest(
                self.campaign,
                self.zeros,
                self.folder,
                self.seed,
                overwrite=self.overwrite,
                effects=self.effects,
            )
            result = SimulatedCampaign(tuple(runs), tuple(zeros))
            copy_campaign(self.file, self.campaign, self.folder)
        return result


def planned_simulation(
    path: Path,
    folder: Path | None,
    *,
    runs: Sequence[str] = (),
    effects: Sequence[str] = (),
    effects_file: str | None = None,
    seed: int | None = None,
    overwrite: bool = False,
) -> PlannedSimulation:
    """Plan what ``pmm simulate`` does; its options have the same names.

    Parameters
    ----------
    path
        The campaign's file, or the folder that holds it.
    folder
        Where to write; named after the campaign if not given.
    runs
        Names of those that are simulated; all of them, and those at rest, if not given.
    effects
        Switched on besides those of the file, as ``NAME:PARAM=VALUE,...``.
    seed
        In place of the file's.

    Raises
    ------
    ConfigurationError
        If the file is wrong, a run or an effect is not known, or something would be overwritten.
    """
    file = path / CAMPAIGN_FILE if path.is_dir() else path
    campaign = read_campaign(file)
    file_effects = user_effects(effects_file)
    simulation = PlannedSimulation(
        file,
        campaign,
        Path(campaign.name) if folder is None else folder,
        tuple(campaign.run(name) for name in runs) or tuple(campaign.runs),
        () if runs else at_rest_runs(campaign),
        (*campaign.effects_on(file_effects), *(build(text, file_effects) for text in effects)),
        campaign.simulation.seed if seed is None else seed,
        overwrite,
    )
    records: tuple[Run | AtRest, ...] = (*simulation.runs, *simulation.zeros)
    check_target(file, campaign, records, simulation.folder, overwrite=overwrite)
    return simulation
