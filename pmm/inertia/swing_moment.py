"""The first moment of a swing's state, and what the moments of two states have in common."""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.swing_static import StaticResult, distance, fit_static
from analysis.uncertainty.budget import derived
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
    cg
        Distance of the centre of gravity below the pivot, m.
    static
        The fit to the tilts that they come from, if they do.
    """

    estimate: Estimate
    cg: Estimate
    static: StaticResult | None = None


def first_moment(table: StateTable, mass: Estimate) -> Moment:
    """Return the first moment of a state of that mass."""
    if table.cg_below_pivot_m is not None:
        cg = given(table, "cg_below_pivot_m")
        return Moment(derived("S", lambda cg, mass: cg * mass, "kg m", cg=cg, mass=mass), cg)
    static = _tilts(table) if table.levers else None
    moment = given(table, "moment_kg_m") if static is None else _scaled(table, static)
    return Moment(moment, distance(moment, mass), static)


def _tilts(table: StateTable) -> StaticResult:
    return fit_static([one.series() for one in table.levers], with_offset=table.static_fit == "F2")


def _scaled(table: StateTable, static: StaticResult) -> Estimate:
    """Add the levers' and the inclinometer's errors, which all states that use them share."""
    own = static.pooled.moment
    lever = float(np.mean([one.u_lever_m / one.lever_m for one in table.levers]))
    levers = ", ".join(sorted(f"{one.name} of {one.lever_m:g} m" for one in table.levers))
    by_levers = own.widened(own.value * lever, label=f"levers {levers}")
    return by_levers.widened(own.value * table.u_tilt_relative, label="scale of the inclinometer")
