"""From gyradii and what the file says of the model to the mass properties campaigns need."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from analysis.inertia.corrections import square_frame
from analysis.inertia.parts import MADE_OF, BodyPart, combine, part
from analysis.inertia.result import InertiaResult
from analysis.uncertainty.budget import Budget
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.flags import Flag
from pmm.inertia.reading import one_of
from pmm.inertia.stated_values import given, given_or_none

AXES = ("roll", "pitch", "yaw")
_PLACES = {"cg_x_m": "x_m", "cg_z_m": "z_m"}  # a result's name -> a part's


@dataclass(frozen=True)
class PartTable:
    """A rigid body: mass, place from a common datum, gyradii about its own centre of gravity.

    ``x_m`` is forward, ``y_m`` to starboard and ``z_m`` down; a gyradius of 0 is a point mass's.
    Products of inertia are sums, ``ixy = sum m x y``, about the own centre of gravity.
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
    ixy_kg_m2: float = 0.0
    ixz_kg_m2: float = 0.0
    iyz_kg_m2: float = 0.0

    @staticmethod
    def rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
        """A square frame's gyradii follow from its side."""
        for axis in AXES:
            yield from one_of(table, "square_half_side_m", f"k_{axis}_m", needed=False)

    @property
    def products_kg_m2(self) -> tuple[float, float, float]:
        """``Ixy``, ``Ixz``, ``Iyz``."""
        return self.ixy_kg_m2, self.ixz_kg_m2, self.iyz_kg_m2

    def measured(self) -> dict[str, Estimate]:
        """Return mass, place and gyradii by :data:`MADE_OF`."""
        values = (given(self, key) for key in MADE_OF[:4])
        return dict(zip(MADE_OF, (*values, *self._gyradii()), strict=True))

    def part(self) -> BodyPart:
        """Return it with its covariance."""
        mass, x, y, z, roll, pitch, yaw = self.measured().values()
        return part(self.name, mass, (x, y, z), (roll, pitch, yaw), self.products_kg_m2)

    def _gyradii(self) -> tuple[Estimate, Estimate, Estimate]:
        side = given_or_none(self, "square_half_side_m")
        if side is None:
            roll, pitch, yaw = (given(self, f"k_{axis}_m") for axis in AXES)
            return roll, pitch, yaw
        level, upright = (
            side.following(value, value / side.value) for value in square_frame(side.value, 0.0)
        )
        return level, level, upright


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
    cg_z: Estimate | None = None,
) -> tuple[InertiaResult | None, tuple[str, ...]]:
    """Return the mass properties, or the keys that are missing for them.

    Parameters
    ----------
    gyradii
        By axis, of what hung: with the parts to take off.
    take_off
        Parts that hung there and are not the model's, from the same datum.
    cg_z
        Measured, in place of the file's.
    """
    mass, x, z = (given_or_none(model, key, "model") for key in ("mass_kg", "cg_x_m", "cg_z_m"))
    z = cg_z or z
    known = {"mass_kg": mass, "cg_x_m": x, "cg_z_m": z}
    missing = tuple(f"model.{key}" for key, value in known.items() if value is None)
    if mass is None or x is None or z is None or not gyradii:
        return None, missing or ("a gyradius",)
    if take_off:
        (mass, x, z), gyradii = _without(name, (mass, x, z), gyradii, take_off)
    return InertiaResult(name, mass, x, z, dict(gyradii), tuple(budgets), tuple(flags)), ()


def _without(
    name: str,
    whole: tuple[Estimate, Estimate, Estimate],
    gyradii: Mapping[str, Estimate],
    take_off: Sequence[PartTable],
) -> tuple[tuple[Estimate, Estimate, Estimate], dict[str, Estimate]]:
    """Take parts off by the parallel axis theorem."""
    nothing = exactly(0.0, "m")
    mass, x, z = whole
    roll, pitch, yaw = (gyradii.get(axis, nothing) for axis in AXES)
    hung = part(name, mass, (x, nothing, z), (roll, pitch, yaw))
    left = combine(name, [hung], without=[one.part() for one in take_off])
    own = dict(zip(AXES, left.gyradii, strict=True))
    ahead, _, below = left.centre_of_gravity
    return (left.mass, ahead, below), {axis: own[axis] for axis in gyradii}
