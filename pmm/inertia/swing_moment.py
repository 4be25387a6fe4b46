"""The first moment of a swing's state, and what the moments of two states have in common."""

import math
from dataclasses import dataclass

import numpy as np

from analysis.inertia.swing_static import StaticResult, fit_static
from analysis.uncertainty.estimate import Estimate
from pmm.inertia.stated_values import given
from pmm.inertia.swing_tables import StateTable


@dataclass(frozen=True)
class Moment:
    """A first moment about the pivot.

    Attributes
    ----------
    estimate
        In kg m.
    static
        The fit to the tilts that it comes from, if it does.
    tilt_relative, lever_relative
        The inclinometer's and the levers' part of its relative standard uncertainty.
    levers
        Names and lengths of the levers: the same ones are off by the same.
    """

    estimate: Estimate
    static: StaticResult | None = None
    tilt_relative: float = 0.0
    lever_relative: float = 0.0
    levers: frozenset[tuple[str, float]] = frozenset()

    def correlation(self, other: "Moment") -> float:
        """Return the correlation with another state's, read by the same inclinometer."""
        common = self.tilt_relative * other.tilt_relative
        if self.levers == other.levers:
            common += self.lever_relative * other.lever_relative
        own = self.estimate.relative * other.estimate.relative
        return min(common / own, 1.0) if own > 0.0 else 0.0


def first_moment(table: StateTable) -> Moment:
    """Return the first moment; the levers' and the inclinometer's errors are common to a series."""
    if table.levers:
        return _by_tilts(table)
    if table.moment_kg_m is not None:
        return Moment(given(table, "moment_kg_m"))
    cg, mass = given(table, "cg_below_pivot_m"), given(table, "mass_kg")
    value = cg.value * mass.value
    return Moment(Estimate(value, value * math.hypot(cg.relative, mass.relative), "kg m"))


def _by_tilts(table: StateTable) -> Moment:
    static = fit_static(
        [one.series() for one in table.levers], with_offset=table.static_fit == "F2"
    )
    own = static.pooled.moment
    lever = float(np.mean([one.u_lever_m / one.lever_m for one in table.levers]))
    estimate = own.widened(own.value * math.hypot(lever, table.u_tilt_relative))
    levers = frozenset((one.name, one.lever_m) for one in table.levers)
    return Moment(estimate, static, table.u_tilt_relative, lever, levers)
