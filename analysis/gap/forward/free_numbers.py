"""What is left free in every hypothesis: coefficients, settings and noise, within their tolerances.

Nobody knows added mass and damping beforehand: that is what the test is for. And nobody sets a
gain, a phase or an eccentricity without a tolerance. A difference that these explain is no gap, and
no effect may take credit for it.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from analysis.gap.forward.always_on import always_on
from analysis.gap.forward.noise_levels import by_run, noise_levels
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.smooth_changes import smooth_changes
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.gaussian import Nuisances
from analysis.gap.observe.components import Part, Stack
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENTS, SHAFT_ANGLE
from sim.effects.a3_photocell_angle import PhotocellAngle
from sim.effects.effect import Effect
from sim.effects.h11_carriage_speed import CarriageSpeedError
from sim.effects.k3_eccentricity_error import EccentricityError
from sim.effects.k4_strut_phase_error import StrutPhaseError
from sim.effects.m1_gain_error import GainError
from sim.effects.m5_zero_offset import ZeroOffset
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from sim.model.parameters import Matrix

Change = Callable[[SimulatedRig, float], SimulatedRig]

_TERMS: Final = {"added_mass": "a", "damping": "b", "restoring": "c"}
_SOUGHT: Final = tuple(f"{term}{row}{column}" for term in "ab" for row in "12" for column in "12")
_STEP = 0.1  # of a prior deviation
_CARRIAGE: Final = "carriage speed"
_IN_MEAN: Final = 0.3  # of a slow wave's amplitude, left in the mean of a record of a period or two


@dataclass(frozen=True)
class Free:
    """One free number.

    Attributes
    ----------
    deviation
        One standard deviation of its prior, in its own unit.
    change
        Returns a rig with that much added; ``None`` where ``effect`` does it.
    effect
        Returns the effect of the catalogue that amounts to that much.
    """

    name: str
    deviation: float
    change: Change | None = None
    effect: Callable[[float], Effect] | None = None

    @property
    def is_coefficient(self) -> bool:
        """Whether it belongs to the model and the water."""
        return self.change is not None

    @property
    def is_sought(self) -> bool:
        """Whether such a test is made to find it: added mass or damping, not what was weighed."""
        return self.is_coefficient and self.name in _SOUGHT

    def steady(self, simulator: Simulator, units: float) -> FloatArray:
        """Return what repeats with the shaft when it is off by some prior deviations."""
        value = units * self.deviation
        if self.effect is not None:
            return simulator.steady((self.effect(value),))
        return simulator.with_rig(self.applied(simulator.rig, value)).steady(())

    def applied(self, rig: SimulatedRig, value: float) -> SimulatedRig:
        """Return the rig with a coefficient changed; as it was for a setting."""
        return rig if self.change is None else self.change(rig, value)


def free_numbers(rig: SimulatedRig, tolerances: Tolerances) -> tuple[Free, ...]:
    """Return what is left free for a rig as it is stated; what has no tolerance is not."""
    numbers = (*_coefficients(rig, tolerances), *_settings(rig, tolerances))
    return tuple(number for number in numbers if number.deviation > 0.0)


def _coefficients(rig: SimulatedRig, tolerances: Tolerances) -> Iterator[Free]:
    for term in _TERMS:
        yield from _of_matrix(rig, term, tolerances)
    yield _of_body("mass_kg", tolerances.mass_relative * rig.body.mass_kg)
    yield _of_body("inertia_kg_m2", tolerances.inertia_relative * rig.body.inertia_kg_m2)
    yield _of_body("cg_x_m", tolerances.cg_m)
    yield _of_body("cg_z_m", tolerances.cg_m)


def _of_matrix(rig: SimulatedRig, term: str, tolerances: Tolerances) -> Iterator[Free]:
    matrix = np.abs(np.array(getattr(rig.water, term), dtype=np.float64))
    if term != "restoring":
        diagonal = np.diagonal(matrix + np.abs(_remembered(rig, term)))
        # Where nothing states what the water does, the body says what is much.
        matrix = np.diag(
            np.where(diagonal > 0.0, diagonal, (rig.body.mass_kg, rig.body.inertia_kg_m2))
        )
    for row in range(2):
        for column in range(2):
            scale = float(np.sqrt(matrix[row, row] * matrix[column, column]))
            diagonal = getattr(tolerances, f"{term}_relative")
            weight = diagonal if row == column else tolerances.coupling_relative
            name = f"{_TERMS[term]}{row + 1}{column + 1}"
            yield Free(name, weight * scale, _term_change(term, row, column))


def _remembered(rig: SimulatedRig, term: str) -> FloatArray:
    """Return what the water's memory adds to a matrix in the middle of the rig's frequencies."""
    if rig.radiation is None:
        return np.zeros((2, 2))
    span = rig.oscillator.frequency_hz
    middle = 2.0 * math.pi * math.sqrt(span.low * span.high)
    return np.asarray(getattr(rig.radiation, term)(middle), np.float64)


def _term_change(term: str, row: int, column: int) -> Change:
    def change(rig: SimulatedRig, value: float) -> SimulatedRig:
        old: Matrix = getattr(rig.water, term)
        rows = [list(terms) for terms in old]
        rows[row][column] += value
        new = ((rows[0][0], rows[0][1]), (rows[1][0], rows[1][1]))
        return replace(rig, water=replace(rig.water, **{term: new}))

    return change


def _of_body(field: str, deviation: float) -> Free:
    def change(rig: SimulatedRig, value: float) -> SimulatedRig:
        body = replace(rig.body, **{field: getattr(rig.body, field) + value})
        return replace(rig, body=body)

    return Free(field, deviation, change)


def _settings(rig: SimulatedRig, tolerances: Tolerances) -> Iterator[Free]:
    gain, zero, arm = tolerances.gain_relative, tolerances.zero_n, tolerances.eccentricity_m
    yield Free("gain aft", gain, effect=lambda x: GainError(aft=x, fore=0.0))
    yield Free("gain fore", gain, effect=lambda x: GainError(aft=0.0, fore=x))
    yield Free("zero aft", zero, effect=lambda x: ZeroOffset(aft_n=x, fore_n=0.0))
    yield Free("zero fore", zero, effect=lambda x: ZeroOffset(aft_n=0.0, fore_n=x))
    yield Free("eccentricity aft", arm, effect=lambda x: EccentricityError(x, 0.0))
    yield Free("eccentricity fore", arm, effect=lambda x: EccentricityError(0.0, x))
    yield Free("strut phase", tolerances.strut_phase_rad, effect=StrutPhaseError)
    speed = tolerances.carriage_speed_relative
    yield Free(_CARRIAGE, speed, effect=CarriageSpeedError)
    if rig.photocell is not None:
        yield Free("photocell", tolerances.photocell_angle_rad, effect=PhotocellAngle)


def with_coefficients(
    rig: SimulatedRig, free: Sequence[Free], units: Sequence[float]
) -> SimulatedRig:
    """Return the rig with the free coefficients changed by some prior deviations each."""
    for number, unit in zip(free, units, strict=True):
        rig = number.applied(rig, float(unit) * number.deviation)
    return rig


def tolerated(simulator: Simulator, free: Sequence[Free], tolerances: Tolerances) -> Nuisances:
    """Return what a tolerance of each changes, in sigma.

    After the columns of ``free`` there are named ones for what is always on, and others for each
    displacement sensor, for each run's frequency, phase reference and carriage, for what
    coefficients do with frequency and speed, and for each kind of noise of each channel: a rig that
    is noisier than believed has no gap for that.
    """
    base, sigma = simulator.steady(()), simulator.stack.uncertainty
    changes = [(number.steady(simulator, _STEP) - base) / _STEP / sigma for number in free]
    sensors = _sensors(simulator.stack, base, tolerances.displacement_gain_relative)
    stack = simulator.stack
    run_columns = [
        *by_run(stack, _frequencies(simulator, base, tolerances.frequency_relative)),
        *by_run(
            stack, _turn_change(stack, base, 1.0) * references_rad(stack, tolerances.reference_rad)
        ),
        *_uneven(stack, free, changes, tolerances.carriage_relative),
    ]
    levels = {
        number.name: column
        for number, column in zip(free, changes, strict=True)
        if number.is_sought
    }
    smooth = smooth_changes(stack, levels, tolerances)
    on = dict(always_on(simulator, base, tolerances))
    names = (*(number.name for number in free), *on)
    columns = [*changes, *on.values(), *sensors, *run_columns, *smooth, *noise_levels(stack)]
    return Nuisances(np.column_stack(columns), names, len(on))


def _sensors(stack: Stack, base: FloatArray, relative: float) -> Iterator[FloatArray]:
    """Yield what a displacement sensor's gain changes, a column for each."""
    for channel in DISPLACEMENTS:
        rows = np.array([component.channel == channel for component in stack.components])
        yield np.where(rows, relative * base / stack.uncertainty, 0.0)


