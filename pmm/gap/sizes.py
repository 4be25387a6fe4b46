"""How large a difference is in units that people measure in: N, mm, degrees, per cent."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.locate.walk import FORCE, MOTION, SHAFT, step_of
from analysis.gap.observe.components import TRENDS, Component, GapRun, Part, Stack
from analysis.gap.search.fit import Fit
from hardware.description.arrays import FloatArray
from hardware.description.channels import CARRIAGE_SPEED, DISPLACEMENTS, FORCES, SHAFT_ANGLE
from pmm.document.labels import display
from pmm.gap.coefficients import CoefficientRow
from pmm.gap.steps import StepRow

_UNITS: Final = {
    **dict.fromkeys(FORCES, "N"),
    **dict.fromkeys(DISPLACEMENTS, "m"),
    **{channel.name: channel.unit for channel in (SHAFT_ANGLE, CARRIAGE_SPEED)},
}
_ONE_UNIT: Final = (SHAFT, MOTION, FORCE)  # steps whose numbers are all in the same unit
_TIMES_PER_CENT: Final = 1000.0  # nobody speaks of more than that in per cent
_HARMONIC: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)


@dataclass(frozen=True)
class Size:
    """The largest number of one step of the chain.

    Attributes
    ----------
    value, unit
        In the unit that people use: N, mm, degrees, per cent.
    what
        Of what: the harmonic of a channel, the frequency, ...
    per_cent
        Of the channel's measured first harmonic in that run; NaN where it has none.
    """

    step: str
    value: float
    unit: str
    what: str
    run: str
    per_cent: float

    @property
    def sentence(self) -> str:
        """The size in a sentence: quantity, largest value with unit, share, run."""
        first = f"{self.per_cent:.2g} % of its first harmonic, "
        part = "" if math.isnan(self.per_cent) else first
        return f"{self.what} by up to {self.value:.2g} {self.unit} ({part}run {self.run})"


@dataclass(frozen=True)
class SpoiledCoefficient:
    """The coefficient that is furthest off, in per cent, too large if positive."""

    name: str
    per_cent: float

    @property
    def percentage(self) -> str:
        """By how much it is off with its sign, in per cent, or in times itself if it is small."""
        if abs(self.per_cent) >= _TIMES_PER_CENT:
            return f"{self.per_cent / 100.0:+.2g} times its value"
        return f"{float(f'{self.per_cent:.2g}'):+g} %"


@dataclass(frozen=True)
class HowLarge:
    """How large a difference is.

    Attributes
    ----------
    sizes
        Of each step of the chain that has it, and in which anything changes.
    coefficient
        Which it puts off most; ``None`` where none is off by more than its uncertainty.
    """

    sizes: tuple[Size, ...]
    coefficient: SpoiledCoefficient | None


def how_large(
    stack: Stack, change: FloatArray, walk: Sequence[StepRow], rows: Sequence[CoefficientRow]
) -> HowLarge:
    """Return the size of a change of the observations in the steps that have a gap.

    Parameters
    ----------
    change
        What an effect changes, or what is left of the difference, in u; ``(observations,)``.
    walk
        Where no step has a gap, the size is that in the forces, or at the end of the chain.
    """
    present = {step_of(component) for component in stack.components}
    steps = [step.what for step in walk if step.gap and step.what in present]
    steps = steps or [FORCE if FORCE in present else walk[-1].what]
    largest = [_largest(stack, change, step) for step in steps]
    told = [size for size in largest if size.value] or largest  # a cause need not show in each
    return HowLarge(tuple(told), spoiled_coefficient(rows))


def spoiled_coefficient(rows: Sequence[CoefficientRow]) -> SpoiledCoefficient | None:
    """Return the coefficient that is off most, of those that are off for their uncertainty.

    Without the effect that is named from with it; where none is, as fitted from what is stated.
    Of those that are no more than their uncertainty a per cent says nothing.
    """
    off_rows = [row for row in rows if row.off and row.is_told]
    spoilt = [SpoiledCoefficient(row.where, _per_cent(row)) for row in off_rows]
    return max(spoilt, key=lambda coefficient: abs(coefficient.per_cent), default=None)


def _per_cent(row: CoefficientRow) -> float:
    reference, _ = row.reference
    return 100.0 * (row.without - reference) / reference


def _largest(stack: Stack, change: FloatArray, step: str) -> Size:
    """Return the largest harmonic of a step in its unit; beside them, what is clearest."""
    cells: dict[tuple[int, Component], list[int]] = {}
    for at, component in enumerate(stack.components):
        if step_of(component) == step:
            part = Part.MEAN if component.part in _HARMONIC else component.part
            key = int(stack.run[at]), Component(component.channel, part, component.order)
            cells.setdefault(key, []).append(at)
    scale = stack.uncertainty if step in _ONE_UNIT else np.ones(len(change))
    sizes = {key: float(np.linalg.norm((change * scale)[rows])) for key, rows in cells.items()}
    run, which = max(sizes, key=lambda key: sizes[key])
    rows = cells[run, which]
    value = float(np.linalg.norm((change * stack.uncertainty)[rows]))
    return _size(stack, step, run, which, value)


def _size(stack: Stack, step: str, run: int, which: Component, value: float) -> Size:
    gap_run = stack.runs[run]
    if which.part is Part.FREQUENCY:
        return Size(step, 100.0 * value, "%", "the frequency", gap_run.name, math.nan)
    if which.part is Part.PULSES:
        return Size(step, 100.0 * value, "%", "the photocell's pulses", gap_run.name, math.nan)
    if which.part not in (Part.MEAN, Part.MAINS, *TRENDS):
        shown = f"{which.part} of {which.channel}" if which.channel else str(which.part)
        return Size(step, 100.0 * math.expm1(value), "%", shown, gap_run.name, math.nan)
    unit = display(_UNITS.get(which.channel, ""))
    trend = " per period" if which.part in TRENDS else ""
    return Size(
        step,
        unit.factor * value,
        f"{unit.label}{trend}",
        f"{_of_order(which)} of {which.channel}",
        gap_run.name,
        100.0 * value / _first_amplitude(gap_run, which.channel),
    )


def _first_amplitude(run: GapRun, channel: str) -> float:
    """Return the amplitude of a channel's first harmonic; NaN where it is no measure."""
    parts = (Part.IN_PHASE, Part.QUADRATURE)
    first = math.hypot(*(run.observed.value(channel, part, 1) for part in parts))
    return first if channel in (*FORCES, *DISPLACEMENTS) and first > 0.0 else math.nan


def _of_order(which: Component) -> str:
    if which.order == 0:
        return "the mean"
    if which.part is Part.MAINS:
        return f"the {which.what}"
    return (
        f"harmonic {which.order}" if which.part is Part.MEAN else f"harmonic {which.order}'s trend"
    )


def own_sizes(fit: Fit) -> Iterator[str]:
    """Yield the size of each effect that has one number, in the unit that people use."""
    at = 0
    for candidate in fit.candidates:
        if len(candidate.axes) == 1:
            axis = candidate.axes[0]
            unit = display(axis.parameter.unit)
            value = unit.factor * axis.value(float(fit.units[at]))
            label = "" if axis.parameter.unit == "1" else f" {unit.label}"
            yield f"{axis.parameter.meaning} {value:.3g}{label}"
        at += len(candidate.axes)
