"""Speed of the simulator: whole runs, the periodic steady state, and scipy's integrators."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.simulator_rivals import METHODS, Method, ModelOnGauges
from benchmarks.timing import Contender, interleave
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.motor import Servo
from hardware.description.oscillator import VERTICAL_1963
from hardware.description.setpoint import SetPoint
from sim.acquisition.amplifier import LowPass
from sim.acquisition.channels import Digitiser
from sim.drive.prescribed_drive import DriveSettings, SpeedRipple
from sim.model.friction import Coulomb
from sim.model.law_point import Acting, Point
from sim.model.laws import Quadratic
from sim.model.mounting import Mounting
from sim.model.parameters import HullCoefficients
from sim.model.water.radiation import Radiation
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run

RATE_HZ = 200.0
_SET_POINT = SetPoint(1.0, 0.02, 0.7)
_LARGE = SetPoint(0.25, 0.5 * math.tan(math.radians(25.0)), math.pi, 1.2)  # yaw to 25 degrees
# The rivals' equations are those of small angles: of struts that stand ten thousand times as far
# apart, with moments as many times larger, angles are so small that ours are the same to 1e-10.
_APART = 1e4
_HALF_SPACING_M = _APART * VERTICAL_1963.half_spacing_m
_SCALE = np.array([[1.0, _APART], [_APART, _APART**2]])
MODEL = ModelOnGauges(
    frequency_hz=1.0,
    eccentricity_m=0.02,
    strut_phase_rad=0.7,
    ramp_s=1.5,
    mass=_SCALE * np.array([[145.0, 3.0], [3.0, 49.5]]),
    damping=_SCALE * np.array([[100.0, 12.0], [12.0, 30.0]]),
    stiffness=_SCALE * np.array([[6900.0, 345.0], [345.0, 2400.0]]),
    memory_gain=_SCALE * np.diag([500.0, 150.0]),
    memory_rad_s=6.0,
    memory_ratio=0.5,
    quadratic_n_s2_m2=300.0,
    gauge_n_m=5e4,
    gauge_n_s_m=200.0,
    to_struts=np.array([[1.0, _HALF_SPACING_M], [1.0, -_HALF_SPACING_M]]),
)


def five_effects(rig: SimulatedRig) -> SimulatedRig:
    """Return a rig with gauges that give way, friction, drag, speed ripple and amplifier lag."""
    force = replace(rig.acquisition.force_aft or Digitiser(), low_pass=LowPass(20.0))
    laws = (Acting(Coulomb(0.5), Point.AFT), Acting(Coulomb(0.5), Point.FORE))
    return replace(
        rig,
        mounting=Mounting(2e5, 300.0),
        forces=(*laws, Acting(Quadratic(200.0), Point.TRANSLATION, in_water=True)),
        drive=replace(rig.drive, ripple=(SpeedRipple(2, 0.003),)),
        acquisition=replace(rig.acquisition, force_aft=force, force_fore=force),
    )


def rig_on_gauges() -> SimulatedRig:
    """Return the rig whose equations :class:`ModelOnGauges` writes down."""
    one = MODEL
    rig = vertical_rig().ideal()
    body = Body(mass_kg=70.0, inertia_kg_m2=27.5 * _APART**2)
    w, eye = one.memory_rad_s, np.eye(2)
    memory = Radiation(
        one.mass - np.diag([body.mass_kg, body.inertia_kg_m2]),
        np.block([[0.0 * eye, eye], [-(w**2) * eye, -2.0 * one.memory_ratio * w * eye]]),
        np.vstack([0.0 * eye, eye]),
        np.hstack([0.0 * eye, one.memory_gain]),
    )
    return replace(
        rig,
        oscillator=replace(rig.oscillator, half_spacing_m=_HALF_SPACING_M),
        body=body,
        water=HullCoefficients(damping=_rows(one.damping), restoring=_rows(one.stiffness)),
        radiation=memory,
        mounting=Mounting(one.gauge_n_m, one.gauge_n_s_m),
        forces=(Acting(Quadratic(one.quadratic_n_s2_m2)),),
        drive=DriveSettings(start_ramp_s=one.ramp_s),
    )


def _rows(matrix: FloatArray) -> Any:
    return tuple(tuple(row) for row in matrix.tolist())


def whole_run(
    rig: SimulatedRig, count: int, point: SetPoint = _SET_POINT
) -> Callable[[], FloatArray]:
    """Return a run in one call, from the rig to its signals; it returns both struts' forces."""

    def call() -> FloatArray:
        chain = rig.chain(point)
        _, run = chain.run(chain.start(RATE_HZ, 1), count)
        return np.array([run["force_aft"], run["force_fore"]])

    return call


