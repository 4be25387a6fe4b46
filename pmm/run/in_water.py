"""The slow and steady tests in water: quasi-static restoring, static drift, straight tow.

A quick look while model and rig still hang in the tank; ``pmm coefficients`` makes derivatives of
whole campaigns. Zeros are taken off and a calibration is applied as it does.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from analysis.coefficients.cycle import Cycle
from analysis.coefficients.restoring import Restoring, Track, restoring_of, track_of
from analysis.coefficients.tows import DriftSlope, Tow, drift_slopes, tow_of
from hardware.description.errors import PmmError
from hardware.description.oscillator import Oscillator
from pmm.campaign import Campaign
from pmm.coefficients.given import chain_of, oscillator_of
from pmm.coefficients.reading import read_cycle, read_zero
from pmm.coefficients.settings import settings_of
from pmm.coefficients.tasks import Failed, Task, work_of
from pmm.plan.kinds import RunKind

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
    slopes
        Force and moment over the velocity across the model, one for each speed.
    failed
        Runs that could not be used, and why.
    """

    restoring: tuple[Restoring, ...] = ()
    tracks: tuple[Track, ...] = field(default=(), repr=False)
    tows: tuple[Tow, ...] = ()
    slopes: tuple[DriftSlope, ...] = ()
    failed: tuple[Failed, ...] = ()

    @property
    def straight(self) -> tuple[Tow, ...]:
        """The straight tows."""
        return tuple(one for one in self.tows if one.kind is RunKind.STRAIGHT_TOW)


def in_water(campaign: Campaign, folder: Path) -> InWater:
    """Evaluate a campaign's restoring, drift and tow runs; nothing where there are none.

    Raises
    ------
    ConfigurationError
        If the campaign has such runs and no oscillator, or ``coefficients.toml`` is wrong.
    """
    kinds = (RunKind.RESTORING, RunKind.STATIC_DRIFT, RunKind.STRAIGHT_TOW)
    planned = {one.kind for one in campaign.runs} | {one.kind for one in campaign.at_rest}
    if not planned & set(kinds):
        return InWater()
    oscillator = oscillator_of(campaign, folder)
    settings, _ = settings_of(folder, None)
    work = work_of(campaign, folder, oscillator, chain_of(settings), harmonics=_HARMONICS)
    wanted = [one for one in work.runs if one.kind in kinds]
    used = {name for one in wanted for name in one.zero_names}
    zeros = [read_zero(one) for one in work.zeros if one.name in used]
    known = {one.name: one.zero for one in zeros if not isinstance(one, Failed) and one.zero}
    failed = [_named(one) for one in zeros if isinstance(one, Failed)]
    found = _Found(campaign, oscillator, failed)
    for task in wanted:
        found.take(task.with_zeros(known))
    tows = tuple(found.tows)
    return InWater(
        tuple(found.restoring), tuple(found.tracks), tows, drift_slopes(tows), tuple(failed)
    )


class _Found:
    """Gathers what the runs say; one that cannot be used is told and stops no other."""

    def __init__(self, campaign: Campaign, oscillator: Oscillator, failed: list[Failed]) -> None:
        self._campaign, self._oscillator, self._failed = campaign, oscillator, failed
        self.restoring: list[Restoring] = []
        self.tracks: list[Track] = []
        self.tows: list[Tow] = []

    def take(self, task: Task) -> None:
        """Read a run and evaluate it."""
        done = read_cycle(task)
        if isinstance(done, Failed):
            self._failed.append(_named(done))
        elif done.cycle is not None:
            try:
                self._evaluate(task, done.cycle)
            except PmmError as error:
                self._failed.append(
                    _named(Failed(task.name, done.file, str(error), error.exit_status))
                )

    def _evaluate(self, task: Task, cycle: Cycle) -> None:
        if task.kind is not RunKind.RESTORING:
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
