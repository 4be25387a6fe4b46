"""Draws a rig, a model and the runs of a campaign."""

import math
from dataclasses import dataclass, replace

import numpy as np

from tests.sealed.generator.arranged import arranged
from tests.sealed.generator.catalogue import CATALOGUE
from tests.sealed.generator.effect import Effect, heavier
from tests.sealed.generator.forms import formed
from tests.sealed.generator.imperfect import Tolerance, tolerated
from tests.sealed.generator.parameters import FloatArray, P, neutral
from tests.sealed.generator.priors import Prior, priors
from tests.sealed.generator.rig import CHANNELS, Medium, Noise, Rig, Run
from tests.sealed.generator.water import Believed
from tests.sealed.generator.water import tolerated as tolerated_water
from tests.sealed.generator.wider import believed_along, wider_rig, wider_runs
from tests.sealed.generator.worlds import World

Known = Prior | Tolerance

ALL = (*CHANNELS, "photocell")
_SENSORS = (
    ALL,
    tuple(name for name in ALL if name != "shaft_angle"),
    tuple(name for name in ALL if not name.startswith("displacement")),
    ("force_aft", "force_fore", "photocell"),
    ("displacement_aft", "displacement_fore", "force_aft", "force_fore", "carriage_speed"),
)
# How much larger the drive is than the neutral one: load moves no shaft by what is seen.
FLYWHEEL = 400.0
REGIMES = ("frequency", "amplitude", "phase", "medium")


@dataclass(frozen=True)
class Campaign:
    """What is believed of a rig and what is run with it.

    Attributes
    ----------
    believed
        Parameters as the campaign's file states them.
    held_out
        Withheld runs, one for each of ``REGIMES``.
    world
        Whose assumptions hold.
    effects
        The catalogue, each effect in the form that it has here.
    tolerances
        What is known within limits beside the rig's and model's own numbers.
    table
        What is believed of the water over frequency; ``None`` where constants are.
    """

    rig: Rig
    believed: FloatArray
    runs: tuple[Run, ...]
    held_out: tuple[Run, ...]
    world: World
    effects: tuple[Effect, ...] = CATALOGUE
    tolerances: tuple[Known, ...] = ()
    table: Believed | None = None

    @property
    def known(self) -> tuple[Known, ...]:
        """Everything that is known within limits."""
        return (*priors(self.believed), *self.tolerances)


def _rig(rng: np.random.Generator) -> Rig:
    vertical = bool(rng.random() < 0.7)
    step = 1000.0 / 2**16
    noise = Noise(
        white_n=float(rng.uniform(0.1, 0.4)),
        coloured_n=float(rng.uniform(0.03, 0.15)),
        colour_s=float(rng.uniform(0.05, 0.3)),
        step_n=step,
        displacement_m=float(rng.uniform(1e-5, 4e-5)),
    )
    return Rig(
        plane="vertical" if vertical else "horizontal",
        half_spacing_m=0.5,
        rod_length_m=None if vertical or rng.random() < 0.3 else float(rng.uniform(1.2, 2.0)),
        sample_rate_hz=float(rng.choice([150.0, 200.0] if vertical else [100.0, 120.0])),
        sensors=_SENSORS[int(rng.choice(5, p=[0.5, 0.12, 0.14, 0.12, 0.12]))],
        noise=noise,
    )


def believed(rig: Rig, rng: np.random.Generator) -> FloatArray:
    """Return parameters of a model of 50 to 90 kg and the water about it."""
    p = neutral()
    heavier(p, FLYWHEEL)
    mass = rng.uniform(50.0, 90.0)
    p[P.LEVER] = rig.half_spacing_m
    p[P.ROD] = rig.rod_length_m or 0.0
    p[P.MASS], p[P.INERTIA] = mass, mass * rng.uniform(0.32, 0.45)
    p[P.CG_X], p[P.CG_Z] = rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03)
    p[P.ADDED_00], p[P.ADDED_11] = mass * rng.uniform(0.8, 1.2), mass * rng.uniform(0.22, 0.35)
    p[P.DAMPING_00], p[P.DAMPING_11] = rng.uniform(120.0, 260.0), rng.uniform(30.0, 70.0)
    p[P.ADDED_01] = p[P.ADDED_10] = rng.uniform(-4.0, 4.0)
    p[P.DAMPING_01], p[P.DAMPING_10] = rng.uniform(-15.0, 15.0), rng.uniform(-15.0, 15.0)
    if rig.plane == "vertical":
        p[P.RESTORING_00], p[P.RESTORING_11] = (
            mass * rng.uniform(70, 110),
            mass * rng.uniform(25, 40),
        )
        p[P.RESTORING_01] = p[P.RESTORING_10] = rng.uniform(-300.0, 300.0)
    else:
        p[P.AFT_SIGN] = p[P.INCIDENCE] = -1.0
        p[P.GRAVITY] = 0.0
    return p


