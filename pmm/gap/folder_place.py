"""A campaign's folder as the place of a pursuit: others make its runs, or a simulated rig does."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import accumulate
from pathlib import Path

from analysis.gap.design.proposals import OSCILLATION, Proposal
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.runs import Run
from pmm.campaign.simulation import simulate_runs
from pmm.gap.causes import Standing, Suggestion
from pmm.gap.pursuit import Maker, read_pursued_folder, recording_of, take_in, write_round
from pmm.plan.plan_tables import Defaults
from pmm.plan.run_plan import RunPlan
from pmm.recorder.campaign_owner import own_campaign
from pmm.sequential.look import Look
from sim.effects.effect import Effect


@dataclass
class FolderPlace:
    """A campaign's folder whose runs are made by somebody else, or simulated."""

    folder: Path
    _offered: dict[SetPoint, Suggestion] = field(default_factory=dict)
    _open: tuple[RunPlan, ...] = ()

    def standing(self) -> Standing:
        """Return what is there, recordings that have appeared taken in."""
        missing = take_in(read_pursued_folder(self.folder))
        pursuit = read_pursued_folder(self.folder)
        made, self._open = pursuit.campaign.runs, pursuit.open
        return Standing(
            tuple(run.name for run in made),
            math.fsum(_turning_s(run.periods, run.frequency_hz) for run in made),
            pursuit.open,
            (),
            pursuit.set_points,
            tuple(f"{name} is not there yet ({why})" for name, why in missing.items()),
        )

    def offered(self, worth: Sequence[Suggestion]) -> Sequence[tuple[Suggestion, RunPlan]]:
        """Return all suggestions, each with its run: nothing limits a folder."""
        self._offered = {suggestion.set_point: suggestion for suggestion in worth}
        return [(suggestion, _proposed(suggestion.set_point)) for suggestion in worth]

    def times_left_s(self, runs: Sequence[RunPlan]) -> Sequence[float]:
        """Return how long the shaft turns in the open runs, in them and the first of some, ...."""
        open_s, *each_s = (
            math.fsum(_turning_s(run.periods, run.set_point.frequency_hz) for run in some)
            for some in (self._open, *([run] for run in runs))
        )
        return list(accumulate(each_s, initial=open_s))

    def plan(self, look: Look) -> tuple[str, ...]:
        """Write the plan of a round; return the names of the runs that are to be recorded."""
        if look.ending is not None:
            return ()
        pursuit = read_pursued_folder(self.folder)
        if look.proposed:
            chosen = (self._offered[run.set_point] for run in look.proposed)
            proposals = (
                Proposal(
                    OSCILLATION, suggestion.set_point, 0.0, suggestion.gain, suggestion.between
                )
                for suggestion in chosen
            )
            write_round(pursuit, list(proposals))
            pursuit = read_pursued_folder(self.folder)
        return tuple(run.name for run in pursuit.open)


def _turning_s(periods: int, frequency_hz: float) -> float:
    """Return how long the shaft turns in a run, settled as a plan without settings has it."""
    return (periods + Defaults().settling_periods + 1) / frequency_hz


def _proposed(point: SetPoint) -> RunPlan:
    """Return a run as a plan without settings of its own makes it."""
    usual = Defaults()
    kind = RunKind.DRY if point.medium is Medium.AIR else RunKind.OSCILLATION
    return RunPlan(
        "", kind, Motion.PHASE, point, usual.periods, usual.settling_periods,
        max_periods=usual.periods,
    )  # fmt: skip


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
        truth = replace(self.truth, runs=(*campaign.runs, *runs), at_rest=campaign.at_rest)
        missing = [run for run in runs if recording_of(folder, run) is None]
        seed = self.truth.simulation.seed
        with own_campaign(folder):
            list(simulate_runs(truth, missing, folder, seed, overwrite=False, effects=self.effects))
