"""Sinkage and trim of the simulated model, as two sensors of position see them.

A model that is free to heave and pitch is sunk and trimmed by its way through the water, at each
instant as the velocities of its midpoint along and across it make it; one that is forced stands
where the struts hold it.
"""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.attitude import AttitudeSensors
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.oscillator import Plane
from sim import signals
from sim.model.hull import Hull
from sim.model.numbers import moving
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block


@dataclass(frozen=True)
class Squat:
    """How a free model sinks, ``z_uu u^2 + z_vv v^2``, and trims, ``theta_uu u^2 + theta_vv v^2``.

    Attributes
    ----------
    z_uu, z_vv
        Of the midpoint, positive down, s2/m; theta_uu and theta_vv, positive bow up, rad s2/m2.
    """

    z_uu: float = 0.0
    z_vv: float = 0.0
    theta_uu: float = 0.0
    theta_vv: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class PositionSensors:
    """What the sensors of position have of a model that its struts move."""

    sensors: AttitudeSensors
    squat: Squat
    hull: Hull

    name = "attitude"
    reads = signals.MODEL_MOTION
    writes = (signals.POSITION_AFT, signals.POSITION_FORE)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the positions follow from the motion at each instant."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:
        """Return the positions over the block."""
        return state, self._positions({signal.name: inputs[signal.name] for signal in self.reads})

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of the positions."""
        values = {signal.name: period.values(inputs[signal.name]) for signal in self.reads}
        positions = self._positions(values)
        return period, {name: period.harmonics(position) for name, position in positions.items()}

    def _positions(self, inputs: Signals) -> dict[str, FloatArray]:
        *struts, carriage = (inputs[signal.name] for signal in self.reads)
        flow = self.hull.flow_factor * carriage
        at = moving(self.hull.system.numbers, np.column_stack(struts), flow)
        if self.hull.plane is Plane.VERTICAL:
            sunk, sine = at.place, -at.tank_sine
        else:
            squat = self.squat
            sunk = squat.z_uu * at.u**2 + squat.z_vv * at.v**2
            sine = np.sin(squat.theta_uu * at.u**2 + squat.theta_vv * at.v**2)
        places = (self.sensors.aft_x_m, self.sensors.fore_x_m)
        return {signal.name: sunk - x * sine for signal, x in zip(self.writes, places, strict=True)}
