"""What zeros do between the records at rest: how well a mean or a trend can be known at all."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from analysis.gap.observe.at_rest import steady_at_rest
from analysis.gap.observe.components import GapRun, Part
from analysis.uncertainty.freedom import student_factor
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES
from sim.rig import SimulatedRig

_COVERED = 0.975  # by an interval of 95 %
_OF_MEDIAN = 1.4826  # standard deviation over median deviation, of a normal distribution
_EFFICIENCY = 0.37  # of the median deviation, for a normal distribution
_FOR_SLOPE = 4  # records: of three the median slope goes through two


def wander(
    rig: SimulatedRig, runs: Sequence[GapRun], usual: tuple[float, float] = (0.0, 0.0)
) -> dict[str, tuple[float, float]]:
    """Return how far each force's zero wanders, from the campaign's records at rest.

    A zero that is off, or drifts evenly over the campaign, is an effect and no wander; so is a
    single record that is off. So it is the median deviation from a level for each medium that
    counts, and from four records in one medium on a median slope over the campaign's time (Theil
    and Sen) is taken out first.

    Parameters
    ----------
    usual
        What is taken where there are fewer than two records, as what is returned.

    Returns
    -------
    dict
        By channel, the standard deviation about that line, in N, and what a random walk with it
        makes of a root of a second, in N per root s. Channels whose zeros scatter as their own
        noise does are not in it.
    """
    still = [run for run in runs if not run.turns and run.applied is None]
    wanders = {}
    for channel in FORCES:
        readable_runs = [
            run for run in still if math.isfinite(run.observed.value(channel, Part.MEAN))
        ]
        wandering = _about_line(rig, readable_runs, channel) if len(readable_runs) > 1 else usual
        if wandering:
            wanders[channel] = wandering
    return wanders


def _about_line(
    rig: SimulatedRig, runs: Sequence[GapRun], channel: str
) -> tuple[float, float] | None:
    simulated = [_component(run, steady_at_rest(rig, run.set_point, run), channel) for run in runs]
    zeros = np.array([run.observed.value(channel, Part.MEAN) for run in runs]) - simulated
    noise = np.array([_component(run, run.observed.uncertainty, channel) for run in runs])
    at_s = np.array([run.place.since_start_s for run in runs])
    spacing_s = float(np.median(np.diff(np.sort(at_s))))
    media = np.array([run.set_point.medium for run in runs])
    slope = _median_slope(at_s, zeros, media)
    zeros = zeros - (slope or 0.0) * at_s
    for medium in set(media.tolist()):
        zeros[media == medium] -= np.median(zeros[media == medium])
    freedom = len(runs) - len(set(media.tolist())) - (slope is not None)
    variance = (_OF_MEDIAN * float(np.median(np.abs(zeros)))) ** 2 - float(np.median(noise)) ** 2
    if freedom < 1 or not spacing_s > 0.0 or not variance > 0.0:
        return None
    deviation = math.sqrt(variance) * _widened(freedom)
    return deviation, deviation / math.sqrt(spacing_s)


def _median_slope(at_s: FloatArray, zeros: FloatArray, media: NDArray[np.str_]) -> float | None:
    """Return the median slope between records of one medium; ``None`` where they are too few."""
    first, second = np.triu_indices(len(zeros), 1)
    alike = (media[first] == media[second]) & (at_s[first] != at_s[second])
    first, second = first[alike], second[alike]
    if max(np.count_nonzero(media == medium) for medium in media) < _FOR_SLOPE:
        return None
    return float(np.median((zeros[second] - zeros[first]) / (at_s[second] - at_s[first])))


def _widened(freedom: int) -> float:
    """Return by how much a deviation that few records tell is taken larger: Student over normal.

    A median deviation tells as much as a mean square of 37 in 100 of the values does.
    """
    level = 2.0 * _COVERED - 1.0
    effective_freedom = max(_EFFICIENCY * freedom, 1.0)
    return float(student_factor(effective_freedom, level) / student_factor(np.inf, level))


def _component(run: GapRun, values: FloatArray, channel: str) -> float:
    parts = [(component.channel, component.part) for component in run.observed.components]
    return float(values[parts.index((channel, Part.MEAN))])


def wandered(run: GapRun, wanders: Mapping[str, tuple[float, float]]) -> GapRun:
    """Return a run whose means and trends are no better known than its zeros wander.

    The slope of the straight line that fits a random walk of s per root of a second over T has the
    standard deviation s sqrt(6 / (5 T)).
    """
    observation, duration_s = run.observed, run.periods / run.set_point.frequency_hz
    spread = np.zeros(len(observation.components))
    for at, component in enumerate(observation.components):
        level_n, walk_n = wanders.get(component.channel, (0.0, 0.0))
        if component.part is Part.MEAN:
            spread[at] = level_n
        elif component.part is Part.TREND:
            spread[at] = walk_n * math.sqrt(1.2 / duration_s) / run.set_point.frequency_hz
    return replace(
        run, observed=replace(observation, uncertainty=np.hypot(observation.uncertainty, spread))
    )
