"""The model as a rigid body."""

from dataclasses import dataclass, fields
from typing import Final


@dataclass(frozen=True)
class Body:
    """Mass properties of the model with everything that moves below the dynamometers.

    Attributes
    ----------
    cg_x_m, cg_z_m
        Centre of gravity from the midpoint between the struts: forward and down are positive.
    inertia_kg_m2
        Moment of inertia about the transverse (vertical plane) or vertical (horizontal plane) axis
        through the midpoint between the struts.
    """

    mass_kg: float
    inertia_kg_m2: float
    cg_x_m: float = 0.0
    cg_z_m: float = 0.0


@dataclass(frozen=True)
class Ship(Body):
    """The model as a body, and its dimensions for numbers without any and room in the tank."""

    length_m: float | None = None
    beam_m: float | None = None
    draught_m: float | None = None


DIMENSIONS: Final = frozenset(one.name for one in fields(Ship)) - {one.name for one in fields(Body)}
"""Keys of ``[model]`` that a campaign's has not."""
