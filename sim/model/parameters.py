"""Parameters of a model, its mounting and the water around it."""

from dataclasses import dataclass, field

from hardware.description.arrangement import Arrangement
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from sim.model.coefficients import HullCoefficients
from sim.model.law_point import Acting
from sim.model.mounting import Mounting
from sim.model.surge import SurgeForces
from sim.model.water.force_laws import CrossFlow
from sim.model.water.radiation import Radiation


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
