"""What is known of the rig only within limits: each prior, and how it is drawn."""

import math
from dataclasses import dataclass

import numpy as np

from tests.sealed.generator.parameters import FloatArray, P

# Standard deviations, as case.toml states them.
STATED = {
    "mass_relative": 0.002,
    "inertia_relative": 0.01,
    "cg_m": 0.002,
    "added_mass_relative": 0.10,
    "damping_relative": 0.15,
    "restoring_relative": 0.03,
    "coupling_relative": 0.05,
    "gain_relative": 0.001,
    "zero_n": 0.02,
    "eccentricity_m": 2e-5,
    "strut_phase_rad": 5e-4,
    "photocell_angle_rad": 3e-4,
    "frequency_relative": 1e-4,
    "carriage_speed_relative": 1e-3,
    "displacement_gain_relative": 5e-4,
}


@dataclass(frozen=True)
class Prior:
    """One number that is known within a standard deviation."""

    place: P
    sigma: float

    def put(self, p: FloatArray, sigmas: float) -> FloatArray:
        """Return the parameters with this one off by so many standard deviations."""
        q = p.copy()
        q[self.place] += sigmas * self.sigma
        return q


def _matrix(p: FloatArray, first: P, relative: float) -> list[Prior]:
    """Return the priors of a 2 x 2 matrix; couplings by the root of the diagonal's product."""
    diagonal = abs(p[first]), abs(p[first + 3])
    cross = STATED["coupling_relative"] * math.sqrt(diagonal[0] * diagonal[1])
    spans = (relative * diagonal[0], cross, cross, relative * diagonal[1])
    return [Prior(P(first + i), span) for i, span in enumerate(spans) if span > 0.0]


def priors(p: FloatArray) -> tuple[Prior, ...]:
    """Return the priors about believed parameters."""
    s = STATED
    plain = [
        (P.MASS, s["mass_relative"] * p[P.MASS]),
        (P.INERTIA, s["inertia_relative"] * p[P.INERTIA]),
        (P.CG_X, s["cg_m"]),
        (P.CG_Z, s["cg_m"] if p[P.GRAVITY] else 0.0),
        (P.GAIN_AFT, s["gain_relative"]),
        (P.GAIN_FORE, s["gain_relative"]),
        (P.ZERO_AFT, s["zero_n"]),
        (P.ZERO_FORE, s["zero_n"]),
        (P.ECC_ERROR_AFT, s["eccentricity_m"]),
        (P.ECC_ERROR_FORE, s["eccentricity_m"]),
        (P.PHASE_ERROR, s["strut_phase_rad"]),
        (P.MARK, s["photocell_angle_rad"]),
        (P.CARRIAGE_ERROR, s["carriage_speed_relative"]),
        (P.SCALE_AFT, s["displacement_gain_relative"]),
        (P.SCALE_FORE, s["displacement_gain_relative"]),
    ]
    return (
        *(Prior(place, float(sigma)) for place, sigma in plain if sigma > 0.0),
        *_matrix(p, P.ADDED_00, s["added_mass_relative"]),
        *_matrix(p, P.DAMPING_00, s["damping_relative"]),
        *_matrix(p, P.RESTORING_00, s["restoring_relative"]),
    )


def drawn(
    p: FloatArray, known: tuple[Prior, ...], rng: np.random.Generator, spread: float = 1.0
) -> FloatArray:
    """Return parameters drawn about believed ones, none beyond two standard deviations."""
    q = p.copy()
    for prior in known:
        q[prior.place] += spread * prior.sigma * float(np.clip(rng.standard_normal(), -2.0, 2.0))
    return q