def run(quick: bool, report: Report) -> Outcome:
    """Time runs and steady states, then the rivals at the accuracy that ours has."""
    rounds, count = (2, 400) if quick else (30, 4000)
    nominal = vertical_rig()
    five = five_effects(nominal)
    felt = replace(five, drive=replace(five.drive, motor=Servo()))
    rigs = {
        "nominal": (nominal, _SET_POINT),
        "nominal, yaw to 25 degrees": (horizontal_rig(), _LARGE),
        "five effects on": (five, _SET_POINT),
        "five effects, drive feels the load": (felt, _SET_POINT),
    }
    runs = {name: Contender(name, whole_run(rig, count, at)) for name, (rig, at) in rigs.items()}
    steady = {
        name: Contender(name, lambda rig=rig, at=at: steady_run(rig, at))  # type: ignore[misc]
        for name, (rig, at) in rigs.items()
    }
    for one in (*runs.values(), *steady.values()):
        one.call()  # compiled, and what is computed once
    interleave([*runs.values(), *steady.values()], rounds, report)
    cost = {name: 1e6 * one.best_s / (2 * count) for name, one in runs.items()}
    rows: list[Row] = [
        {
            "rig": name,
            "us per sample and strut": cost[name],
            "ms a run": 1e3 * runs[name].best_s,
            "periodic steady state, ms": 1e3 * steady[name].best_s,
        }
        for name in rigs
    ]
    growth = _growth(five, quick, report)
    rivals, over_run, over_steady = _rivals(quick, report)
    measured = {
        "nominal_us": cost["nominal"],
        "five_effects_us": cost["five effects on"],
        "five_effects_motor_us": cost["five effects, drive feels the load"],
        "large_us": cost["nominal, yaw to 25 degrees"],
        "steady_ms": 1e3 * steady["nominal"].best_s,
        "steady_large_ms": 1e3 * steady["nominal, yaw to 25 degrees"].best_s,
        "steady_five_effects_ms": 1e3 * steady["five effects on"].best_s,
        "growth": float(growth[-1]["over the shortest"]),
        "solve_ivp_over_run": over_run,
        "solve_ivp_over_steady": over_steady,
    }
    tables = {
        f"Runs of {count} samples at 200 Hz": rows,
        "Growth with the samples, five effects on": growth,
        "Model on gauges, with memory and quadratic drag": rivals,
    }
    return Outcome(tables, measured, _NOTES)


def _growth(rig: SimulatedRig, quick: bool, report: Report) -> list[Row]:
    counts = (400, 800) if quick else (4_000, 16_000, 64_000)
    timed = [Contender(f"{count} samples", whole_run(rig, count)) for count in counts]
    interleave(timed, 2 if quick else 8, report)
    each = [1e6 * one.best_s / (2 * count) for one, count in zip(timed, counts, strict=True)]
    return [
        {"samples": count, "us per sample and strut": cost, "over the shortest": cost / each[0]}
        for count, cost in zip(counts, each, strict=True)
    ]


