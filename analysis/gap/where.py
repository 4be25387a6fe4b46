"""Where the gap lies: stage by stage, with the measured input put in place of the simulated one.

The struts' motion is measured between mechanism and model. A difference that is there already
comes from drive or mechanism (or from the photocell, if everything is turned alike); one that
appears only in the forces, with the measured motion fed to the model, comes from behind.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.components import Component, GapRun, Part
from analysis.gap.fit import Problem
from analysis.gap.forward import Simulator, read_steady
from analysis.gap.gaussian import Nuisances
from analysis.gap.observe import FORCES, STRUTS
from hardware.description.channels import SHAFT_ANGLE
from hardware.description.setpoint import Medium
from sim import signals
from sim.effects.applied import switch_on
from sim.effects.effect import StageName
from sim.period import Period
from sim.periodic import steady_state

FloatArray = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]

_HARMONIC: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)
_ORDERS: Final = 8
_POINTS: Final = 64


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
        The largest one, in words.
    """

    what: str
    rms: float
    count: int
    worst: str

    @property
    def beyond(self) -> bool:
        """Whether it is more than noise: beyond four standard deviations of a chi-square."""
        return self.count > 0 and self.rms**2 > 1.0 + 4.0 * (2.0 / self.count) ** 0.5


@dataclass(frozen=True)
class Walk:
    """The walk along the chain, and contrasts between kinds of runs.

    Attributes
    ----------
    steps
        Shaft, photocell, strut motion, forces with the simulated motion, forces with the measured
        motion; those for which there are channels.
    contrasts
        The same difference by medium, strut phase, speed, amplitude and frequency.
    """

    steps: tuple[Gap, ...]
    contrasts: tuple[Gap, ...]

    @property
    def stages(self) -> tuple[StageName, ...]:
        """Stages that the walk leaves as the gap's place, from upstream down."""
        beyond = {one.what for one in self.steps if one.beyond}
        if MOTION in beyond:
            return (StageName.DRIVE, StageName.MECHANISM, StageName.PHOTOCELL)
        if FORCE_FED in beyond or FORCE in beyond:
            return (StageName.STRUCTURE, StageName.MODEL, StageName.DYNAMOMETERS,
                    StageName.ACQUISITION)  # fmt: skip
        return ()


SHAFT: Final = "shaft"
TIMING: Final = "photocell and frequency"
MOTION: Final = "strut motion"
FORCE: Final = "forces"
FORCE_FED: Final = "forces, with the measured motion"
BESIDE: Final = "beside the harmonics"


def walk(problem: Problem) -> Walk:
    """Walk along the chain."""
    stack = problem.simulator.stack
    left = left_by_step(problem, problem.residual)
    steps = [gap_of(stack.components, left, what, inside) for what, inside in _STEPS.items()]
    fed = _fed(problem)
    if fed is not None:
        steps.insert(4, gap_of(stack.components, fed, FORCE_FED, _STEPS[FORCE]))
    steps = [one for one in steps if one.count]
    return Walk(tuple(steps), tuple(_contrasts(problem, left)))


def remaining(problem: Problem, residual: FloatArray) -> FloatArray:
    """Return what the free numbers leave of a whitened difference."""
    return residual - problem.nuisances.columns @ problem.nuisances.fitted(residual)


def left_by_step(problem: Problem, residual: FloatArray) -> FloatArray:
    """Return what the free numbers leave, each step judged by itself and those upstream of it.

    Fitted to everything at once, the settings of the drive would take up what the forces show, and
    the strut's motion would seem to deviate.
    """
    parts = problem.simulator.stack.components
    found, upstream = np.zeros_like(residual), np.zeros(len(parts), dtype=bool)
    for inside in _STEPS.values():
        own = np.array([inside(one) for one in parts])
        upstream |= own
        part = problem.nuisances.among(upstream)
        fitted = part.fitted(residual[upstream])
        found[own] = residual[own] - problem.nuisances.columns[own] @ fitted
    return found


_STEPS: Final[dict[str, Callable[[Component], bool]]] = {
    SHAFT: lambda one: one.channel == SHAFT_ANGLE.name,
    TIMING: lambda one: one.channel == "",
    MOTION: lambda one: one.channel in STRUTS,
    FORCE: lambda one: one.channel in FORCES and one.part in _HARMONIC,
    BESIDE: lambda one: one.channel in FORCES and one.part not in _HARMONIC,
}


def gap_of(
    components: Sequence[Component],
    left: FloatArray,
    what: str,
    inside: Callable[[Component], bool] | NDArray[np.bool_],
) -> Gap:
    """Return the gap over some components."""
    rows = np.array([inside(one) for one in components]) if callable(inside) else inside
    if not rows.any():
        return Gap(what, 0.0, 0, "")
    size = np.where(rows, np.abs(left), 0.0)
    worst = int(np.argmax(size))
    said = f"{components[worst]}: {left[worst]:+.1f} u"
    return Gap(what, float(np.sqrt(np.mean(left[rows] ** 2))), int(rows.sum()), said)


