"""The tables of ``pmm inertia swing``'s file."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from math import radians
from typing import Any, Literal

import numpy as np

from analysis.inertia.swing_static import LeverSeries
from pmm.inertia.air import air_rules
from pmm.inertia.hanging import hanging_rules
from pmm.inertia.job_table import JobTable
from pmm.inertia.period_source import PeriodSource
from pmm.inertia.properties import ModelTable
from pmm.inertia.reading import one_of, require_together


@dataclass(frozen=True)
class LeverTable:
    """Tilts under weights at one lever; tilts towards the weights are positive.

    Attributes
    ----------
    drop_m
        Depth of the points that the weights hang from below the pivot.
    """

    name: str
    lever_m: float
    weight_kg: tuple[float, ...]
    tilt_deg: tuple[float, ...] | None = None
    tilt_rad: tuple[float, ...] | None = None
    u_lever_m: float = 0.0
    drop_m: float = 0.0
    u_drop_m: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """Tilts in one unit, one for each weight."""
        yield from one_of(table, "tilt_deg", "tilt_rad")
        weights, tilts = table.get("weight_kg"), table.get("tilt_deg", table.get("tilt_rad"))
        if isinstance(weights, list) and isinstance(tilts, list) and len(weights) != len(tilts):
            yield "weight_kg", f"has {len(weights)} weights for {len(tilts)} tilts"

    def series(self, deeper: float = 0.0) -> LeverSeries:
        """Return the readings in SI units, with so many standard uncertainties more of drop."""
        tilt = self.tilt_rad or tuple(map(radians, self.tilt_deg or ()))
        weights = np.array(self.weight_kg, dtype=np.float64)
        drop_m = self.drop_m + deeper * self.u_drop_m
        tilts = np.array(tilt, dtype=np.float64)
        return LeverSeries(self.name, self.lever_m, weights, tilts, drop_m)


@dataclass(frozen=True)
class StateTable:
    """The swing as it hangs: what is on it is counted in.

    Its first moment is given by ``levers``, ``cg_below_pivot_m`` or ``moment_kg_m``.
    """

    period: PeriodSource
    mass_kg: float
    u_mass_kg: float = 0.0
    levers: tuple[LeverTable, ...] = ()
    static_fit: Literal["F1", "F2"] = "F2"
    u_tilt_relative: float = 0.0
    cg_below_pivot_m: float | None = None
    u_cg_below_pivot_m: float = 0.0
    moment_kg_m: float | None = None
    u_moment_kg_m: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """One way to the first moment."""
        yield from one_of(table, "levers", "cg_below_pivot_m", "moment_kg_m")


@dataclass(frozen=True)
class CheckTable(StateTable):
    """The swing with a body of known inertia about the pivot in the model's place."""

    known_inertia_kg_m2: float = field(kw_only=True)
    u_known_inertia_kg_m2: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True)
class SecondPivotTable(StateTable):
    """The empty swing hung from its upper pivot."""

    pivot_distance_m: float = field(kw_only=True)
    u_pivot_distance_m: float = field(default=0.0, kw_only=True)


@dataclass(frozen=True)
class OnSwing(ModelTable):
    """The model on the swing.

    Attributes
    ----------
    axis
        About which the swing turns it.
    pivot_above_midpoint_m
        Height of the pivot above the midpoint between the struts, which gives ``cg_z_m``.
    """

    axis: Literal["roll", "pitch", "yaw"] = "pitch"
    pivot_above_midpoint_m: float | None = None
    u_pivot_above_midpoint_m: float = 0.0


@dataclass(frozen=True, kw_only=True)
class SwingTable(JobTable):
    """The file of ``pmm inertia swing``."""

    tare: StateTable
    name: str = "swing"
    loaded: StateTable | None = None
    model: OnSwing = field(default_factory=OnSwing)
    second_pivot: SecondPivotTable | None = None
    check: CheckTable | None = None
    tare_again: StateTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """A loaded swing needs the model's mass; the workflow's order is kept."""
        yield from air_rules(table)
        yield from hanging_rules(table)
        model = table.get("model", {})
        if "loaded" in table and isinstance(model, dict) and "mass_kg" not in model:
            yield "model", "needs mass_kg, for the inertia of what is on the swing"
        if "tare_again" in table:
            yield from require_together(table, "tare_again", "check")
        if "check" in table:
            yield from require_together(table, "check", "loaded")
