"""What stands beside every hypothesis of a campaign: how large, and how alike from run to run.

A deviation is alike for runs that are alike in frequency, amplitude, strut phase, speed, medium and
drift; each run has a part of its own.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.evidence import Background, Kind
from analysis.gap.inference.kernel import Kernel
from analysis.gap.inference.shapes import Shapes
from analysis.gap.observe.components import SETTLING, TRENDS, Component, Part, Stack
from analysis.gap.observe.observation import SPEED
from analysis.gap.search.first_look import FirstLook, signatures
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.effect import StageName

_OWN: Final = 0.2  # share of a cell's variance that is every run's own
_DRIFT_RAD: Final = 0.1  # of drift, after which runs are hardly alike
_SIZED: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE, *TRENDS, Part.MAINS)
# What a deviation of 1 is of what has no harmonics: an e-fold of noise, every pulse; of the
# frequency, which is known to 1e-4, a hundredth.
_UNITS: Final = {Part.FREQUENCY: 0.01}
_FLOORS: Final = dict.fromkeys(DISPLACEMENTS, 1e-3) | dict.fromkeys(FORCES, 1.0)  # m, N
_FLOOR: Final = 0.01  # rad of a shaft that turns evenly; m/s of a carriage
# Where something shows that acts at a stage: in its own channels, and in those behind it.
_BEHIND: Final = {
    StageName.MECHANISM: (*DISPLACEMENTS, *FORCES),
    StageName.CARRIAGE: (SPEED, *FORCES),
    **dict.fromkeys((StageName.STRUCTURE, StageName.MODEL, StageName.DYNAMOMETERS), FORCES),
}
# Something in the instruments shows in one channel alone, by the kind of its numbers.
_KINDS: Final = {
    **dict.fromkeys((Part.MEAN, Part.IN_PHASE, Part.QUADRATURE), "harmonics"),
    Part.TREND: "means",
    **dict.fromkeys(SETTLING, "trends"),
    Part.CYCLE_SCATTER: "scatter",
    Part.PERIOD_SCATTER: "scatter",
    Part.BETWEEN: "noise",  # a line leaves the median between the harmonics as it is
    Part.LINE: "lines",
    Part.MAINS: "mains",
}
_BANDED: Final = (Part.BETWEEN, Part.LINE)
# What shakes both gauges alike, and not with the shaft, may show in one kind of both.
_SHARED: Final = tuple(
    stage.value for stage in (StageName.MODEL, StageName.CARRIAGE, StageName.STRUCTURE)
)


def background(problem: Problem, looked: Sequence[FirstLook], sought: BoolArray) -> Background:
    """Return what stands beside every hypothesis of a campaign.

    Parameters
    ----------
    looked
        First looks at the effects of the catalogue.
    sought
        Which of the free numbers such a test is made to find, shape ``(free,)``.
    """
    stack, nominal = problem.simulator.stack, problem.simulator.nominal
    scale = units(stack, nominal) / stack.uncertainty
    columns = problem.nuisances.columns
    wide = np.zeros(columns.shape[1], dtype=bool)
    wide[: len(sought)] = sought
    shown = signatures(looked)
    cells = list(stack.rows_by_component.values())
    alike = likeness([run.set_point for run in stack.runs])
    each = [alike[np.ix_(stack.run[rows], stack.run[rows])] for rows in cells]
    return Background(
        problem.stated,
        columns,
        wide,
        Kernel.of(cells, each, scale),
        Shapes.of(shown, scale, problem.nuisances),
        dict(_run_columns(stack, scale)),
        dict(_rows_by_stage(stack)),
        dict(_kinds(stack)),
    )


def likeness(set_points: Sequence[SetPoint]) -> FloatArray:
    """Return how alike a deviation is between runs, shape ``(runs, runs)``; 1 on the diagonal."""
    places = np.array([_place(set_point) for set_point in set_points])
    distance = np.sum((places[:, None, :] - places[None, :, :]) ** 2, axis=2)
    shared = (1.0 - _OWN) * np.exp(-0.5 * distance)
    return np.asarray(shared + _OWN * np.eye(len(places)))


def _place(set_point: SetPoint) -> tuple[float, ...]:
    return (
        math.log(set_point.frequency_hz),
        math.log(max(set_point.eccentricity_m, 1e-6)),
        math.cos(set_point.strut_phase_rad),
        math.sin(set_point.strut_phase_rad),
        set_point.carriage_speed_m_s,
        2.0 * (set_point.medium is Medium.AIR),
        set_point.drift_rad / _DRIFT_RAD,
    )


def units(stack: Stack, nominal: FloatArray) -> FloatArray:
    """Return how large a deviation of 1 is at each observation, in the observation's unit.

    Of a channel its predicted first harmonic, root mean square over the campaign, over the order;
    of a mean and a line of the mains the same; of a change per period that over the periods.

    Parameters
    ----------
    nominal
        What the simulation says, shape ``(observations,)``.
    """
    return units_of(stack, channel_sizes(stack, nominal))


def channel_sizes(stack: Stack, nominal: FloatArray) -> dict[str, float]:
    """Return the root mean square of each channel's predicted first harmonic over a campaign."""
    squares: dict[str, list[float]] = {}
    for component, value in zip(stack.components, nominal, strict=True):
        first = component.part in (Part.IN_PHASE, Part.QUADRATURE) and component.order == 1
        standing = component.part is Part.MEAN and component.channel not in (
            *FORCES,
            *DISPLACEMENTS,
        )
        if first or standing:
            squares.setdefault(component.channel, []).append(float(value) ** 2)
    runs = max(len(stack.turning), 1)
    return {
        name: math.sqrt(sum(channel_squares) / runs) for name, channel_squares in squares.items()
    }