def _contrasts(problem: Problem, left: FloatArray) -> Iterator[Gap]:
    from analysis.gap.regimes import regimes

    stack = problem.simulator.stack
    forces = np.array([one.channel in FORCES for one in stack.components])
    for regime in regimes(stack.runs):
        rows = forces & np.isin(stack.run, regime.runs)
        yield gap_of(stack.components, left, str(regime), rows)
    in_water = [at for at, run in enumerate(stack.runs) if run.set_point.medium is Medium.WATER]
    if len(in_water) < len(stack.runs):
        yield gap_of(stack.components, left, "medium water", forces & np.isin(stack.run, in_water))


def _fed(problem: Problem) -> FloatArray | None:
    """Return what is left with the measured motion fed to the model; ``None`` without sensors."""
    simulator = problem.simulator
    seen = {one.channel for one in simulator.stack.components}
    if not set(STRUTS) <= seen or simulator.rig.drive.motor is not None:
        return None
    found = np.concatenate([_run_fed(simulator, run) for run in simulator.stack.runs])
    wider = np.concatenate([_motion_uncertainty(run) for run in simulator.stack.runs])
    sigma = simulator.stack.uncertainty
    shrink = sigma / np.hypot(sigma, wider)
    residual: FloatArray = problem.whitened(simulator.stack.values - found) * shrink
    forces = np.array([_STEPS[FORCE](one) for one in simulator.stack.components])
    part = Nuisances((problem.nuisances.columns * shrink[:, None])[forces])
    left: FloatArray = np.zeros_like(residual)
    left[forces] = residual[forces] - part.columns @ part.fitted(residual[forces])
    return left


def _run_fed(simulator: Simulator, run: GapRun) -> FloatArray:
    rig, set_point = switch_on(simulator.on, simulator.rig, run.set_point, run.place)
    period = Period(set_point.frequency_hz, _ORDERS, _POINTS)
    chain = rig.chain(set_point)
    turn = np.exp(-period.s * steady_state(chain, period).reference_s)
    given = _measured_motion(run, period, turn)
    state = steady_state(chain, period, given)
    return read_steady(state, run.observed.layout, run.set_point, simulator.reference_channel)


def _measured_motion(run: GapRun, period: Period, turn: ComplexArray) -> dict[str, ComplexArray]:
    """Return displacement, velocity and acceleration of both struts from measured harmonics.

    Differentiated order by order in the frequency domain: samples are never differenced.
    """
    names = (
        (signals.DISPLACEMENT_AFT, signals.VELOCITY_AFT, signals.ACCELERATION_AFT),
        (signals.DISPLACEMENT_FORE, signals.VELOCITY_FORE, signals.ACCELERATION_FORE),
    )
    given = {}
    for displacement, velocity, acceleration in names:
        harmonics = _spectrum(run, displacement.name, period.orders) * turn
        given[displacement.name] = harmonics
        given[velocity.name] = period.s * harmonics
        given[acceleration.name] = period.s**2 * harmonics
    return given


def _motion_uncertainty(run: GapRun) -> FloatArray:
    """Return what the measured motion's noise makes of the forces, shape ``(components,)``.

    An order's force per displacement grows with the square of the order, as inertia does; that is
    more than stiffness and damping make of it.
    """
    seen = run.observed
    noise = {
        (one.channel, one.order): sigma
        for one, sigma in zip(seen.components, seen.uncertainty, strict=True)
        if one.channel in STRUTS and one.part is Part.IN_PHASE
    }
    found = np.zeros(len(seen.components))
    for at, one in enumerate(seen.components):
        if one.channel in FORCES and one.part in (Part.IN_PHASE, Part.QUADRATURE):
            strut = STRUTS[FORCES.index(one.channel)]
            per_m = _first(run, one.channel) / max(_first(run, strut), 1e-9)
            found[at] = 2.0 * per_m * one.order**2 * noise.get((strut, one.order), 0.0)
    return found


def _first(run: GapRun, channel: str) -> float:
    parts = [run.observed.value(channel, one, 1) for one in (Part.IN_PHASE, Part.QUADRATURE)]
    return math.hypot(*parts)


def _spectrum(run: GapRun, channel: str, orders: int) -> ComplexArray:
    found = np.zeros(orders + 1, dtype=np.complex128)
    found[0] = run.observed.value(channel, Part.MEAN)
    for order in range(1, orders + 1):
        part = [run.observed.value(channel, one, order) for one in (Part.QUADRATURE, Part.IN_PHASE)]
        if np.isfinite(part).all():
            found[order] = complex(part[0], -part[1])
    return found


def unknown_stage(sizes: Sequence[Component], stays_in_air: bool | None) -> StageName:
    """Return the stage to which a deviation without a name points.

    Parameters
    ----------
    sizes
        The components that deviate.
    stays_in_air
        Whether it is there in runs in air as well; ``None`` if there are none.
    """
    channels = {one.channel for one in sizes}
    if channels & {*STRUTS, SHAFT_ANGLE.name}:
        return StageName.DRIVE if SHAFT_ANGLE.name in channels else StageName.MECHANISM
    if channels == {""}:
        return StageName.PHOTOCELL
    if len(channels & set(FORCES)) == 1 and stays_in_air is not False:
        return StageName.DYNAMOMETERS
    return StageName.STRUCTURE if stays_in_air else StageName.MODEL
