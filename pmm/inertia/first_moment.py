"""A swing's first moment: stated, or by tilts under weights; and what rights it in air."""

from dataclasses import dataclass

import numpy as np

from analysis.inertia.swing import moment_in_air
from analysis.inertia.swing_static import StaticResult, distance, fit_static
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate
from pmm.inertia.stated_values import stated_value
from pmm.inertia.swing_tables import StateTable, SwingTable


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
        cg = stated_value(table, "cg_below_pivot_m")
        return Moment(derived("S", lambda cg, mass: cg * mass, "kg m", cg=cg, mass=mass), cg)
    static = _tilts(table) if table.levers else None
    moment = stated_value(table, "moment_kg_m") if static is None else _scaled(table, static)
    return Moment(moment, distance(moment, mass), static)


def _tilts(table: StateTable, deeper: float = 0.0) -> StaticResult:
    series = [lever.series(deeper) for lever in table.levers]
    return fit_static(series, with_offset=table.static_fit == "F2")


def _scaled(table: StateTable, static: StaticResult) -> Estimate:
    """Add the levers' and the inclinometer's errors, which all states that use them share."""
    moment = static.pooled.moment
    lever_relative = float(np.mean([lever.u_lever_m / lever.lever_m for lever in table.levers]))
    levers = ", ".join(sorted(f"{lever.name} of {lever.lever_m:g} m" for lever in table.levers))
    by_levers = moment.widened(moment.value * lever_relative, label=f"levers {levers}")
    by_scale = by_levers.widened(
        moment.value * table.u_tilt_relative, label="scale of the inclinometer"
    )
    if not any(lever.u_drop_m for lever in table.levers):
        return by_scale
    deeper = _tilts(table, 1.0).pooled.moment.value - moment.value
    drops = ", ".join(sorted(f"{lever.name} of {lever.drop_m:g} m" for lever in table.levers))
    return by_scale.widened(deeper, label=f"drops {drops}")


def displaced_share(table: SwingTable) -> float:
    """Return the density of the air over the model's; 0 where that is not stated."""
    density_kg_m3 = table.body_density_kg_m3
    return table.air_density_kg_m3 / density_kg_m3 if density_kg_m3 else 0.0


def in_air(
    moment: Moment, tare: Moment, mass: Estimate, gravity: Estimate, displaced: float
) -> tuple[Moment, Estimate]:
    """Return a loaded swing's moment of masses, and the gravity with which it rights the swing.

    Tilts tell the moment in air, of which the model's part is that much less.
    """
    moments = {"total": moment.estimate, "tare": tare.estimate}
    if moment.static is not None:
        masses = derived(
            "S",
            lambda total, tare: tare + (total - tare) / (1.0 - displaced),
            "kg m",
            **moments,
        )
        moment = Moment(masses, distance(masses, mass), moment.static)
        moments["total"] = masses
    righting = derived(
        "g",
        lambda gravity, total, tare: gravity * moment_in_air(total, tare, displaced) / total,
        "m/s2",
        gravity=gravity,
        **moments,
    )
    return moment, righting
