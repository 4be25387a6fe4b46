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
from pmm.campaign.campaign import Campaign
from pmm.campaign.water import TankWater
from pmm.coefficients.decays import Decay, decays_of
from pmm.coefficients.reading import read_cycle, read_zero
from pmm.coefficients.settings import CoefficientSettings, ShipTable, settings_of
from pmm.coefficients.stated_inputs import chain_of, oscillator_of, stated_of
from pmm.coefficients.tasks import FailedRecording, ReadRecording, Task
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
    failed: tuple[FailedRecording, ...] = ()
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
    planned = {run.kind for run in campaign.runs} | {test.kind for test in campaign.at_rest}
    if not planned & {*kinds, RunKind.FREE_DECAY}:
        return InWater()
    oscillator = oscillator_of(campaign, folder)
    settings, _ = settings_of(folder, None)
    work = work_of(campaign, folder, oscillator, chain_of(settings), harmonics=_HARMONICS)
    tasks = [run for run in work.runs if run.kind in kinds]
    zero_names = {name for task in tasks for name in task.zero_names}
    zeros = [read_zero(zero) for zero in work.zeros if zero.name in zero_names]
    zeros_by_name = {
        zero.name: zero.zero
        for zero in zeros
        if not isinstance(zero, FailedRecording) and zero.zero
    }
    failed = [_with_run_name(zero) for zero in zeros if isinstance(zero, FailedRecording)]
    results = _WaterTestCollector(campaign, settings, failed)
    for task in tasks:
        results.take(task.with_zeros(zeros_by_name))
    decays, torn = decays_of(campaign, folder)
    return InWater(
        tuple(results.restoring),
        tuple(results.tracks),
        tuple(results.tows),
        results.derivatives(),
        tuple(results.turns),
        decays,
        (*failed, *map(_with_run_name, torn)),
        settings.ship.within(campaign.water),
        campaign.water,
    )


class _WaterTestCollector:
    """Gathers what the runs say; one that cannot be used is told and stops no other."""

    def __init__(
        self,
        campaign: Campaign,
        settings: CoefficientSettings,
        failed: list[FailedRecording],
    ) -> None:
        self._campaign, self._failed = campaign, failed
        self._settings = settings
        self._towed: list[ReadRecording] = []
        self.restoring: list[Restoring] = []
        self.tracks: list[Track] = []
        self.tows: list[Tow] = []
        self.turns: list[SteadyTurn] = []

    def take(self, task: Task) -> None:
        """Read a run and evaluate it."""
        recording = read_cycle(task)
        if isinstance(recording, FailedRecording):
            self._failed.append(_with_run_name(recording))
        elif recording.cycle is not None:
            try:
                self._evaluate(task, recording, recording.cycle)
            except PmmError as error:
                self._failed.append(
                    _with_run_name(
                        FailedRecording(task.name, recording.file, str(error), error.exit_status)
                    )
                )

    def derivatives(self) -> CampaignCoefficients | None:
        """Return what the tows tell as one campaign, about the midpoint."""
        cycles = [recording.cycle for recording in self._towed if recording.cycle is not None]
        if not any(cycle.drift_rad for cycle in cycles):
            return None
        gauges = [
            recording.calibration for recording in self._towed if recording.calibration is not None
        ]
        stated = stated_of(self._campaign, self._settings, (), gauges, motion_asked=False)
        request = replace(request_of(self._settings, stated), wanted=())
        return campaign_coefficients(cycles, request)

    def _evaluate(self, task: Task, recording: ReadRecording, cycle: BodyCycle) -> None:
        if recording.turn is not None:
            self.turns.append(recording.turn)
            return
        if task.kind is not RunKind.RESTORING:
            self._towed.append(recording)
            self.tows.append(tow_of(task.kind, cycle))
            return
        believed = self._campaign.as_recorded(task.name)
        hull = believed.hull
        restoring = restoring_of(
            cycle, believed.model, np.array(hull.added_mass), np.array(hull.restoring)
        )
        self.restoring.append(restoring)
        self.tracks.append(track_of(restoring, cycle))


def _with_run_name(failure: FailedRecording) -> FailedRecording:
    """Return it with the run's name in its message."""
    if failure.name in failure.message:
        return failure
    return replace(failure, message=f"{failure.name}: {failure.message}")
