"""Simulated runs for the tests of this folder: a rig, set-points, and the way to a cycle."""

import math
from dataclasses import replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.strut_cycle import StrutCycle, measured_cycle
from analysis.readers.dataset import from_dataset
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.setpoint import Medium, SetPoint
from sim.rig import SimulatedRig
from sim.run import simulate

CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")
FACTORS = (("vdot", "v"), ("rdot", "r"))
"""Of translation and rotation, acceleration and velocity: the columns of matrices."""


def strut_cycle(
    rig: SimulatedRig, set_point: SetPoint, *, name: str, seed: int = 0, periods: int = 8,
    rate_hz: float = 200.0, channels: tuple[str, ...] = CHANNELS,
) -> StrutCycle:  # fmt: skip
    record = simulate(rig, set_point, periods=periods, sample_rate_hz=rate_hz, seed=seed, name=name)
    settings = ResolverSettings(channels=channels, harmonics=3)
    analysis = analyse(from_dataset(record), settings=settings)
    return measured_cycle(analysis, rig.oscillator)


def loaded(
    rig: SimulatedRig, set_point: SetPoint, *, dry: bool = False, **options: object
) -> BodyCycle:
    """A run with the body's inertia and the water's restoring named."""
    run = strut_cycle(rig, set_point, **options).model()  # type: ignore[arg-type]
    if dry or set_point.medium is Medium.AIR:
        return run
    return run.without(rig.body, np.array(rig.water.restoring))


def pure(
    frequency_hz: float, eccentricity_m: float, speed_m_s: float = 0.0
) -> tuple[SetPoint, ...]:
    """Both motions: strut phases 0 and pi."""
    first = SetPoint(frequency_hz, eccentricity_m, 0.0, speed_m_s)
    return first, replace(first, strut_phase_rad=math.pi)


def matrix(fit: CycleFit, *, inertial: bool) -> np.ndarray:
    """Coefficients with a row each for force and moment; NaN where a motion tells none."""
    found = np.full((2, 2), np.nan)
    for term, value in zip(fit.terms, fit.values, strict=True):
        for column, (rate, velocity) in enumerate(FACTORS):
            if term.factors == (rate if inertial else velocity,):
                found[term.row, column] = value
    return found
