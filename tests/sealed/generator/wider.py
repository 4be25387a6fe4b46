"""Campaigns of worlds B and C: what differs in rig, runs and sensors from those of world A."""

import math
from dataclasses import replace

import numpy as np

from tests.sealed.generator.arranged import ARRANGED, DRIFTS
from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.rig import CHANNELS, Rig, Run
from tests.sealed.generator.worlds import World

WORKING_HZ = 200.0
_MOMENT_N_M = 150.0  # what the inertia of a yawing or pitching model may take


def wider_rig(rig: Rig, world: World, rng: np.random.Generator) -> Rig:
    """Return a rig with another rate, converter, noise, sensors and arrangement."""
    if "rate_hz" not in world:
        return rig
    step = 1000.0 / 2.0 ** world.count("bits", rng)
    noise = replace(
        rig.noise,
        coloured_n=world.value("coloured_n", rng),
        step_n=min(step, 2.0 * rig.noise.white_n),
        step_m=world.value("displacement_step_m", rng),
        wander_n=world.tolerances["wander_n"] * float(rng.uniform(0.2, 2.0)),
        wander_s=world.tolerances["wander_s"],
    )
    arrangement = None
    if world.happens("arranged_share", rng):
        arrangement = ARRANGED[int(rng.integers(len(ARRANGED)))]
    return replace(
        rig,
        sample_rate_hz=round(world.value("rate_hz", rng), 1),
        sensors=_sensors(world, rng),
        noise=noise,
        arrangement=arrangement,
        drift_by=DRIFTS[int(rng.integers(len(DRIFTS)))],
        rod_length_m=None if arrangement else rig.rod_length_m,
        still_reads_zero=world.happens("still_carriage_share", rng),
        noise_stated=not world.happens("unstated_noise_share", rng),
    )


def _sensors(world: World, rng: np.random.Generator) -> tuple[str, ...]:
    """Return any sensors of which one tells the phase: photocell, encoder or the aft strut's."""
    there = {name: world.happens("sensor_share", rng) for name in (*CHANNELS, "photocell")}
    there["force_aft"] = there["force_fore"] = True
    if world.happens("one_force_share", rng):
        there["force_fore"] = False
    if not (there["photocell"] or there["shaft_angle"] or there["displacement_aft"]):
        there["photocell"] = True
    return tuple(name for name, here in there.items() if here)


def wider_runs(runs: list[Run], rig: Rig, world: World, rng: np.random.Generator) -> list[Run]:
    """Return more or fewer runs, at other speeds, angles and drifts, not equally loud."""
    if "speeds" in world:
        low, high = world.draws["speeds"]
        runs = [
            replace(run, carriage_speed_m_s=round(
                run.carriage_speed_m_s * float(rng.choice([low, 1.0, high])), 3))
            for run in runs
        ]  # fmt: skip
    if "runs" in world:
        runs = _so_many(runs, world.count("runs", rng), rng)
        runs = [replace(run, loud=world.value("loud", rng)) for run in runs]
    if rig.arrangement is not None:
        largest = math.radians(world.value("angle_deg", rng))
        drifts = world.draws["drift_deg"]
        runs = [_turned(run, rig, largest, drifts, rng) for run in runs]
    return runs


def _so_many(runs: list[Run], count: int, rng: np.random.Generator) -> list[Run]:
    """Return so many of the runs, more of them at frequencies and phases between.

    A heave and a pitch are always among them.
    """
    first, turning = runs[0], next(run for run in runs if run.strut_phase_rad > 1.0)
    others = [run for run in runs if run is not first and run is not turning]
    kept = [first, turning, *(others[int(i)] for i in rng.permutation(len(others)))][:count]
    fast = [run.frequency_hz for run in runs]
    while len(kept) < count:
        model = runs[int(rng.integers(len(runs)))]
        kept.append(replace(
            model,
            frequency_hz=round(float(rng.uniform(min(fast), max(fast))), 3),
            eccentricity_m=round(model.eccentricity_m * float(rng.uniform(0.5, 1.0)), 4),
        ))  # fmt: skip
    return kept


def _turned(
    run: Run, rig: Rig, largest: float, drifts: tuple[float, float], rng: np.random.Generator
) -> Run:
    """Return a run whose struts turn the model by the largest angle that its moment allows."""
    angle = min(largest, _MOMENT_N_M / (60.0 * (2.0 * math.pi * run.frequency_hz) ** 2))
    e = rig.half_spacing_m * math.tan(angle) * float(rng.uniform(0.6, 1.0))
    drift = math.radians(float(rng.uniform(*drifts))) if rng.random() < 1.0 / 3.0 else 0.0
    if run.strut_phase_rad > 1.0:
        top = 0.1 if rig.plane == "vertical" else 0.35
        run = replace(run, eccentricity_m=round(min(e, top), 4))
    if rig.plane == "vertical" or run.medium == "air":
        drift = 0.0
    return replace(run, drift_rad=round(drift, 4), drift_by=rig.drift_by)


def believed_along(p: FloatArray, rig: Rig, rng: np.random.Generator) -> None:
    """Put what only angles of any size need into beliefs: the resistance."""
    if rig.arrangement is not None:
        p[P.SURGE_UU] = -float(rng.uniform(3.0, 8.0))


def working(rig: Rig) -> Rig:
    """Return the rig at the rate at which signatures are reckoned, as noisy in each line."""
    by = math.ceil(rig.sample_rate_hz / WORKING_HZ)
    if by == 1:
        return rig
    noise, less = rig.noise, 1.0 / math.sqrt(by)
    quiet = replace(
        noise,
        white_n=noise.white_n * less,
        step_n=noise.step_n * less,
        displacement_m=noise.displacement_m * less,
        step_m=noise.step_m * less,
        step_rad=noise.step_rad * less,
        carriage_m_s=noise.carriage_m_s * less,
    )
    return replace(rig, sample_rate_hz=rig.sample_rate_hz / by, noise=quiet)