def _eccentricity(rig: Rig, frequency_hz: float, share: float) -> float:
    """Return an eccentricity that loads a strut by ``share`` of 60 N or so, within the rig's.

    That turns the model by some hundredths of a radian; world C has rigs that turn it further.
    """
    inertia = 150.0 * (2.0 * math.pi * frequency_hz) ** 2
    stiffness = 7000.0 if rig.plane == "vertical" else 0.0
    force = max(inertia, stiffness, 800.0)
    top = 0.014 if rig.plane == "vertical" else 0.015
    return round(float(min(max(share * 100.0 / force, 0.002), top)), 4)


def _settings(rig: Rig, rng: np.random.Generator) -> list[Run]:
    low, high = (0.45, 1.25) if rig.plane == "vertical" else (0.25, 0.75)
    frequencies = np.round(np.geomspace(low, high, 4) * rng.uniform(0.93, 1.07, 4), 3)
    speed, periods = float(np.round(rng.uniform(0.8, 1.4), 2)), int(rng.integers(6, 10))
    always = [(i, 0.0, 0.6, speed, "water") for i in range(4)]
    always += [(i, math.pi, 0.6, speed, "water") for i in (0, 2)]
    always += [(1, 0.0, 0.3, speed, "water"), (2, 0.0, 1.0, speed, "water")]
    more = [
        (1, 0.0, 0.6, 0.0, "air"), (3, math.pi, 0.6, 0.0, "air"), (2, math.pi, 0.6, 0.0, "water"),
        (1, 1.57, 0.6, speed, "water"), (3, 0.0, 1.0, 0.0, "water"),
    ]  # fmt: skip
    chosen = rng.permutation(len(more))[: int(rng.integers(0, 5))]
    rows = [*always, *(more[i] for i in sorted(chosen))]
    return [
        Run("", float(frequencies[i]), _eccentricity(rig, float(frequencies[i]), share), phase,
            u, "air" if medium == "air" else "water", periods)
        for i, phase, share, u, medium in rows
    ]  # fmt: skip


def _withheld(rig: Rig, runs: list[Run]) -> tuple[Run, ...]:
    first, middle = runs[0], runs[2]
    between = round(math.sqrt(middle.frequency_hz * runs[3].frequency_hz), 3)
    larger = 0.45 * middle.eccentricity_m
    other: Medium = "water" if any(run.medium == "air" for run in runs) else "air"
    return (
        replace(middle, name="withheld-1", frequency_hz=between,
                eccentricity_m=_eccentricity(rig, between, 0.6)),
        replace(middle, name="withheld-2", eccentricity_m=round(middle.eccentricity_m + larger, 4)),
        replace(middle, name="withheld-3", strut_phase_rad=2.1),
        replace(first, name="withheld-4", medium=other, carriage_speed_m_s=0.0),
    )  # fmt: skip


def design(rng: np.random.Generator, where: World) -> Campaign:
    """Return a campaign: rig, beliefs, runs in random order and 4 withheld ones."""
    rig = wider_rig(_rig(rng), where, rng)
    settings = _settings(rig, rng)
    withheld = _withheld(rig, settings)
    settings = wider_runs(settings, rig, where, rng)
    if rig.arrangement is not None:
        # What is foretold is a run among those that were made: its angles are theirs.
        withheld = tuple(replace(run, drift_by=rig.drift_by) for run in withheld)
    hour, runs = 0.0, []
    for number, i in enumerate(rng.permutation(len(settings)), start=1):
        waited = float(rng.uniform(120.0, 600.0))
        hour += (waited + settings[i].duration_s) / 3600.0
        runs.append(replace(settings[i], name=f"run-{number:02d}", hour=hour, waited_s=waited))
    p = believed(rig, rng)
    fast = [run.frequency_hz for run in runs]
    p[P.MIDDLE_HZ] = math.sqrt(min(fast) * max(fast))
    p[P.MIDDLE_SPEED] = max(run.carriage_speed_m_s for run in settings) or 1.0
    if rig.arrangement is not None:
        p = arranged(p, *rig.arrangement)
        believed_along(p, rig, rng)
    known = (*tolerated_water(where), *tolerated(where, rng))
    effects = formed(rng) if "forms" in where else CATALOGUE
    return Campaign(rig, p, tuple(runs), withheld, where, effects, known)
