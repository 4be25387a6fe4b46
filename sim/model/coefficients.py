"""The model's own mass and weight, and the linear reaction of the water."""

from dataclasses import dataclass

from hardware.description.body import Body
from hardware.description.oscillator import Plane
from sim.model.water.hydrostatics import Matrix
from sim.stage import UNKNOWN_KEYS_REFUSED

_NONE: Matrix = ((0.0, 0.0), (0.0, 0.0))


@dataclass(frozen=True)
class HullCoefficients:
    """Linear reaction of the water, constant over frequency.

    Each matrix has the rows force (N) and moment (N m) and the columns translation and rotation, in
    SI units, about the midpoint: heave and pitch (bow up), or sway and yaw (bow to starboard).
    Positive values are those of a force that the struts have to exert.

    Attributes
    ----------
    added_mass
        Per acceleration of the model through the water: kg and kg m; kg m and kg m^2.
    damping
        Per velocity of the model through the water, the translation being that of the angle of
        attack (see :class:`sim.model.hull.Hull`): N s/m and N s; N s and N m s.
    restoring
        Per displacement: the change of buoyancy, without the model's weight: N/m and N; N and N m.
    """

    added_mass: Matrix = _NONE
    damping: Matrix = _NONE
    restoring: Matrix = _NONE

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


def mass_matrix(body: Body, plane: Plane) -> Matrix:
    """Return the model's mass matrix about the midpoint, in kg, kg m and kg m^2.

    A centre of gravity ahead of the midpoint moves up with the bow and to starboard with it, so the
    coupling is -m x_G for heave and pitch and +m x_G for sway and yaw.
    """
    coupling = body.mass_kg * body.cg_x_m * (-1.0 if plane is Plane.VERTICAL else 1.0)
    return ((body.mass_kg, coupling), (coupling, body.inertia_kg_m2))
