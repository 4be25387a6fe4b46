"""Mean loads of a model that is towed with the shaft at rest."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.body_cycle import SURGE_FORCE, BodyCycle, at_order
from hardware.description.oscillator import Plane


@dataclass(frozen=True)
class Tow:
    """Mean loads of one tow, of the water **on the model**, about the midpoint.

    Attributes
    ----------
    kind
        Static drift or straight tow, as the plan names it.
    speed_m_s, drift_rad, across_m_s
        Of the carriage; the angle; the velocity that it makes across the model, ``v = -U sin b``
        for drift and ``w = U sin b`` for trim.
    force_n, moment_n_m
        Across, and about the axis of the rotation.
    resistance_n
        Against the motion ahead; NaN without a surge gauge.
    force_u, moment_u, resistance_u
        Standard uncertainties, from the scatter within run and zeros.
    force_half_width, moment_half_width, resistance_half_width
        Of the intervals of 95 %.
    """

    run: str
    kind: str
    plane: Plane
    speed_m_s: float
    drift_rad: float
    across_m_s: float
    force_n: float
    force_u: float
    force_half_width: float
    moment_n_m: float
    moment_u: float
    moment_half_width: float
    resistance_n: float
    resistance_u: float
    resistance_half_width: float


def tow_of(kind: str, cycle: BodyCycle) -> Tow:
    """Return the loads of a tow, zero readings subtracted."""
    rows = ["force", "moment", *([SURGE_FORCE] if cycle.has_surge else [])]
    means = cycle.phasors.select([at_order(name, 0) for name in rows]).real
    columns = np.stack((means.values, means.standard_uncertainty, means.half_width()))[:, ::2]
    (force, *force_u), (moment, *moment_u), *surge = map(tuple, columns.T.tolist())
    resistance = surge[0] if surge else (math.nan,) * 3
    loads = (-force, *force_u, -moment, *moment_u, *resistance)
    across = cycle.phasors[at_order("across", 0)].real
    return Tow(cycle.name, kind, cycle.plane, cycle.speed_m_s, cycle.drift_rad, across, *loads)
