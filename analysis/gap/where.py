"""Where the gap lies: stage by stage, with the measured input put in place of the simulated one.

The struts' motion is measured between mechanism and model. A difference that is there already
comes from drive or mechanism (or from the photocell, if everything is turned alike); one that
appears only in the forces, with the measured motion fed to the model, comes from behind.
"""

import math
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from analysis.gap.at_rest import steady_at_rest
from analysis.gap.components import Component, GapRun, Part, Stack
from analysis.gap.fit import Problem
from analysis.gap.forward import Simulator, read_steady
from analysis.gap.gaussian import Nuisances
from analysis.gap.observe import FORCES, SPEED, STRUTS
from analysis.gap.regimes import contrasts
from hardware.description.channels import SHAFT_ANGLE
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
        The largest one, with its run, in words.
    stated
        As ``rms``, of the simulation as it is stated, with no number free; NaN where nobody asked.
    """

    what: str
    rms: float
    count: int
    worst: str
    stated: float = math.nan

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
        Carriage, shaft, photocell, strut motion, forces with the simulated motion, forces with the
        measured motion; those for which there are channels.
    contrasts
        The forces' difference by medium, strut phase, speed, amplitude and frequency.
    """

    steps: tuple[Gap, ...]
    contrasts: tuple[Gap, ...]

    @property
    def stages(self) -> tuple[StageName, ...]:
        """Stages that the walk leaves as the gap's place, from upstream down."""
        beyond = {one.what for one in self.steps if one.beyond}
        if CARRIAGE in beyond:
            return (StageName.CARRIAGE,)
        if MOTION in beyond:
            return (StageName.DRIVE, StageName.MECHANISM, StageName.PHOTOCELL)
        if FORCE_FED in beyond or FORCE in beyond:
            return (StageName.STRUCTURE, StageName.MODEL, StageName.DYNAMOMETERS,
                    StageName.ACQUISITION)  # fmt: skip
        return ()


CARRIAGE: Final = "carriage"
SHAFT: Final = "shaft"
TIMING: Final = "photocell and frequency"
MOTION: Final = "strut motion"
FORCE: Final = "forces"
FORCE_FED: Final = "forces, with the measured motion"
BESIDE: Final = "beside the harmonics"


def walk(problem: Problem) -> Walk:
    """Walk along the chain."""
    stack = problem.simulator.stack
    whole = problem.residual
    left = left_by_step(problem, whole)
    of_step = {what: _of_step(stack.components, what) for what in CHAIN}
    steps = [gap_of(stack, left, what, rows, whole) for what, rows in of_step.items()]
    fed = _fed(problem)
    if fed is not None:
        after = CHAIN.index(FORCE) + 1
        steps.insert(after, gap_of(stack, fed, FORCE_FED, of_step[FORCE]))
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
    for what in CHAIN:
        own = _of_step(parts, what)
        upstream |= own
        part = problem.nuisances.among(upstream)
        fitted = part.fitted(residual[upstream])
        found[own] = residual[own] - problem.nuisances.columns[own] @ fitted
    return found


CHAIN: Final = (CARRIAGE, SHAFT, TIMING, MOTION, FORCE, BESIDE)


def step_of(one: Component) -> str:
    """Return the step of the chain that a component tells of."""
    steps = {"": TIMING, SHAFT_ANGLE.name: SHAFT, SPEED: CARRIAGE, **dict.fromkeys(STRUTS, MOTION)}
    return steps.get(one.channel) or (FORCE if one.part in _HARMONIC else BESIDE)


def _of_step(components: Sequence[Component], what: str) -> NDArray[np.bool_]:
    return np.array([step_of(one) == what for one in components])


def gap_of(
    stack: Stack,
    left: FloatArray,
    what: str,
    rows: NDArray[np.bool_],
    whole: FloatArray | None = None,
) -> Gap:
    """Return the gap over some components: what is left of it, and the whole where it is given."""
    if not rows.any():
        return Gap(what, 0.0, 0, "")
    size = np.where(rows, np.abs(left), 0.0)
    worst = int(np.argmax(size))
    run = stack.runs[stack.run[worst]].name
    said = f"{run}: {stack.components[worst]} {left[worst]:+.1f} u"
    stated = math.nan if whole is None else _rms(whole[rows])
    return Gap(what, _rms(left[rows]), int(rows.sum()), said, stated)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def _contrasts(problem: Problem, left: FloatArray) -> Iterator[Gap]:
    stack, whole = problem.simulator.stack, problem.residual
    forces = np.array([one.channel in FORCES for one in stack.components])
    for kind in contrasts(stack.runs):
        rows = forces & np.isin(stack.run, kind.runs)
        yield gap_of(stack, left, str(kind), rows, whole)