def _uneven(
    stack: Stack, free: Sequence[Free], changes: Sequence[FloatArray], relative: float
) -> Iterator[FloatArray]:
    """Yield what an uneven carriage leaves in each run's mean speed, a column for each that runs.

    Parameters
    ----------
    changes
        What a tolerance of each free number changes, in sigma.
    """
    for number, column in zip(free, changes, strict=True):
        if number.name == _CARRIAGE:
            each = by_run(stack, _IN_MEAN * relative / number.deviation * column)
            yield from (run_column for run_column in each if run_column.any())


def _frequencies(simulator: Simulator, base: FloatArray, relative: float) -> FloatArray:
    """Return what a prior deviation of the frequency changes."""
    moved = replace(simulator, frequency_ratio=1.0 + 0.01 * relative).steady(())
    return np.asarray((moved - base) / 0.01 / simulator.stack.uncertainty, np.float64)


def _turn_change(stack: Stack, base: FloatArray, angle_rad: float) -> FloatArray:
    """Return what it changes to count the shaft's angle from a little later."""
    partners = {Part.IN_PHASE: (Part.QUADRATURE, -1.0), Part.QUADRATURE: (Part.IN_PHASE, 1.0)}
    keys = zip(stack.run.tolist(), stack.components, strict=True)
    at = {(run, component): number for number, (run, component) in enumerate(keys)}
    change = np.zeros(len(base))
    for (run, component), number in at.items():
        if component.part in partners:
            part, sign = partners[component.part]
            partner = at.get((run, replace(component, part=part)))
            if partner is not None:
                change[number] = sign * component.order * angle_rad * base[partner]
            if component.channel == SHAFT_ANGLE.name:
                change[number] = 0.0
    return change / stack.uncertainty


def references_rad(stack: Stack, usual_rad: float) -> FloatArray:
    """Return how well each run's phase is known, at each of its observations.

    No better than its pulses scatter: an interval is two of them, and a run has as many as periods.
    """
    uncertainties_rad = []
    for run in stack.runs:
        spread = math.exp(run.observed.value("", Part.PERIOD_SCATTER))  # of the intervals, relative
        jitter = math.sqrt(2.0) * math.pi * (spread if math.isfinite(spread) else 0.0)
        uncertainties_rad.append(math.hypot(usual_rad, jitter / math.sqrt(max(run.periods, 1))))
    return np.array(uncertainties_rad)[stack.run]
