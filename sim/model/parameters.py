"""Parameters of a model, its mounting and the water around it."""

from dataclasses import dataclass, field
from typing import TypeAlias

from hardware.description.arrangement import Arrangement
from hardware.description.body import Body
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.oscillator import Plane
from sim.model.heel import Heeling
from sim.model.law_point import Acting
from sim.model.mounting import Mounting
from sim.model.steering import Steering
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.model.water.radiation import Radiation
from sim.model.waves import MetWaves

# Rows are force and moment, columns translation and rotation about the midpoint of the struts.
Matrix: TypeAlias = tuple[tuple[float, float], tuple[float, float]]

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


@dataclass(frozen=True)
class ModelParameters:
    """A rigid model in water on its mounting.

    Attributes
    ----------
    radiation
        The water's memory, and its added mass at infinite frequency, besides ``water``; ``None``
        where constant coefficients say all.
    laws, cross_flow
        Forces that depend on the motion at once.
    carriage_speed_m_s
        Mean speed of the flow past the model, about which the memory is linear. The carriage's
        speed itself is a signal.
    flow_factor
        Speed of the flow past the model over the carriage's.
    drift_rad
        Steady heading of the model against the carriage's way, bow to starboard or up, set as the
        arrangement says.
    arrangement
        Of struts, gauges and drift; not a turntable.
    surge
        The water's force along the model.
    afloat
        Whether buoyancy carries the model: it then displaces its own mass, centred between the
        struts' attachments in height and below the centre of gravity along the model. Else, in the
        vertical plane, the weight hangs on the struts whole.
    steering
        Propeller and rudder. Their loads go by the struts' motion, and through the mounting to the
        gauges without moving it.
    turn_rate_rad_s
        Of carriage and rig on a circle, to starboard.
    waves
        What the waves of the run do, and what their probe sees.
    heeling
        Of a model that is heeled or free to roll; its loads go by the struts' motion likewise.
    surges
        Whether the carriage's acceleration is told, and what it asks of the struts is reckoned, by
        the struts' motion likewise.
    """

    plane: Plane
    half_spacing_m: float
    body: Body
    water: HullCoefficients = field(default_factory=HullCoefficients)
    radiation: Radiation | None = None
    mounting: Mounting = field(default_factory=Mounting)
    laws: tuple[Acting, ...] = ()
    cross_flow: CrossFlow | None = None
    carriage_speed_m_s: float = 0.0
    flow_factor: float = 1.0
    drift_rad: float = 0.0
    arrangement: Arrangement = field(default_factory=Arrangement)
    surge: SurgeForces | None = None
    afloat: bool = True
    steering: Steering | None = None
    heeling: Heeling | None = None
    turn_rate_rad_s: float = 0.0
    waves: MetWaves | None = None
    surges: bool = False
