"""The stage from which something unknown comes.

What nobody knows resembles what is known: of the effects of the right stage one usually explains
more than those of any other, for they act at the same place of the chain and follow the same
motion, force or clock. Where the motion is off already, nothing behind it is to blame, nor the
drive of a shaft that turns as it should; where it is not, drive and mechanism are heard less: play
and teeth may strike at orders that are not compared. Where no effect explains anything, the
channels that deviate have to do.
"""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from analysis.gap.components import Component
from analysis.gap.fit import Problem
from analysis.gap.hypotheses import Weighed
from analysis.gap.observe import SPEED
from analysis.gap.where import MOTION, SHAFT, Walk, remaining
from hardware.description.channels import DISPLACEMENTS, FORCES, SHAFT_ANGLE
from hardware.description.setpoint import Medium
from sim.effects.effect import Effect, StageName

_POWER: Final = 2.0  # of what is explained, in the odds
_BY_CHANNELS: Final = 1.0  # log evidence that the deviating channels count for
_FINE: Final = 0.3  # of their evidence, where what they move moves as it should
_STAYS: Final = 0.3  # of the mean square in water: what is there in air as well


def unknown_stages(
    problem: Problem, walked: Walk, weighed: Weighed, catalogue: Mapping[str, type[Effect]]
) -> dict[str, float]:
    """Return how probable each stage is for what is unknown; sums to 1.

    By the log evidence of the best effect of each stage, without a remainder, over that of no gap.
    """
    explained = {_by_channels(problem, weighed): _BY_CHANNELS}
    heard = _heard(problem, walked)
    refined = [one.fit for one in weighed.singles]
    looked = [one.fit for one in weighed.looked if one.fit is not None]
    for fit in (*refined, *looked):
        stage = catalogue[fit.names[0]].stage
        gain = heard[stage] * max(fit.log_evidence - weighed.none, 0.0)
        explained[stage] = max(explained.get(stage, 0.0), gain)
    top = max(explained.values())
    odds = {stage.value: (gain / top) ** _POWER for stage, gain in explained.items()}
    return {name: value / sum(odds.values()) for name, value in odds.items()}


def _heard(problem: Problem, walked: Walk) -> dict[StageName, float]:
    """Return which share of its evidence each stage is given, by the motion that is recorded."""
    beyond = {one.what: one.beyond for one in walked.steps}
    whole = dict.fromkeys(StageName, 1.0)
    if problem.simulator.rig.drive.motor is not None:
        return whole  # a drive that feels its load moves by what is behind it, too
    if walked.comes_with_the_shaft:
        return {one: float(one is StageName.DRIVE) for one in StageName}
    if MOTION not in beyond:
        return whole
    shaft_is_off = beyond.get(SHAFT)  # None where it is not recorded
    if beyond[MOTION]:
        acquitted = {StageName.DRIVE} if shaft_is_off is False else set()
        return {one: float(one in walked.stages and one not in acquitted) for one in StageName}
    if not shaft_is_off:
        whole |= {StageName.DRIVE: _FINE, StageName.MECHANISM: _FINE}
    return whole


def _by_channels(problem: Problem, weighed: Weighed) -> StageName:
    stack = problem.simulator.stack
    air = np.array([run.set_point.medium is Medium.AIR for run in stack.runs])[stack.run]
    left = remaining(problem, problem.residual)
    stays = None
    if air.any():
        stays = bool(np.mean(left[air] ** 2) > _STAYS * np.mean(left[~air] ** 2))
    return stage_by_channels(list(weighed.unknown.sizes), stays)


def stage_by_channels(sizes: Sequence[Component], stays_in_air: bool | None) -> StageName:
    """Return the stage to which the channels of a deviation without a name point.

    Parameters
    ----------
    sizes
        The components that deviate.
    stays_in_air
        Whether it is there in runs in air as well; ``None`` if there are none.
    """
    channels = {one.channel for one in sizes}
    if SPEED in channels:
        return StageName.CARRIAGE
    if channels & {*DISPLACEMENTS, SHAFT_ANGLE.name}:
        return StageName.DRIVE if SHAFT_ANGLE.name in channels else StageName.MECHANISM
    if channels == {""}:
        return StageName.PHOTOCELL
    if len(channels & set(FORCES)) == 1 and stays_in_air is not False:
        return StageName.DYNAMOMETERS
    return StageName.STRUCTURE if stays_in_air else StageName.MODEL
