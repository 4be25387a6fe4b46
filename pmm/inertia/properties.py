"""From gyradii and what the file says of the model to the mass properties campaigns need."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

from analysis.inertia.corrections import square_frame
from analysis.inertia.parts import MADE_OF, BodyPart, combine, part
from analysis.inertia.result import InertiaResult
from analysis.uncertainty.budget import Budget, Correlations
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

    def measured(self) -> tuple[dict[str, Estimate], Correlations]:
        """Return mass, place and gyradii by :data:`MADE_OF`, and what ties them."""
        gyradii, tied = self._gyradii()
        values = (given(self, key) for key in MADE_OF[:4])
        return dict(zip(MADE_OF, (*values, *gyradii), strict=True)), tied

    def part(self) -> BodyPart:
        """Return it with its covariance."""
        own, tied = self.measured()
        mass, x, y, z, roll, pitch, yaw = (own[key] for key in MADE_OF)
        place, gyradii = (x, y, z), (roll, pitch, yaw)
        return part(self.name, mass, place, gyradii, self.products_kg_m2, correlations=tied)

    def _gyradii(self) -> tuple[tuple[Estimate, Estimate, Estimate], Correlations]:
        side = given_or_none(self, "square_half_side_m")
        if side is None:
            roll, pitch, yaw = (given(self, f"k_{axis}_m") for axis in AXES)
            return (roll, pitch, yaw), {}
        level, upright = (
            replace(side, value=value, uncertainty=value * side.relative)
            for value in square_frame(side.value, 0.0)
        )
        pairs = (("roll", "pitch"), ("roll", "yaw"), ("pitch", "yaw"))
        return (level, level, upright), {(f"k_{a}_m", f"k_{b}_m"): 1.0 for a, b in pairs}


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
    correlations: Correlations = MappingProxyType({}),
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
    correlations
        As in :class:`analysis.inertia.result.InertiaResult`, of what hung; what is taken off is
        independent of them.
    """
    mass, x = given_or_none(model, "mass_kg"), given_or_none(model, "cg_x_m")
    z = cg_z or given_or_none(model, "cg_z_m")
    known = {"mass_kg": mass, "cg_x_m": x, "cg_z_m": z}
    missing = tuple(f"model.{key}" for key, value in known.items() if value is None)
    if mass is None or x is None or z is None or not gyradii:
        return None, missing or ("a gyradius",)
    if take_off:
        (mass, x, z), gyradii, correlations = _without(
            name, (mass, x, z), gyradii, take_off, correlations
        )
    result = InertiaResult(
        name, mass, x, z, dict(gyradii), tuple(budgets), tuple(flags), correlations
    )
    return result, ()


def correlation(first: Budget, second: Budget, first_u: float, second_u: float) -> float:
    """Return the correlation of two results that come from some of the same inputs.

    Parameters
    ----------
    first_u, second_u
        Standard uncertainties of the results that are correlated, which may have more to them.
    """
    if not (first_u > 0.0 and second_u > 0.0):
        return 0.0
    own, other = (
        {line.name: line.contribution for line in budget.shares} for budget in (first, second)
    )
    covariance = sum(value * other.get(name, 0.0) for name, value in own.items())
    for (a, b), r in {**first.correlations, **second.correlations}.items():
        covariance += r * own.get(a, 0.0) * other.get(b, 0.0)
        covariance += r * own.get(b, 0.0) * other.get(a, 0.0)
    return min(max(covariance / (first_u * second_u), -1.0), 1.0)


def _without(
    name: str,
    whole: tuple[Estimate, Estimate, Estimate],
    gyradii: Mapping[str, Estimate],
    take_off: Sequence[PartTable],
    correlations: Correlations,
) -> tuple[tuple[Estimate, Estimate, Estimate], dict[str, Estimate], Correlations]:
    """Take parts off by the parallel axis theorem, covariances and all."""
    nothing = exactly(0.0, "m")
    mass, x, z = whole
    roll, pitch, yaw = (gyradii.get(axis, nothing) for axis in AXES)
    tied = {(_PLACES.get(a, a), _PLACES.get(b, b)): r for (a, b), r in correlations.items()}
    hung = part(name, mass, (x, nothing, z), (roll, pitch, yaw), correlations=tied)
    left = combine(name, [hung], without=[one.part() for one in take_off])
    own = dict(zip(AXES, left.gyradii, strict=True))
    kept = {
        axis: replace(own[axis], degrees_of_freedom=value.degrees_of_freedom)
        for axis, value in gyradii.items()
    }
    names = {place: name for name, place in _PLACES.items()}
    known = {"mass_kg", *_PLACES, *(f"k_{axis}_m" for axis in kept)}
    own_tied = {(names.get(a, a), names.get(b, b)): r for (a, b), r in left.correlations().items()}
    own_tied = {pair: r for pair, r in own_tied.items() if set(pair) <= known}
    return (left.mass, left.centre_of_gravity[0], left.centre_of_gravity[2]), kept, own_tied
