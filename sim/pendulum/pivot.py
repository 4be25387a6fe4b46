"""Rigid parts on a knife edge: the swing, with or without a model, and compound pendulums."""

import math
from dataclasses import dataclass, field

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.pendulum.body import LINEAR, PENDULUM
from sim.pendulum.coordinates import ANGLE
from sim.pendulum.resistance import Air, Resistance


@dataclass(frozen=True)
class RigidPart:
    """A rigid part of what hangs on a pivot.

    Attributes
    ----------
    lever_m
        Depth of its centre of gravity below the pivot.
    inertia_kg_m2
        About its own centre of gravity, axis along the pivot's.
    """

    mass_kg: float
    lever_m: float
    inertia_kg_m2: float

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    @property
    def about_pivot_kg_m2(self) -> float:
        """Inertia about the pivot, by the parallel axis theorem."""
        return self.inertia_kg_m2 + self.mass_kg * self.lever_m**2


@dataclass(frozen=True)
class HangingWeight:
    """A weight on a rope.

    Attributes
    ----------
    lever_m
        Horizontal distance of the rope from the pivot; the side to which it turns is positive.
    """

    mass_kg: float
    lever_m: float

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class Pendulum:
    """Parts on a knife edge or bearing: the swing, and every compound pendulum.

    ``I q'' + ... + G sin q = H cos q``: G of the parts' weights below the pivot, H of hanging
    weights and of a centre of gravity beside it, so that at rest tan q = H/G (equation 2).

    Attributes
    ----------
    parts
        The swing first, then what lies on it.
    weights
        Calibration weights on ropes at the pivot's height; each moves with its rope.
    offset_rad
        Angle at which it hangs without weights.
    linear
        True for small angles: ``G q = H``, so a period without amplitude in it.
    """

    parts: tuple[RigidPart, ...]
    weights: tuple[HangingWeight, ...] = ()
    offset_rad: float = 0.0
    resistance: Resistance = field(default_factory=Resistance)
    air: Air = field(default_factory=Air)
    linear: bool = False
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
    coordinates = (ANGLE,)

    def __post_init__(self) -> None:
        if not (self.parts and self.total_mass_kg > 0.0 and self.restoring_n_m > 0.0):
            raise ConfigurationError(
                f"a pendulum of {self.total_mass_kg:g} kg with its centre of gravity "
                f"{self.lever_m:g} m below the pivot does not swing back; both must be above 0"
            )

    @property
    def kind(self) -> int:
        """With the sine, or linear."""
        return LINEAR if self.linear else PENDULUM

    @property
    def total_mass_kg(self) -> float:
        """Mass of all parts, without hanging weights."""
        return sum(part.mass_kg for part in self.parts)

    @property
    def lever_m(self) -> float:
        """Depth R of the parts' common centre of gravity below the pivot."""
        moment = sum(part.mass_kg * part.lever_m for part in self.parts)
        return moment / self.total_mass_kg if self.total_mass_kg else 0.0

    @property
    def inertia_kg_m2(self) -> float:
        """Moment of inertia of the parts about the pivot."""
        return sum(part.about_pivot_kg_m2 for part in self.parts)

    @property
    def restoring_n_m(self) -> float:
        """G, N m: weight times depth below the pivot, the air's buoyancy taken off."""
        buoyed = 1.0 - self.air.buoyancy_ratio
        return buoyed * self.gravity_m_s2 * self.total_mass_kg * self.lever_m

    @property
    def tilting_n_m(self) -> float:
        """H, N m: the moment that tilts it at rest."""
        hanging = sum(weight.mass_kg * weight.lever_m for weight in self.weights)
        return self.gravity_m_s2 * hanging + self.restoring_n_m * math.tan(self.offset_rad)

    @property
    def rest_rad(self) -> float:
        """Angle at rest without friction and without restoring terms of the resistance."""
        ratio = self.tilting_n_m / self.restoring_n_m
        return ratio if self.linear else math.atan(ratio)

    @property
    def resistances(self) -> tuple[Resistance, ...]:
        """That of the one coordinate."""
        return (self.resistance,)

    @property
    def mass(self) -> FloatArray:
        """Inertia with hanging weights and the air that moves along."""
        hung = sum(weight.mass_kg * weight.lever_m**2 for weight in self.weights)
        body_inertia = self.inertia_kg_m2 * (1.0 + self.air.added_inertia_ratio)
        return np.array([[body_inertia + hung]])

    @property
    def stiffness(self) -> FloatArray:
        """G."""
        return np.array([[self.restoring_n_m]])

    @property
    def parameters(self) -> FloatArray:
        """H, and room."""
        return np.concatenate([[self.tilting_n_m], np.zeros(9)])

    @property
    def truth(self) -> dict[str, float]:
        """Mass, lever, inertias about pivot and centre of gravity, and those of the last part."""
        inertia = self.inertia_kg_m2 - self.total_mass_kg * self.lever_m**2
        last = self.parts[-1]
        return {
            "mass_kg": self.total_mass_kg,
            "lever_m": self.lever_m,
            "pivot_inertia_kg_m2": self.inertia_kg_m2,
            "inertia_kg_m2": inertia,
            "gyradius_m": math.sqrt(inertia / self.total_mass_kg),
            "last_part_mass_kg": last.mass_kg,
            "last_part_lever_m": last.lever_m,
            "last_part_inertia_kg_m2": last.inertia_kg_m2,
        }
