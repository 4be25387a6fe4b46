"""From gyradii and what the file says of the model to the mass properties campaigns need."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from analysis.inertia.corrections import square_frame
from analysis.inertia.elementary_functions import Value, sqrt
from analysis.inertia.hanging import HangingCentre
from analysis.inertia.parts import MADE_OF, BodyPart, combine, part
from analysis.inertia.result import MassProperties
from analysis.inertia.second_moments import impossible_moments
from analysis.uncertainty.budget import Budget, derived
from analysis.uncertainty.estimate import Estimate, exactly, fresh_label
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag
from pmm.inertia.hanging import HangingTable
from pmm.inertia.reading import one_of
from pmm.inertia.stated_values import given_or_none, stated_value, unit_of

AXES = ("roll", "pitch", "yaw")
_MOMENTS = ("ixx_kg_m2", "iyy_kg_m2", "izz_kg_m2")


@dataclass(frozen=True)
class CorrelationTable:
    """The correlation coefficient of two keys of a table, as ``--json`` writes them."""

    between: tuple[str, str]
    coefficient: float


def correlation_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield keys that are not there, and coefficients that no values can have."""
    rows = table.get("correlations")
    entries = [row for row in rows if isinstance(row, dict)] if isinstance(rows, list) else []
    if not entries or any(set(entry) != {"between", "coefficient"} for entry in entries):
        return
    for entry in entries:
        for key in entry["between"]:
            if not isinstance(table.get(f"u_{key}"), int | float):
                yield "correlations", f"name {key}, which has no u_{key} here"
                return
    matrix = _matrix(sorted({key for entry in entries for key in entry["between"]}), entries)
    if float(np.linalg.eigvalsh(matrix).min()) < -1e-9:
        yield "correlations", "cannot all be: no values are correlated like that"


def correlated(table: object, entries: Sequence[CorrelationTable]) -> dict[str, Estimate]:
    """Return the values that are correlated, by key, in the units of their keys."""
    keys = sorted({key for entry in entries for key in entry.between})
    if not keys:
        return {}
    rows = [{"between": entry.between, "coefficient": entry.coefficient} for entry in entries]
    size, axes = np.linalg.eigh(_matrix(keys, rows))
    spread = np.array([getattr(table, f"u_{key}") for key in keys], dtype=np.float64)
    parts = spread[:, None] * axes * np.sqrt(size.clip(0.0))
    contribution = Contribution(fresh_label(), np.inf, np.arange(len(keys)), parts)
    values = np.array([getattr(table, key) for key in keys], dtype=np.float64)
    uncertain_values = UncertainValues(values, (contribution,))
    return {
        key: Estimate(uncertain_values.select([k]), unit_of(key)[0]) for k, key in enumerate(keys)
    }


def _matrix(keys: Sequence[str], entries: Sequence[Mapping[str, Any]]) -> FloatArray:
    matrix = np.eye(len(keys))
    for entry in entries:
        first, second = (keys.index(key) for key in entry["between"])
        matrix[first, second] = matrix[second, first] = entry["coefficient"]
    return matrix


