"""Where the gap lies: stage by stage, with the measured input put in place of the simulated one.

The shaft is measured between drive and mechanism, the struts' motion between mechanism and model.
A difference of the motion that goes with the measured shaft comes from the drive; one that stays
from the mechanism (or from the photocell, if everything is turned alike). One that appears only in
the forces, with the measured motion fed to the model, comes from behind.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.locate.measured_input import MEASURED_MOTION, MEASURED_SHAFT, fed_remainder
from analysis.gap.observe.components import Component, Part, Stack
from analysis.gap.observe.observation import SPEED
from analysis.gap.observe.regimes import contrasts
from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES, SHAFT_ANGLE

FAR: Final = 3.0  # tolerances, beyond which a number is said to be off
_HARMONIC: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)


@dataclass(frozen=True)
class Gap:
    """How large a part of the difference is.

    Attributes
    ----------
    rms
        Root mean square of what the free numbers leave, in u; 1 is noise alone.
    count
        Components that were compared.
    worst
        The largest one, with its run, in words.
    stated
        As ``rms``, of the simulation as it is stated, with no number free; NaN where nobody asked.
    tells
        False where u is so wide that the gap would not show with the simulated input either.
    strained
        Free numbers that have to be off by more than three tolerances for it to be so small, with
        by how many.
    """

    step: str
    rms: float
    count: int
    worst: str
    stated: float = math.nan
    tells: bool = True
    strained: Mapping[str, float] = field(default_factory=dict)

    @property
    def is_beyond_noise(self) -> bool:
        """Whether it is more than noise: beyond four standard deviations of a chi-square."""
        return self.count > 0 and self.rms**2 > 1.0 + 4.0 * (2.0 / self.count) ** 0.5


@dataclass(frozen=True)
class Walk:
    """The walk along the chain, and contrasts between kinds of runs.

    Attributes
    ----------
    steps
        Carriage, shaft, photocell, strut motion, forces, and what is beside the harmonics; motion
        and forces once more with the last input that was measured in place of the simulated one.
        Those for which there are channels.
    contrasts
        The forces' difference by medium, strut phase, speed, amplitude and frequency.
    """

    steps: tuple[Gap, ...]
    contrasts: tuple[Gap, ...]


CARRIAGE: Final = "carriage"
SHAFT: Final = "shaft"
TIMING: Final = "photocell and frequency"
MOTION: Final = "strut motion"
MOTION_FED: Final = "strut motion, with the measured shaft"
FORCE: Final = "forces"
FORCE_FED: Final = "forces, with the measured motion"
FORCE_BY_SHAFT: Final = "forces, with the measured shaft"
BESIDE: Final = "beside the harmonics"

# What is judged once more with a measured input: the step, what is fed, and what it is called.
_FED: Final = (
    (MOTION, MEASURED_SHAFT, MOTION_FED),
    (FORCE, MEASURED_MOTION, FORCE_FED),
    (FORCE, MEASURED_SHAFT, FORCE_BY_SHAFT),
)


def walk(problem: Problem) -> Walk:
    """Walk along the chain."""
    stack, stated = problem.simulator.stack, problem.stated
    remainder, off = (
        left_by_step(problem, problem.residual),
        strained_numbers(problem, problem.stated),
    )
    steps = []
    for step_name in CHAIN:
        rows = _of_step(stack.components, step_name)
        if rows.any():
            plain = replace(
                gap_of(stack, remainder, step_name, rows, stated), strained=off[step_name]
            )
            steps += [plain, *_with_measured(problem, plain, step_name, rows)]
    return Walk(tuple(steps), tuple(_contrasts(problem, remainder)))


def _with_measured(problem: Problem, plain: Gap, step_name: str, rows: BoolArray) -> list[Gap]:
    """Return a step's gap with the last input that was measured fed; none where there is none."""
    stack = problem.simulator.stack
    for step, feed, name in _FED:
        comparison = fed_remainder(problem, feed, rows) if step == step_name else None
        if comparison is not None:
            gap = gap_of(stack, comparison.remainder, name, comparison.rows)
            is_telling = (
                gap_of(stack, comparison.simulated_remainder, name, comparison.rows).is_beyond_noise
                or not plain.is_beyond_noise
            )
            return [replace(gap, tells=is_telling or gap.is_beyond_noise)]
    return []


def left_by_step(problem: Problem, residual: FloatArray) -> FloatArray:
    """Return what the free numbers leave, each step judged by itself and those upstream of it."""
    remainder = np.zeros_like(residual)
    for _, rows, units in _fitted_by_step(problem, residual):
        remainder[rows] = residual[rows] - problem.nuisances.columns[rows] @ units
    return remainder


def strained_numbers(problem: Problem, residual: FloatArray) -> dict[str, dict[str, float]]:
    """Return which free numbers each step pulls beyond three tolerances, and by how many they are.

    A number counts where it is pulled so far first.
    """
    pulled_names, by_step = set[str](), {}
    for step_name, _, units in _fitted_by_step(problem, residual):
        pulled = zip(problem.free, units.tolist(), strict=False)
        far = {name: unit for name, unit in pulled if abs(unit) > FAR and name not in pulled_names}
        pulled_names |= far.keys()
        by_step[step_name] = far
    return by_step


def _fitted_by_step(
    problem: Problem, residual: FloatArray
) -> Iterator[tuple[str, BoolArray, FloatArray]]:
    """Yield each step with its rows, and what fits it and those upstream of it, in tolerances.

    Fitted to everything at once, the settings of the drive would take up what the forces show, and
    the strut's motion would seem to deviate.
    """
    parts = problem.simulator.stack.components
    upstream = np.zeros(len(parts), dtype=bool)
    for step_name in CHAIN:
        rows = _of_step(parts, step_name)
        if rows.any():
            upstream |= rows
            part = problem.nuisances.among(upstream)
            yield step_name, rows, part.fitted(residual[upstream])


CHAIN: Final = (CARRIAGE, SHAFT, TIMING, MOTION, FORCE, BESIDE)


def step_of(component: Component) -> str:
    """Return the step of the chain that a component tells of."""
    steps = {"": TIMING, SHAFT_ANGLE.name: SHAFT, SPEED: CARRIAGE}
    steps |= dict.fromkeys(DISPLACEMENTS, MOTION)
    return steps.get(component.channel) or (FORCE if component.part in _HARMONIC else BESIDE)


def _of_step(components: Sequence[Component], step_name: str) -> BoolArray:
    return np.array([step_of(component) == step_name for component in components])


def gap_of(
    stack: Stack,
    remainder: FloatArray,
    name: str,
    rows: BoolArray,
    stated_residual: FloatArray | None = None,
) -> Gap:
    """Return the gap over some components: what is left of it, and the whole where it is given."""
    if not rows.any():
        return Gap(name, 0.0, 0, "")
    size = np.where(rows, np.abs(remainder), 0.0)
    worst = int(np.argmax(size))
    run = stack.runs[stack.run[worst]].name
    said = f"{run}: {stack.components[worst]} {remainder[worst]:+z.1f} u"
    stated = math.nan if stated_residual is None else _rms(stated_residual[rows])
    return Gap(name, _rms(remainder[rows]), int(rows.sum()), said, stated)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _contrasts(problem: Problem, remainder: FloatArray) -> Iterator[Gap]:
    stack, stated = problem.simulator.stack, problem.stated
    forces = np.array([component.channel in FORCES for component in stack.components])
    for kind in contrasts(stack.runs):
        rows = forces & np.isin(stack.run, kind.runs)
        yield gap_of(stack, remainder, str(kind), rows, stated)
