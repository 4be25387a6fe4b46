"""The model as a rigid body."""

from dataclasses import dataclass, fields
from typing import Final

from hardware.description.errors import ConfigurationError


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
    displaced_kg
        Mass of the water that a model below the surface displaces. ``None``: it floats, and the
        water bears it under its centre of gravity, at the height of the midpoint; how that follows
        trim and draught is its restoring.
    buoyancy_x_m, buoyancy_z_m
        Centre of what a model below the surface displaces.

    Raises
    ------
    ConfigurationError
        If there is a centre of buoyancy without displaced mass.
    """

    mass_kg: float
    inertia_kg_m2: float
    cg_x_m: float = 0.0
    cg_z_m: float = 0.0
    displaced_kg: float | None = None
    buoyancy_x_m: float = 0.0
    buoyancy_z_m: float = 0.0

    def __post_init__(self) -> None:
        if self.displaced_kg is None and (self.buoyancy_x_m or self.buoyancy_z_m):
            raise ConfigurationError(
                "buoyancy_x_m and buoyancy_z_m are those of a model below the surface; give "
                "displaced_kg as well"
            )


@dataclass(frozen=True)
class ShipModel(Body):
    """The model as a body, and its dimensions for numbers without any and room in the tank.

    Attributes
    ----------
    length_m, beam_m, draught_m
        ``None`` where they are not stated: what needs them is not told then.
    """

    length_m: float | None = None
    beam_m: float | None = None
    draught_m: float | None = None


DIMENSIONS: Final = frozenset(field.name for field in fields(ShipModel)) - {
    field.name for field in fields(Body)
}
"""Keys of ``[model]`` that a campaign's has not."""
