"""The model as a rigid body."""

from dataclasses import dataclass


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
