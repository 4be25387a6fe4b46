"""The tests in water that are looked at on the spot: restoring, drift, tows, circles, free decays.

A quick look while model and rig still hang in the tank; ``pmm coefficients`` makes derivatives of
whole campaigns. Zeros, calibration and the derivatives of drift are as it has them.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.restoring import Restoring, Track, restoring_of, track_of
from analysis.coefficients.steady_turns import SteadyTurn
from analysis.coefficients.tows import Tow, tow_of
from hardware.description.errors import PmmError
from hardware.description.kinds import RunKind
from hardware.description.oscillator import Oscillator
from pmm.campaign.campaign import Campaign
from pmm.campaign.water import TankWater
from pmm.coefficients.decays import Decay, decays_of
from pmm.coefficients.reading import read_cycle, read_zero
from pmm.coefficients.settings import CoefficientSettings, ShipTable, settings_of
from pmm.coefficients.stated_inputs import chain_of, oscillator_of, stated_of
from pmm.coefficients.tasks import Failed, ReadRecording, Task
from pmm.coefficients.work import work_of
from pmm.coefficients.workflow import request_of

_HARMONICS = 3


@dataclass(frozen=True)
class InWater:
    """What the slow and steady tests say.

    Attributes
    ----------
    restoring
        Of each run, and beside it force and moment over the displacement, for a figure.
    tows
        Static drift and straight tow, in their order.
    derivatives
        Of the loads by the velocity across the model, at each speed; ``None`` where no run drifts.
    turns
        Runs on a circle: rate, radius, and the mean loads that held the model.
    decays
        Free decays in roll, by speed.
    failed
        Runs that could not be used, and why.
    ship, water
        What the tows' Froude and Reynolds numbers are of, as far as the files state it.
    """

    restoring: tuple[Restoring, ...] = ()
    tracks: tuple[Track, ...] = field(default=(), repr=False)
    tows: tuple[Tow, ...] = ()
    derivatives: CampaignCoefficients | None = None
    turns: tuple[SteadyTurn, ...] = ()
    decays: tuple[Decay, ...] = ()
    failed: tuple[Failed, ...] = ()
    ship: ShipTable = field(default_factory=ShipTable)
    water: TankWater | None = None

    @property
    def straight(self) -> tuple[Tow, ...]:
        """The straight tows."""
        return tuple(tow for tow in self.tows if tow.kind is RunKind.STRAIGHT_TOW)


def in_water(campaign: Campaign, folder: Path) -> InWater:
    """Evaluate a campaign's tests in water but oscillations; nothing where there are none.

    Raises
    ------
    ConfigurationError
        If the campaign has such runs and no oscillator, or ``coefficients.toml`` is wrong.
    """
    kinds = (RunKind.RESTORING, RunKind.STATIC_DRIFT, RunKind.STRAIGHT_TOW, RunKind.CIRCLE)
    planned = {run.kind for run in campaign.runs} | {one.kind for one in campaign.at_rest}
    if not planned & {*kinds, RunKind.FREE_DECAY}:
        return InWater()
    oscillator = oscillator_of(campaign, folder)
    settings, _ = settings_of(folder, None)
    work = work_of(campaign, folder, oscillator, chain_of(settings), harmonics=_HARMONICS)
    wanted = [run for run in work.runs if run.kind in kinds]
    used = {name for one in wanted for name in one.zero_names}
    zeros = [read_zero(zero) for zero in work.zeros if zero.name in used]
    known = {zero.name: zero.zero for zero in zeros if not isinstance(zero, Failed) and zero.zero}
    failed = [_named(zero) for zero in zeros if isinstance(zero, Failed)]
    found = _Found(campaign, oscillator, settings, failed)
    for task in wanted:
        found.take(task.with_zeros(known))
    decays, torn = decays_of(campaign, folder)
    return InWater(
        tuple(found.restoring),
        tuple(found.tracks),
        tuple(found.tows),
        found.derivatives(),
        tuple(found.turns),
        decays,
        (*failed, *map(_named, torn)),
        settings.ship.within(campaign.water),
        campaign.water,
    )


class _Found:
    """Gathers what the runs say; one that cannot be used is told and stops no other."""

    def __init__(
        self,
        campaign: Campaign,
        oscillator: Oscillator,
        settings: CoefficientSettings,
        failed: list[Failed],
    ) -> None:
        self._campaign, self._oscillator, self._failed = campaign, oscillator, failed
        self._settings = settings
        self._towed: list[ReadRecording] = []
        self.restoring: list[Restoring] = []
        self.tracks: list[Track] = []
        self.tows: list[Tow] = []
        self.turns: list[SteadyTurn] = []

    def take(self, task: Task) -> None:
        """Read a run and evaluate it."""
        done = read_cycle(task)
        if isinstance(done, Failed):
            self._failed.append(_named(done))
        elif done.cycle is not None:
            try:
                self._evaluate(task, done, done.cycle)
            except PmmError as error:
                self._failed.append(
                    _named(Failed(task.name, done.file, str(error), error.exit_status))
                )

    def derivatives(self) -> CampaignCoefficients | None:
        """Return what the tows tell as one campaign, about the midpoint."""
        cycles = [one.cycle for one in self._towed if one.cycle is not None]
        if not any(cycle.drift_rad for cycle in cycles):
            return None
        gauges = [one.calibration for one in self._towed if one.calibration is not None]
        stated = stated_of(self._campaign, self._settings, (), gauges, motion_asked=False)
        wanted = replace(request_of(self._settings, stated), wanted=())
        return campaign_coefficients(cycles, wanted)

    def _evaluate(self, task: Task, done: ReadRecording, cycle: BodyCycle) -> None:
        if done.turn is not None:
            self.turns.append(done.turn)
            return
        if task.kind is not RunKind.RESTORING:
            self._towed.append(done)
            self.tows.append(tow_of(task.kind, cycle))
            return
        believed = self._campaign.as_recorded(task.name)
        hull = believed.hull
        one = restoring_of(
            cycle, believed.model, np.array(hull.added_mass), np.array(hull.restoring)
        )
        self.restoring.append(one)
        self.tracks.append(track_of(one, cycle))


def _named(one: Failed) -> Failed:
    """Return it with the run's name in its message."""
    if one.name in one.message:
        return one
    return replace(one, message=f"{one.name}: {one.message}")
