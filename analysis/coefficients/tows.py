"""Mean loads of a model that is towed with the shaft at rest."""

import math
from dataclasses import dataclass

from analysis.coefficients.body_cycle import SURGE_FORCE, BodyCycle, at_order
from analysis.uncertainty.freedom import student_factor
from hardware.description.oscillator import Plane

_LEVEL = 0.95


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
    degrees_of_freedom
        The least of these scatters'.
    """

    run: str
    kind: str
    plane: Plane
    speed_m_s: float
    drift_rad: float
    across_m_s: float
    force_n: float
    force_u: float
    moment_n_m: float
    moment_u: float
    resistance_n: float
    resistance_u: float
    degrees_of_freedom: float

    def half_width(self, standard_uncertainty: float) -> float:
        """Return the half-width at 95 %."""
        return float(student_factor(self.degrees_of_freedom, _LEVEL)) * standard_uncertainty


def tow_of(kind: str, cycle: BodyCycle) -> Tow:
    """Return the loads of a tow, zero readings subtracted."""
    rows = ["force", "moment", *([SURGE_FORCE] if cycle.has_surge else [])]
    means = cycle.phasors.select([at_order(name, 0) for name in rows])
    value = {name: float(value.real) for name, value in zip(rows, means.values, strict=True)}
    spread = means.standard_uncertainty.real
    u = {name: float(standard) for name, standard in zip(rows, spread, strict=True)}
    return Tow(
        cycle.name,
        kind,
        cycle.plane,
        cycle.speed_m_s,
        cycle.drift_rad,
        cycle.phasors[at_order("across", 0)].real,
        -value["force"],
        u["force"],
        -value["moment"],
        u["moment"],
        value.get(SURGE_FORCE, math.nan),
        u.get(SURGE_FORCE, math.nan),
        min((source.degrees_of_freedom for source in means.sources), default=math.inf),
    )