def _rivals(quick: bool, report: Report) -> tuple[list[Row], float, float]:
    """Time ours, and each integrator at the loosest tolerance that is as accurate."""
    time_s = np.arange(400 if quick else 4000) / RATE_HZ
    report("reference solution")
    true = MODEL.forces(time_s, "DOP853", 1e-12)
    rig = rig_on_gauges()
    ours = Contender("whole run", whole_run(rig, time_s.size))
    steady = Contender("periodic steady state", lambda: steady_run(rig, _SET_POINT))
    errors = {
        "run": _error(whole_run(rig, time_s.size)(), true),
        "steady": _steady_error(rig, true),
    }
    settled = _settled(true, errors["steady"])
    rows: list[Row] = []
    interleave([ours, steady], 2 if quick else 30, report)
    best = {}
    for own, stretch in ((ours, time_s), (steady, time_s[:settled])):
        key = "run" if own is ours else "steady"
        samples = time_s.size if key == "run" else int(RATE_HZ)
        rows.append(_row(own.name, samples, errors[key], own.best_s, own.best_s))
        methods = METHODS[: 1 if quick else None]
        timed = [_rival(method, stretch, true, errors[key]) for method in methods]
        interleave([one for one, _ in timed], 1 if quick else 3, report)
        rows += [_row(one.name, stretch.size, e, one.best_s, own.best_s) for one, e in timed]
        best[key] = min(one.best_s for one, _ in timed) / own.best_s
    return rows, best["run"], best["steady"]


def _rival(
    method: Method, time_s: FloatArray, true: FloatArray, error: float
) -> tuple[Contender, float]:
    """Return an integrator at the loosest tolerance, by factors of 10, that errs no more."""
    for exponent in range(-3, -12, -1):
        tolerance = 10.0**exponent
        found = _error(MODEL.forces(time_s, method, tolerance), true[:, : time_s.size])
        if found <= error:
            break
    name = f"rival: solve_ivp, {method}, rtol {tolerance:.0e}"
    return Contender(name, lambda: MODEL.forces(time_s, method, tolerance)), found


def _error(found: FloatArray, true: FloatArray) -> float:
    return float(np.abs(found - true).max() / np.abs(true).max())


def _steady_error(rig: SimulatedRig, true: FloatArray) -> float:
    """Error of the steady state against the last period of the reference, wherever that begins."""
    state = steady_run(rig, _SET_POINT)
    points = int(RATE_HZ)
    shaft_rad = -np.pi + 2.0 * np.pi * (np.arange(points) / RATE_HZ - MODEL.ramp_s / 2.0)
    # In the steady state the shaft's angle is 0 at time 0.
    turns = np.exp(1j * np.outer(np.arange(state.spectra["force_aft"].size), shaft_rad))
    both = np.array([state.spectra["force_aft"], state.spectra["force_fore"]])
    return _error((both @ turns).real, true[:, -points:])


def _settled(true: FloatArray, error: float) -> int:
    """Return the samples until a period of the reference is its last one to within an error."""
    points = int(RATE_HZ)
    for end in range(points, true.shape[1], points):
        if _error(true[:, end - points : end], true[:, -points:]) <= error:
            return end
    return int(true.shape[1])


def _row(name: str, samples: int, error: float, time_s: float, ours_s: float) -> Row:
    return {
        "method": name,
        "samples": samples,
        "largest error over peak": error,
        "ms": 1e3 * time_s,
        "over ours": time_s / ours_s,
    }


_NOTES = (
    "A run goes from the rig's parameters to every signal of the chain, two struts, with noise and "
    "converters; writing the dataset (some 2 ms) is not in it. Compiled code is warm.",
    "Five effects: gauges that give way, Coulomb friction at both struts, quadratic drag, ripple "
    "of the shaft's speed, amplifier lag. The last row adds a servo that feels the load.",
    "The rivals integrate the same equations, with a right-hand side in NumPy, each at the loosest "
    "tolerance by powers of ten that is as accurate as ours; errors are against DOP853 at 1e-12. "
    "For the steady state they stop when a period differs from the last by no more than our error.",
)

BENCHMARK = Benchmark("simulator", "Simulator", run)