@dataclass(frozen=True)
class PartTable:
    """A rigid body: mass, place from a common datum, gyradii about its own centre of gravity.

    ``x_m`` is forward, ``y_m`` to starboard and ``z_m`` down; a gyradius of 0 is a point mass's.
    ``ixx_kg_m2`` ... may stand in place of gyradii; they and the products, which are sums,
    ``ixy = sum m x y``, are about the own centre of gravity. ``hanging`` gives ``x_m`` and ``z_m``
    by plumb lines.
    ``square_half_side_m`` makes it a level square frame of thin bars, in place of gyradii.
    """

    name: str
    mass_kg: float
    u_mass_kg: float = 0.0
    x_m: float = 0.0
    u_x_m: float = 0.0
    y_m: float = 0.0
    u_y_m: float = 0.0
    z_m: float = 0.0
    u_z_m: float = 0.0
    k_roll_m: float = 0.0
    u_k_roll_m: float = 0.0
    k_pitch_m: float = 0.0
    u_k_pitch_m: float = 0.0
    k_yaw_m: float = 0.0
    u_k_yaw_m: float = 0.0
    square_half_side_m: float | None = None
    u_square_half_side_m: float = 0.0
    ixx_kg_m2: float | None = None
    u_ixx_kg_m2: float = 0.0
    iyy_kg_m2: float | None = None
    u_iyy_kg_m2: float = 0.0
    izz_kg_m2: float | None = None
    u_izz_kg_m2: float = 0.0
    ixy_kg_m2: float = 0.0
    u_ixy_kg_m2: float = 0.0
    ixz_kg_m2: float = 0.0
    u_ixz_kg_m2: float = 0.0
    iyz_kg_m2: float = 0.0
    u_iyz_kg_m2: float = 0.0
    correlations: tuple[CorrelationTable, ...] = ()
    hanging: HangingTable | None = None

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """One way to each inertia and to the centre of gravity; correlations that can be."""
        for axis, moment in zip(AXES, _MOMENTS, strict=True):
            for key in (f"k_{axis}_m", moment):
                yield from one_of(table, "square_half_side_m", key, needed=False)
            yield from one_of(table, f"k_{axis}_m", moment, needed=False)
        for key in ("x_m", "z_m"):
            yield from one_of(table, "hanging", key, needed=False)
        yield from correlation_rules(table)

    @cached_property
    def centre(self) -> HangingCentre | None:
        """The centre of gravity by plumb lines, where it is given so."""
        return None if self.hanging is None else self.hanging.centre(f"{self.name}: plumb lines")

    def measured(self) -> dict[str, Estimate]:
        """Return mass, place, gyradii and products by :data:`MADE_OF`."""
        correlated_values = correlated(self, self.correlations)
        values = {key: correlated_values.get(key) or stated_value(self, key) for key in MADE_OF}
        if self.centre is not None:
            values |= {"x_m": self.centre.x, "z_m": self.centre.z}
        for axis, moment in zip(AXES, _MOMENTS, strict=True):
            if getattr(self, moment) is not None:
                inputs = {
                    "about": correlated_values.get(moment) or stated_value(self, moment),
                    "mass": values["mass_kg"],
                }
                values[f"k_{axis}_m"] = derived("k", _gyradius, "m", **inputs)
        if self.square_half_side_m is not None:
            keys = (f"k_{axis}_m" for axis in AXES)
            values |= zip(keys, self._square(stated_value(self, "square_half_side_m")), strict=True)
        return values

    def part(self) -> BodyPart:
        """Return it with its covariance."""
        mass, x, y, z, roll, pitch, yaw, *products = self.measured().values()
        xy, xz, yz = products
        return part(self.name, mass, (x, y, z), (roll, pitch, yaw), (xy, xz, yz))

    def _square(self, side: Estimate) -> tuple[Estimate, Estimate, Estimate]:
        level, upright = (
            side.following(value, value / side.value) for value in square_frame(side.value, 0.0)
        )
        return level, level, upright


def _gyradius(about: Value, mass: Value) -> Value:
    return sqrt(about / mass)


@dataclass(frozen=True)
class ModelTable:
    """The model: mass, and its centre of gravity from the midpoint between the struts."""

    mass_kg: float | None = None
    u_mass_kg: float = 0.0
    cg_x_m: float | None = None
    u_cg_x_m: float = 0.0
    cg_z_m: float | None = None
    u_cg_z_m: float = 0.0


def properties(
    name: str,
    model: ModelTable,
    gyradii: Mapping[str, Estimate],
    *,
    take_off: Sequence[PartTable] = (),
    budgets: Sequence[Budget] = (),
    flags: Sequence[Flag] = (),
    centre: HangingCentre | None = None,
    cg_z: Estimate | None = None,
) -> tuple[MassProperties | None, tuple[str, ...]]:
    """Return the mass properties, or the keys that are missing for them.

    Parameters
    ----------
    gyradii
        By axis, of what hung: with the parts to take off.
    take_off
        Parts that hung there and are not the model's, from the same datum.
    centre, cg_z
        Measured, in place of the file's.
    """
    mass, x, z = (given_or_none(model, key, "model") for key in ("mass_kg", "cg_x_m", "cg_z_m"))
    if centre is not None:
        x, z = centre.x, centre.z
    z = cg_z or z
    inputs = {"mass_kg": mass, "cg_x_m": x, "cg_z_m": z}
    missing = tuple(f"model.{key}" for key, value in inputs.items() if value is None)
    if mass is None or x is None or z is None or not gyradii:
        return None, missing or ("a gyradius",)
    if take_off:
        (mass, x, z), gyradii = _without(name, (mass, x, z), gyradii, take_off)
    if set(gyradii) == set(AXES):
        roll, pitch, yaw = (gyradii[axis] for axis in AXES)
        nothing = exactly(0.0, "m")
        flags = (*flags, *impossible_moments(part(name, mass, (x, nothing, z), (roll, pitch, yaw))))
    return MassProperties(name, mass, x, z, dict(gyradii), tuple(budgets), tuple(flags)), ()


def _without(
    name: str,
    mass_and_cg: tuple[Estimate, Estimate, Estimate],
    gyradii: Mapping[str, Estimate],
    take_off: Sequence[PartTable],
) -> tuple[tuple[Estimate, Estimate, Estimate], dict[str, Estimate]]:
    """Take parts off by the parallel axis theorem."""
    nothing = exactly(0.0, "m")
    mass, x, z = mass_and_cg
    roll, pitch, yaw = (gyradii.get(axis, nothing) for axis in AXES)
    hung = part(name, mass, (x, nothing, z), (roll, pitch, yaw))
    model = combine(name, [hung], without=[table.part() for table in take_off])
    model_gyradii = dict(zip(AXES, model.gyradii, strict=True))
    ahead, _, below = model.centre_of_gravity
    return (model.mass, ahead, below), {axis: model_gyradii[axis] for axis in gyradii}
