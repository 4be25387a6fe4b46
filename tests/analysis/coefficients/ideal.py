"""Runs built from closed-form phasors, with a given scatter: quick, for coverage and budgets."""

import math

import numpy as np

from analysis.coefficients.measured import StrutRun
from analysis.coefficients.phasors import Phasors, Source, from_interleaved, interleaved
from analysis.coefficients.run import Run, from_struts
from analysis.motion import LinearHull, ideal_run
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint

BODY = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
RESTORING = np.array([[6900.0, 345.0], [345.0, 2400.0]])
HULL = LinearHull(
    added_mass=np.array([[75.0, 3.0], [3.0, 22.0]]),
    damping=np.array([[190.0, 12.0], [12.0, 55.0]]),
    restoring=RESTORING,
)


def oscillator(plane: Plane) -> Oscillator:
    return VERTICAL_1963 if plane is Plane.VERTICAL else HORIZONTAL_1963


def ideal_struts(
    set_point: SetPoint, plane: Plane = Plane.VERTICAL, *, name: str = "ideal"
) -> StrutRun:
    found = ideal_run(oscillator(plane), set_point, BODY, HULL)
    values = np.concatenate((found.displacements[1], found.forces[1]))
    phasors = Phasors((*DISPLACEMENTS, *FORCES), ("m", "m", "N", "N"), values)
    return StrutRun(name, oscillator(plane), set_point, set_point.frequency_hz, phasors)


def scattered(
    run: StrutRun, covariance: np.ndarray, periods: int, generator: np.random.Generator
) -> StrutRun:
    """The mean of so many noisy periods, with the covariance that their scatter gives."""
    root = np.linalg.cholesky(covariance)
    draws = generator.standard_normal((periods, len(root))) @ root.T
    values = interleaved(run.phasors.values) + draws.mean(axis=0)
    estimated = np.cov(draws, rowvar=False) / periods
    source = Source(f"scatter of {run.name}", estimated, periods - 1.0)
    phasors = Phasors(run.phasors.names, run.phasors.units, from_interleaved(values), (source,))
    return StrutRun(run.name, run.oscillator, run.set_point, run.frequency_hz, phasors)


def net(run: StrutRun) -> Run:
    loaded = from_struts(run)
    if run.set_point.medium is Medium.AIR:
        return loaded
    return loaded.without(BODY, RESTORING)


def covariance(correlation: float = 0.6) -> np.ndarray:
    """Of one period: 20 um on the displacements, 0.3 N on the forces, both struts correlated."""
    spread = np.repeat([2e-5, 2e-5, 0.3, 0.3], 2)
    tied = np.eye(8)
    for one, other in ((0, 2), (1, 3), (4, 6), (5, 7)):
        tied[one, other] = tied[other, one] = correlation
    return tied * np.outer(spread, spread)


def pair(frequency_hz: float = 0.8, speed_m_s: float = 1.2) -> tuple[SetPoint, SetPoint]:
    return (
        SetPoint(frequency_hz, 0.02, 0.0, speed_m_s),
        SetPoint(frequency_hz, 0.02, math.pi, speed_m_s),
    )
