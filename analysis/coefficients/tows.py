"""Towed with the shaft at rest: force over drift or trim angle, and resistance over speed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np

from analysis.coefficients.cycle import SURGE_FORCE, Cycle, at_order
from analysis.coefficients.phasors import FloatArray
from analysis.motion import incidence
from analysis.uncertainty import student_factor
from hardware.description.oscillator import Plane

_LEVEL = 0.95
_CUBIC_FROM = 5  # angles: a cubic term leaves a line three to be judged by
_SAME_SPEED = 3  # digits after the point, m/s
_NAMES = {Plane.HORIZONTAL: ("Y", "N", "v"), Plane.VERTICAL: ("Z", "M", "w")}


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
        freedom = np.array([self.degrees_of_freedom])
        return float(student_factor(freedom, _LEVEL)[0]) * standard_uncertainty


@dataclass(frozen=True)
class DriftSlope:
    """A load's derivative by the velocity across the model, at one speed.

    Attributes
    ----------
    name, unit
        ``"Y_v"``, ``"N_v"``, ``"Z_w"`` or ``"M_w"``; about the midpoint.
    value, half_width
        Per m/s, and at 95 %; infinite where two angles leave nothing to judge a line by and the
        scatter within the runs is unknown.
    at_zero
        The load without drift: nothing, for a model that is even and hangs straight.
    cubic, cubic_half_width
        Of the third power, from five angles on; NaN with fewer.
    angles
        How many different ones.
    scatter
        Root mean square distance from the curve over the uncertainty within the runs; NaN where
        none is left over.
    """

    name: str
    unit: str
    speed_m_s: float
    value: float
    half_width: float
    at_zero: float
    at_zero_half_width: float
    cubic: float
    cubic_half_width: float
    angles: int
    scatter: float


def tow_of(kind: str, cycle: Cycle) -> Tow:
    """Return the loads of a tow whose zeros are taken off."""
    rows = ["force", "moment", *([SURGE_FORCE] if cycle.has_surge else [])]
    means = cycle.phasors.select([at_order(name, 0) for name in rows])
    value = {name: float(one.real) for name, one in zip(rows, means.values, strict=True)}
    spread = means.standard_uncertainty.real
    u = {name: float(one) for name, one in zip(rows, spread, strict=True)}
    return Tow(
        cycle.name,
        kind,
        cycle.plane,
        cycle.speed_m_s,
        cycle.drift_rad,
        float(incidence(cycle.plane)[0, 1]) * cycle.speed_m_s * math.sin(cycle.drift_rad),
        -value["force"],
        u["force"],
        -value["moment"],
        u["moment"],
        value.get(SURGE_FORCE, math.nan),
        u.get(SURGE_FORCE, math.nan),
        min((one.degrees_of_freedom for one in means.sources), default=math.inf),
    )


def drift_slopes(tows: Sequence[Tow]) -> tuple[DriftSlope, ...]:
    """Return the slopes at each speed at which there are two angles or more."""

    def speed(one: Tow) -> float:
        return round(one.speed_m_s, _SAME_SPEED)

    found: list[DriftSlope] = []
    for _, group in groupby(sorted(tows, key=speed), key=speed):
        found += _slopes(list(group))
    return tuple(found)


def _slopes(tows: Sequence[Tow]) -> list[DriftSlope]:
    across = np.array([one.across_m_s for one in tows])
    angles = len({round(one.drift_rad, 6) for one in tows})
    if angles < 2:
        return []
    force, moment, velocity = _NAMES[tows[0].plane]
    loads = (
        (f"{force}_{velocity}", "N s/m", "force_n", "force_u"),
        (f"{moment}_{velocity}", "N s", "moment_n_m", "moment_u"),
    )
    return [_slope(name, unit, tows, across, angles, value, u) for name, unit, value, u in loads]


def _slope(
    name: str,
    unit: str,
    tows: Sequence[Tow],
    across: FloatArray,
    angles: int,
    value: str,
    u: str,
) -> DriftSlope:
    powers = (0, 1, 3) if angles >= _CUBIC_FROM else (0, 1)
    y = np.array([getattr(one, value) for one in tows])
    spread = np.array([getattr(one, u) for one in tows])
    within = float(np.sqrt(np.mean(spread**2)))
    basis = np.stack([across**power for power in powers], axis=1)
    inverse = np.linalg.inv(basis.T @ basis)
    found = inverse @ basis.T @ y
    spare = len(y) - len(powers)
    about = math.sqrt(float(np.sum((y - basis @ found) ** 2)) / spare) if spare else 0.0
    # The larger one: scatter within a run knows nothing of how well it repeats.
    outer = spare > 0 and about >= within
    freedom = float(spare) if outer else min(one.degrees_of_freedom for one in tows)
    factor = float(student_factor(np.array([freedom]), _LEVEL)[0])
    width = factor * max(about, within) * np.sqrt(np.diagonal(inverse))
    cubic = (float(found[2]), float(width[2])) if len(powers) > 2 else (math.nan, math.nan)
    scatter = about / within if spare and within > 0.0 else math.nan
    return DriftSlope(
        name,
        unit,
        tows[0].speed_m_s,
        float(found[1]),
        float(width[1]),
        float(found[0]),
        float(width[0]),
        *cubic,
        angles,
        scatter,
    )