def units_of(stack: Stack, sizes: Mapping[str, float]) -> FloatArray:
    """Return how large a deviation of 1 is at each observation; see :func:`units`."""
    out = np.ones(len(stack.components))
    for at, component in enumerate(stack.components):
        if component.part in _SIZED:
            size = max(sizes.get(component.channel, 0.0), _FLOORS.get(component.channel, _FLOOR))
            out[at] = size if component.part is Part.MAINS else size / max(component.order, 1)
            if component.part in TRENDS:
                out[at] /= max(stack.runs[stack.run[at]].periods, 1)
        else:
            out[at] = _UNITS.get(component.part, 1.0)
    return out


def _rows_by_stage(stack: Stack) -> Iterator[tuple[str, BoolArray]]:
    """Yield by stage where something that acts there may show; everywhere if nothing is said."""
    for stage in StageName:
        channels = _BEHIND.get(stage)
        yield (
            stage.value,
            np.array(
                [
                    channels is None or component.channel in channels
                    for component in stack.components
                ]
            ),
        )


def _kinds(stack: Stack) -> Iterator[tuple[str, Kind]]:
    """Yield where something unknown may show alone.

    In one channel, or in both forces alike, by kind; or everywhere.
    """
    channels = np.array([component.channel for component in stack.components])
    kinds = np.array([_kind(component) for component in stack.components])
    for channel in dict.fromkeys(channels.tolist()):
        for kind in dict.fromkeys(kinds[channels == channel].tolist()):
            rows = (channels == channel) & (kinds == kind)
            yield f"{channel} {kind}".strip(), Kind(rows, (_instrument(channel, kind),))
    forces = np.isin(channels, FORCES)
    for kind in dict.fromkeys(kinds[forces].tolist()):
        rows = forces & (kinds == kind)
        if kind != "harmonics" and len(set(channels[rows].tolist())) > 1:
            yield f"forces {kind}", Kind(rows, _SHARED)
    stages = tuple(stage.value for stage in StageName)
    yield "all", Kind(np.ones(len(channels), dtype=bool), stages)


def _kind(component: Component) -> str:
    kind = _KINDS.get(component.part, "timing")
    return f"{kind} {component.order}" if component.part in _BANDED else kind


def _instrument(channel: str, kind: str) -> str:
    if not channel:
        return StageName.PHOTOCELL.value
    gauge = channel in FORCES and kind in ("harmonics", "means")
    return (StageName.DYNAMOMETERS if gauge else StageName.ACQUISITION).value


def _run_columns(stack: Stack, scale: FloatArray) -> Iterator[tuple[str, FloatArray]]:
    """Yield by run what a gain and a zero of its own change of each force, as it was measured."""
    measured = stack.values / stack.uncertainty
    for number, run in enumerate(stack.runs):
        columns = []
        for channel in FORCES:
            rows = np.array([component.channel == channel for component in stack.components])
            rows &= stack.run == number
            mean = rows & np.array([component.part is Part.MEAN for component in stack.components])
            columns.append(np.where(rows & stack.steady, measured, 0.0))
            columns.append(np.where(mean, scale, 0.0))
        yield run.name, np.column_stack(columns)