def _fed(problem: Problem) -> FloatArray | None:
    """Return what is left with the measured motion fed to the model; ``None`` without sensors."""
    simulator = problem.simulator
    seen = {one.channel for one in simulator.stack.components}
    if not set(STRUTS) <= seen or simulator.rig.drive.motor is not None:
        return None
    pairs = [_run_fed(simulator, run) for run in simulator.stack.runs]
    found, wider = (np.concatenate(parts) for parts in zip(*pairs, strict=True))
    sigma = simulator.stack.uncertainty
    shrink = sigma / np.hypot(sigma, wider)
    residual: FloatArray = problem.whitened(simulator.stack.values - found) * shrink
    forces = _of_step(simulator.stack.components, FORCE)
    part = Nuisances((problem.nuisances.columns * shrink[:, None])[forces])
    left: FloatArray = np.zeros_like(residual)
    left[forces] = residual[forces] - part.columns @ part.fitted(residual[forces])
    return left


def _run_fed(simulator: Simulator, run: GapRun) -> tuple[FloatArray, FloatArray]:
    """Return a run with the measured motion, and what that motion's noise makes of it."""
    rig, set_point = switch_on(simulator.on, simulator.rig, run.set_point, run.place)
    if not run.turns:  # where its struts stand is measured in any case
        still = steady_at_rest(rig, set_point, run)
        return still, np.zeros_like(still)
    period = Period(set_point.frequency_hz, _ORDERS, _POINTS)
    chain = rig.chain(set_point)
    turn = np.exp(-period.s * steady_state(chain, period).reference_s)

    def fed(noise: dict[str, ComplexArray]) -> FloatArray:
        state = steady_state(chain, period, _measured_motion(run, period, turn, noise))
        layout = run.observed.layout
        return read_steady(state, layout, run.set_point, simulator.reference_channel)

    base = fed({})
    moved = [fed({name: _noise(run, name, period.orders)}) - base for name in STRUTS]
    return base, np.asarray(np.hypot(*(_whole(run, change) for change in moved)))


def _noise(run: GapRun, channel: str, orders: int) -> ComplexArray:
    """Return one standard deviation of each harmonic's cosine."""
    found = np.zeros(orders + 1, dtype=np.complex128)
    seen = run.observed
    for one, sigma in zip(seen.components, seen.uncertainty, strict=True):
        if one.channel == channel and one.part in (Part.MEAN, Part.QUADRATURE):
            found[one.order] = sigma
    return found


def _whole(run: GapRun, change: FloatArray) -> FloatArray:
    """Return each harmonic's amplitude in place of both its parts: noise has any phase."""
    squares: dict[tuple[str, int], float] = defaultdict(float)
    keys = [(one.channel, one.order) for one in run.observed.components]
    for key, value in zip(keys, change, strict=True):
        squares[key] += float(value) ** 2
    return np.sqrt([squares[key] for key in keys])


def _measured_motion(
    run: GapRun, period: Period, turn: ComplexArray, noise: Mapping[str, ComplexArray]
) -> dict[str, ComplexArray]:
    """Return displacement, velocity and acceleration of both struts from measured harmonics.

    Differentiated order by order in the frequency domain: samples are never differenced.
    """
    names = (
        (signals.DISPLACEMENT_AFT, signals.VELOCITY_AFT, signals.ACCELERATION_AFT),
        (signals.DISPLACEMENT_FORE, signals.VELOCITY_FORE, signals.ACCELERATION_FORE),
    )
    given = {}
    for displacement, velocity, acceleration in names:
        own = _spectrum(run, displacement.name, period.orders)
        harmonics = (own + noise.get(displacement.name, 0.0)) * turn
        given[displacement.name] = harmonics
        given[velocity.name] = period.s * harmonics
        given[acceleration.name] = period.s**2 * harmonics
    return given


def _spectrum(run: GapRun, channel: str, orders: int) -> ComplexArray:
    found = np.zeros(orders + 1, dtype=np.complex128)
    found[0] = run.observed.value(channel, Part.MEAN)
    for order in range(1, orders + 1):
        part = [run.observed.value(channel, one, order) for one in (Part.QUADRATURE, Part.IN_PHASE)]
        if np.isfinite(part).all():
            found[order] = complex(part[0], -part[1])
    return found
