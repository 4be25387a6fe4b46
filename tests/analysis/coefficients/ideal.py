"""Runs built from closed-form phasors, with a given scatter: quick, for coverage and budgets.

The closed form is that of small angles. Eccentricities and scatter are ten thousand times smaller
than a rig's, where what is of the second order has gone below 1e-8.
"""

import math
from dataclasses import replace

import numpy as np

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors, interleaved
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.uncertainty.values import UncertainValues
from hardware.description.body import Body
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator, Plane
from hardware.description.setpoint import Medium, SetPoint
from tests.analysis.coefficients.sources import of_draws
from tests.analysis.ideal_run import LinearHull, ideal_run

SMALL = 1e-4
ECCENTRICITY_M = 0.02 * SMALL
BODY = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
RESTORING = np.array([[6900.0, 345.0], [345.0, 2400.0]])
HULL = LinearHull(
    added_mass=np.array([[75.0, 3.0], [3.0, 22.0]]),
    damping=np.array([[190.0, 12.0], [12.0, 55.0]]),
    restoring=RESTORING,
)
READ = labels((*DISPLACEMENTS, *FORCES), 1)
_FIRST = slice(8, 16)  # of the real numbers: after the means


def oscillator(plane: Plane) -> Oscillator:
    return VERTICAL_1963 if plane is Plane.VERTICAL else HORIZONTAL_1963


def ideal_struts(
    set_point: SetPoint, plane: Plane = Plane.VERTICAL, *, name: str = "ideal"
) -> StrutCycle:
    found = ideal_run(oscillator(plane), set_point, BODY, HULL)
    values = np.concatenate((np.zeros(4), found.displacements[1], found.forces[1]))
    phasors = Phasors.of(READ, ("m", "m", "N", "N") * 2, values)
    return StrutCycle(name, oscillator(plane), set_point, set_point.frequency_hz, phasors, 1)


def scattered(
    run: StrutCycle, covariance: np.ndarray, periods: int, generator: np.random.Generator
) -> StrutCycle:
    """The mean of so many noisy periods, with the covariance that their scatter gives."""
    root = np.linalg.cholesky(covariance)
    draws = generator.standard_normal((periods, len(root))) @ root.T
    values = interleaved(run.phasors.values)
    values[_FIRST] += draws.mean(axis=0)
    every = np.zeros((periods, len(values)))
    every[:, _FIRST] = draws
    source = of_draws(f"scatter of {run.name}", every)
    phasors = replace(run.phasors, real=UncertainValues(values, (source,)))
    return replace(run, phasors=phasors)


def with_factors(run: StrutCycle, aft: complex, fore: complex) -> StrutCycle:
    """The run as gauges read it that respond so to the fundamental."""
    factors = np.ones(len(READ), dtype=complex)
    factors[READ.index("force_aft 1")], factors[READ.index("force_fore 1")] = aft, fore
    return replace(run, phasors=run.phasors.mapped(np.diag(factors)))


def net(run: StrutCycle) -> BodyCycle:
    loaded = run.model()
    return loaded if loaded.medium is Medium.AIR else loaded.without(BODY, RESTORING)


def covariance(correlation: float = 0.6) -> np.ndarray:
    """Of one period: 2 nm on the displacements, 30 uN on the forces, both struts correlated."""
    spread = SMALL * np.repeat([2e-5, 2e-5, 0.3, 0.3], 2)
    tied = np.eye(8)
    for one, other in ((0, 2), (1, 3), (4, 6), (5, 7)):
        tied[one, other] = tied[other, one] = correlation
    return tied * np.outer(spread, spread)


def pair(frequency_hz: float = 0.8, speed_m_s: float = 1.2) -> tuple[SetPoint, SetPoint]:
    return (
        SetPoint(frequency_hz, ECCENTRICITY_M, 0.0, speed_m_s),
        SetPoint(frequency_hz, ECCENTRICITY_M, math.pi, speed_m_s),
    )
