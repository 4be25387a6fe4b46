"""Propeller and rudder on the model: their loads on its gauges, and those on the model's."""

from dataclasses import dataclass, replace

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.setpoint import SetPoint
from sim import signals
from sim.model.propeller import PropellerBehind
from sim.model.rudder import RudderBehind
from sim.signals import Signal

_NO_RACE = 1.0


@dataclass(frozen=True)
class Steering:
    """Propeller, rudder or both, behind the model of a horizontal oscillator.

    Attributes
    ----------
    rudder
        Stands in the propeller's race where there is one, else in the flow along the model.
    """

    propeller: PropellerBehind | None = None
    rudder: RudderBehind | None = None
    density_kg_m3: float = 1000.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def set_for(self, set_point: SetPoint) -> "Steering":
        """Return it with a run's rudder angle and revolutions."""
        return replace(
            self,
            rudder_angle_rad=set_point.rudder_angle_rad,
            revolutions_hz=set_point.revolutions_hz,
        )

    @property
    def writes(self) -> tuple[Signal, ...]:
        """What the gauges and sensors behind the model have, of what there is."""
        propeller = (signals.REVOLUTIONS, signals.PROPELLER_THRUST, signals.PROPELLER_TORQUE)
        rudder = (signals.RUDDER_ANGLE, signals.RUDDER_NORMAL_FORCE)
        has_propeller, has_rudder = self.propeller is not None, self.rudder is not None
        return propeller * has_propeller + rudder * has_rudder

    def loads(self, motion: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the loads on the model, and the signals of :attr:`writes`, a row each.

        Parameters
        ----------
        motion
            u, v and r of the midpoint through the water in body axes, shape ``(3, n)``.

        Returns
        -------
        loads
            X, Y and N of the water about the midpoint, N and N m, shape ``(3, n)``.

        Raises
        ------
        ConfigurationError
            As :meth:`sim.model.propeller.OpenWater.coefficients` does.
        """
        count, density = motion.shape[1], self.density_kg_m3
        total, rows = np.zeros((3, count)), []
        behind, race = motion[0], (_NO_RACE, motion[0] ** 2)
        if self.propeller is not None:
            behind = self.propeller.inflow(*motion)
            thrust, torque = self.propeller.loads(behind, self.revolutions_hz, density)
            total[0] += (1.0 - self.propeller.thrust_deduction) * thrust
            diameter = self.propeller.open_water.diameter_m
            race = (diameter, behind**2 + 8.0 * thrust / (np.pi * density * diameter**2))
            rows += [np.full(count, self.revolutions_hz), thrust, torque]
        if self.rudder is not None:
            angle = self.rudder_angle_rad
            normal = self.rudder.normal_force(motion, angle, behind, race, density)
            total += self.rudder.loads(normal, angle)
            rows += [np.full(count, angle), normal]
        return total, np.array(rows)
