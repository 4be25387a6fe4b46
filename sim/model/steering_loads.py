"""What propeller and rudder give the gauges of a model that the struts move."""

import numpy as np

from hardware.description.arrays import FloatArray
from sim.mechanism.geometry import gauge_readings
from sim.model.numbers import moving
from sim.model.steering import Steering


def steering_loads(
    steering: Steering, numbers: FloatArray, struts: FloatArray, flow_m_s: FloatArray
) -> FloatArray:
    """Return the readings aft, fore and along, then the signals that the steering writes.

    Parameters
    ----------
    numbers
        Of the hull (:func:`sim.model.numbers.numbers_of`).
    struts
        The struts' motion in the order of :data:`sim.signals.MODEL_MOTION`, shape ``(n, 6)``.
    flow_m_s
        Speed of the flow past the model, shape ``(n,)``.

    Raises
    ------
    ConfigurationError
        As :meth:`sim.model.propeller.OpenWater.coefficients` does.
    """
    at = moving(numbers, struts, flow_m_s)
    loads, written = steering.loads(np.stack((at.u, at.v, at.r)))
    return np.concatenate((gauge_readings(numbers, at.cosine, at.sine, *-loads), written))
