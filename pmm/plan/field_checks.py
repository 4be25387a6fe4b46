"""What the field advises: tank modes, structural modes, speed ripple, cycles, samples.

None of it refuses a plan.
"""

import math
from collections.abc import Iterator
from typing import Final

import numpy as np

from hardware.description.kinds import RunKind
from pmm.plan.check_table import CYCLES, RIPPLE, SAMPLING, SETTLING, STRUCTURE, TANK_MODE
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.motion_peaks import frequencies_hz, omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import TankTable
from pmm.plan.run_plan import RunPlan
from pmm.plan.shaft_load import motor_of, shaft_load

_NEAR_TANK_MODE: Final = TANK_MODE.numbers[0]
_STRONG_HARMONICS: Final = 3
_HARMONICS: Final = 6


def field_findings(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield what the field advises against in a run, and what is near it.

    Of many lines each is looked at, and the one that is worst is told.
    """
    if not run.oscillates:
        return
    yield from _cycles(run)
    yield from _sampling(run, rig)
    yield from _structure(run, rig)
    yield from _ripple(run, rig)
    if not run.kind.in_air:
        yield from _tank_modes(run, rig)


def _cycles(run: RunPlan) -> Iterator[PlanFinding]:
    for check, value in ((CYCLES, run.periods), (SETTLING, run.settling_periods)):
        (limit,) = check.numbers
        if value < limit:
            text = (
                f"{check.quantity}: {value}, where at least {limit:g} are advised: {check.reason}"
            )
            yield PlanFinding(PlanVerdict.WARN, check.quantity, float(value), limit, run.name, text)


def _sampling(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    nyquist, highest = rig.sample_rate_hz / 2.0, _HARMONICS * frequencies_hz(run)[-1]
    if highest >= nyquist:
        yield PlanFinding(
            PlanVerdict.WARN,
            SAMPLING.quantity,
            highest,
            nyquist,
            run.name,
            f"the 6th harmonic is {highest:.4g} Hz, not below half the sampling at "
            f"{rig.sample_rate_hz:g} Hz: {SAMPLING.reason}",
        )


def _structure(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield harmonics within 10 % of a structural mode, or three damping ratios if that is more."""
    nearest, damped = STRUCTURE.numbers
    harmonics = [
        (order, order * frequency_hz)
        for frequency_hz in frequencies_hz(run)
        for order in range(1, _HARMONICS + 1)
    ]
    for mode in rig.modes:
        near = max(nearest, damped * mode.damping_ratio)
        offs = [
            (order > _STRONG_HARMONICS, abs(harmonic / mode.frequency_hz - 1.0), order, harmonic)
            for order, harmonic in harmonics
        ]
        within = [off for off in offs if off[1] < near]
        if not within:
            continue
        weak, off, order, harmonic = min(within)
        yield PlanFinding(
            PlanVerdict.NOTE if weak else PlanVerdict.WARN,
            STRUCTURE.quantity,
            off,
            near,
            run.name,
            f"harmonic {order}{_of_line(run, harmonic / order)} at {harmonic:.4g} Hz is "
            f"{harmonic / mode.frequency_hz - 1.0:+.1%} off the mode {mode.name!r} at "
            f"{mode.frequency_hz:.4g} Hz; keep {near:.0%} off",
        )


def _of_line(run: RunPlan, frequency_hz: float) -> str:
    """Say which line of many it is."""
    return f" of the line at {frequency_hz:.4g} Hz" if run.set_point.own_orders else ""


def _ripple(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield by how much the shaft's speed varies over a turn, where its motor is stated."""
    motor = motor_of(rig)
    load = None if motor is None else shaft_load(run, rig, motor)
    if motor is None or load is None:
        return
    from analysis.speed_loop.loop import ShaftLoop

    loop = ShaftLoop(motor, motor.loop, load.added_inertia_kg_m2)
    parts = np.abs(loop.ripple(load.torques_n_m, omega_of(run)))
    (limit,), largest = RIPPLE.numbers, float(parts.max())
    order = int(parts.argmax()) + 1
    verdict = PlanVerdict.WARN if largest > limit else PlanVerdict.NOTE
    text = f"{RIPPLE.quantity}: {largest:.2%} at {order} times a turn: {RIPPLE.reason}"
    yield PlanFinding(verdict, RIPPLE.quantity, largest, limit, run.name, text)


def tank_modes_hz(tank: TankTable) -> tuple[float, ...]:
    """Return the frequencies of the tank's transverse waves, of lengths ``2 W / n``.

    From ``omega^2 = g k tanh(k h)``; up to where they lie so close that none can be avoided.
    """
    modes: list[float] = []
    for n in range(1, int(1.0 / (4.0 * _NEAR_TANK_MODE)) + 1):
        k = math.pi * n / tank.width_m
        shallow = 1.0 if tank.depth_m is None else math.tanh(k * tank.depth_m)
        modes.append(math.sqrt(tank.gravity_m_s2 * k * shallow) / (2.0 * math.pi))
    return tuple(modes)


def _tank_modes(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield a tank mode nearby; at speed the model runs away from what it stirs up."""
    if rig.tank is None or run.kind is RunKind.RESTORING:
        return
    speed, frequencies = run.set_point.carriage_speed_m_s, frequencies_hz(run)
    for n, mode in enumerate(tank_modes_hz(rig.tank), 1):
        size, frequency = min((abs(each / mode - 1.0), each) for each in frequencies)
        if size < _NEAR_TANK_MODE:
            yield PlanFinding(
                PlanVerdict.NOTE if speed else PlanVerdict.WARN,
                TANK_MODE.quantity,
                size,
                _NEAR_TANK_MODE,
                run.name,
                f"{frequency:.4g} Hz is {frequency / mode - 1.0:+.1%} off the tank's transverse "
                f"mode {n} at {mode:.4g} Hz (wavelength {2.0 * rig.tank.width_m / n:.3g} m); keep "
                f"{_NEAR_TANK_MODE:.0%} off",
            )
