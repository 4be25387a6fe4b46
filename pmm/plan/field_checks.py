"""What the field advises: reduced frequency, waves, tank modes, structural modes, cycles, samples.

None of it refuses a plan.
"""

import math
from collections.abc import Iterator
from typing import Final

from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.plan.findings import Finding, Verdict
from pmm.plan.kinds import Motion, RunKind
from pmm.plan.motion_peaks import omega_of
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Tank
from pmm.plan.run_plan import RunPlan

# Bounds of omega L / U: noted from the first on, warned of from the second.
_REDUCED: Final = {
    Motion.SWAY: (1.0, 2.0),
    Motion.YAW: (2.0, 3.0),
    Motion.YAW_DRIFT: (2.0, 3.0),
}
_CRITICAL_TAU: Final = 0.25
_TAU_CLEARANCE: Final = 0.05
_NEAR_TANK_MODE: Final = 0.03
_NEAR_STRUCTURE: Final = 0.1
_STRONG_HARMONICS: Final = 3
_HARMONICS: Final = 6
_CYCLES: Final = 3


def field_findings(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    """Yield what the field advises against in a run, and what is near it."""
    if not run.oscillates:
        return
    yield from _cycles(run)
    yield from _sampling(run, rig)
    yield from _structure(run, rig)
    if run.kind.in_air:
        return
    yield from _reduced_frequency(run, rig)
    yield from _critical_tau(run, rig)
    yield from _tank_modes(run, rig)


def _cycles(run: RunPlan) -> Iterator[Finding]:
    for quantity, value, limit, advice in (
        ("periods after the transient", run.periods, _CYCLES, "scatter needs them"),
        ("settling periods", run.settling_periods, 1, "the gate would open in the transient"),
    ):
        if value < limit:
            text = f"{quantity}: {value}, where at least {limit} are advised: {advice}"
            yield Finding(Verdict.WARN, quantity, float(value), float(limit), run.name, text)


def _sampling(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    nyquist, highest = rig.sample_rate_hz / 2.0, _HARMONICS * run.set_point.frequency_hz
    if highest >= nyquist:
        yield Finding(
            Verdict.WARN,
            "6th harmonic [Hz]",
            highest,
            nyquist,
            run.name,
            f"the 6th harmonic is {highest:.4g} Hz, not below half the sampling at "
            f"{rig.sample_rate_hz:g} Hz: raise bus.sync_rate_hz or lower the frequency",
        )


def _structure(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    """Yield harmonics within 10 % of a structural mode, or three damping ratios if that is more."""
    for mode in rig.modes:
        near = max(_NEAR_STRUCTURE, 3.0 * mode.damping_ratio)
        for order in range(1, _HARMONICS + 1):
            harmonic = order * run.set_point.frequency_hz
            off = harmonic / mode.frequency_hz - 1.0
            if abs(off) >= near:
                continue
            strong = order <= _STRONG_HARMONICS
            yield Finding(
                Verdict.WARN if strong else Verdict.NOTE,
                "distance to a structural mode",
                abs(off),
                near,
                run.name,
                f"harmonic {order} at {harmonic:.4g} Hz is {off:+.1%} off the mode "
                f"{mode.name!r} at {mode.frequency_hz:.4g} Hz; keep {near:.0%} off",
            )


def _reduced_frequency(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    length = None if rig.model is None else rig.model.length_m
    speed = run.set_point.carriage_speed_m_s
    if length is None or speed == 0.0 or run.motion not in _REDUCED:
        return
    value = omega_of(run) * length / speed
    noted, warned = _REDUCED[run.motion]
    if value > noted:
        beyond = value > warned
        yield Finding(
            Verdict.WARN if beyond else Verdict.NOTE,
            "w' = w L / U",
            value,
            warned if beyond else noted,
            run.name,
            f"w' = {value:.3g}; for {run.motion} the field keeps it up to {noted:g}, at most "
            f"{warned:g}: lower the frequency or tow faster",
        )


def _critical_tau(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    gravity = STANDARD_GRAVITY_M_S2 if rig.tank is None else rig.tank.gravity_m_s2
    speed = run.set_point.carriage_speed_m_s
    value = omega_of(run) * speed / gravity
    if speed and abs(value - _CRITICAL_TAU) < _TAU_CLEARANCE:
        yield Finding(
            Verdict.WARN,
            "w U / g",
            value,
            _CRITICAL_TAU,
            run.name,
            f"w U / g = {value:.3f} is within {_TAU_CLEARANCE:g} of {_CRITICAL_TAU:g}, where the "
            "waves travel with the model: choose another frequency or speed",
        )


def tank_modes_hz(tank: Tank) -> tuple[float, ...]:
    """Return the frequencies of the tank's transverse waves, of lengths ``2 W / n``.

    From ``omega^2 = g k tanh(k h)``; up to where they lie so close that none can be avoided.
    """
    modes: list[float] = []
    for n in range(1, int(1.0 / (4.0 * _NEAR_TANK_MODE)) + 1):
        k = math.pi * n / tank.width_m
        shallow = 1.0 if tank.depth_m is None else math.tanh(k * tank.depth_m)
        modes.append(math.sqrt(tank.gravity_m_s2 * k * shallow) / (2.0 * math.pi))
    return tuple(modes)


def _tank_modes(run: RunPlan, rig: RigFile) -> Iterator[Finding]:
    """Yield a tank mode nearby; at speed the model runs away from what it stirs up."""
    if rig.tank is None or run.kind is RunKind.RESTORING:
        return
    frequency, speed = run.set_point.frequency_hz, run.set_point.carriage_speed_m_s
    for n, mode in enumerate(tank_modes_hz(rig.tank), 1):
        off = frequency / mode - 1.0
        if abs(off) < _NEAR_TANK_MODE:
            yield Finding(
                Verdict.NOTE if speed else Verdict.WARN,
                "distance to a tank mode",
                abs(off),
                _NEAR_TANK_MODE,
                run.name,
                f"{frequency:.4g} Hz is {off:+.1%} off the tank's transverse mode {n} at "
                f"{mode:.4g} Hz (wavelength {2.0 * rig.tank.width_m / n:.3g} m); keep "
                f"{_NEAR_TANK_MODE:.0%} off",
            )
