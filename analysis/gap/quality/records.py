"""What recordings show by themselves: told and made, units of speed and angle, plateaus, scatter.

No simulation is asked, only the set-points and the other runs.
"""

import math
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from analysis.gap.observe.components import GapRun, Part
from analysis.gap.observe.observation import SPEED
from analysis.gap.quality.finding import SAY_UNIT, UNIT_NEAR, Doubt
from analysis.mistaken_units import mistaken
from hardware.description.channels import (
    CARRIAGE_SPEED,
    DISPLACEMENT_AFT,
    DISPLACEMENTS,
    FORCE_AFT,
    FORCES,
    SHAFT_ANGLE,
)

_LOUD: Final = 20.0  # times the usual scatter
_OFF_FREQUENCY: Final = 0.02
_OFF_TURN: Final = 0.02
_FEW: Final = 3


def of_records(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    """Yield all doubts for which no simulation is needed, the most telling first."""
    yield from _of_frequency(runs)
    yield from _of_shaft_angle(runs)
    yield from _of_speed(runs)
    for channel in (*DISPLACEMENTS, *FORCES):
        yield from _of_standing(runs, channel)
        yield from _of_plateaus(runs, channel)


def _of_frequency(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    logs = [run.observed.value("", Part.FREQUENCY) for run in runs]
    usual = float(np.nanmedian(logs)) if np.isfinite(logs).any() else 0.0
    for run, value in zip(runs, logs, strict=True):
        if abs(value - usual) > _OFF_FREQUENCY:
            stated_hz = run.set_point.frequency_hz
            made_hz = stated_hz * math.exp(value)
            yield Doubt(
                run.name, "", f"made at {made_hz:.4g} Hz, not at the {stated_hz:g} Hz that are told"
            )


def _of_shaft_angle(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    """Yield doubts of the shaft's angle, which goes on by a turn each period."""
    turns = {run.name: run.observed.turns_per_period for run in runs}
    turns = {name: turn for name, turn in turns.items() if math.isfinite(turn)}
    if not turns:
        return
    usual = _of_turn(float(np.median(list(turns.values()))))
    if usual:
        yield Doubt("", SHAFT_ANGLE.name, f"in all runs {usual} Then {SAY_UNIT}, or leave it out")
        return
    for name, turn in turns.items():
        reason = _of_turn(turn)
        if reason:
            yield Doubt(name, SHAFT_ANGLE.name, reason)


def _of_turn(turns: float) -> str:
    """Return what is wrong with an angle that goes on by so many turns a period, taken as rad."""
    if abs(turns - 1.0) < _OFF_TURN:
        return ""
    if abs(turns) < 1e-6:
        return "it does not move: a dead encoder?"
    said = f"it goes on by {2.0 * math.pi * turns:.4g} each period, where a turn is 6.283 rad"
    meant = mistaken(abs(turns), SHAFT_ANGLE.unit, UNIT_NEAR) or (
        "its sign" if turns < 0.0 else "a gear between"
    )
    return f"{said}: {meant}?"


def _of_speed(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    """Yield doubts of the carriage's speed, which was told and is recorded."""
    stated_m_s = {run.name: run.set_point.carriage_speed_m_s for run in runs}
    measured_m_s = {run.name: run.observed.value(SPEED, Part.MEAN) for run in runs}
    ratios = {
        name: measured_m_s[name] / stated_m_s[name]
        for name in measured_m_s
        if stated_m_s[name] and measured_m_s[name]
    }
    ratios = {name: ratio for name, ratio in ratios.items() if math.isfinite(ratio)}
    if not ratios:
        return
    usual = float(np.median(list(ratios.values())))
    for name, ratio in {"": usual, **ratios}.items():
        meant = mistaken(abs(ratio), CARRIAGE_SPEED.unit, UNIT_NEAR)
        if meant or ratio < 0.0:
            yield Doubt(name, SPEED, f"{ratio:.3g} times what was told: {meant or 'its sign'}?")
            if not name:
                return


def _of_standing(runs: Sequence[GapRun], channel: str) -> Iterator[Doubt]:
    """Yield doubts of runs in which a channel stands while the shaft turns."""
    looked = [run for run in runs if run.turns and channel in run.observed.steps]
    still = [run.name for run in looked if math.isnan(run.observed.steps[channel])]
    if still and 2 * len(still) > len(looked):
        text = "it does not move in most runs: leave it out of the columns"
        yield Doubt("", channel, text)
        return
    for name in still:
        yield Doubt(name, channel, "it does not move")


def _of_plateaus(runs: Sequence[GapRun], channel: str) -> Iterator[Doubt]:
    """Yield doubts of runs in which a channel stands at its extreme, where in most it does not.

    What stops at a largest value in most runs is a property of the rig, which may be the cause.
    """
    plateaus = {run.name: run.observed.plateaus.get(channel) for run in runs}
    looked = {name: plateau for name, plateau in plateaus.items() if plateau is not None}
    clipped = {name: plateau for name, plateau in looked.items() if plateau.share}
    if 2 * len(clipped) >= len(looked):
        return
    unit = (DISPLACEMENT_AFT if channel in DISPLACEMENTS else FORCE_AFT).unit
    for name, plateau in clipped.items():
        at = " and ".join(f"{level:.4g} {unit}" for level in plateau.levels)
        share = 100.0 * plateau.share
        yield Doubt(name, channel, f"clipped: {share:.2g} % of its samples stand at {at}")


def of_scatter(runs: Sequence[GapRun]) -> Iterator[Doubt]:
    """Yield doubts of runs whose forces scatter far more than the others'."""
    for channel in FORCES:
        densities = {run.name: _density(run, channel) for run in runs}
        usable = {
            name: density
            for name, density in densities.items()
            if np.isfinite(density) and density > 0.0
        }
        if len(usable) < _FEW:
            continue
        usual = float(np.median(list(usable.values())))
        for name, density in usable.items():
            if density > _LOUD * usual:
                yield Doubt(name, channel, f"scatters {density / usual:.0f} times as much as usual")


def _density(run: GapRun, channel: str) -> float:
    """Return the scatter of the first harmonic, scaled to one second of record."""
    observation = run.observed
    sigmas = [
        sigma
        for component, sigma in zip(observation.components, observation.uncertainty, strict=True)
        if component.channel == channel
        and component.order == 1
        and component.part in (Part.IN_PHASE, Part.QUADRATURE)
    ]
    duration_s = run.periods / run.set_point.frequency_hz
    return float(np.sqrt(np.sum(np.square(sigmas)) * duration_s)) if sigmas else math.nan
