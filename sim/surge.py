"""Along the model: what the water holds it back with, and what the strut then exerts on it."""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.struts import to_motion
from sim import signals
from sim.period import Period, Spectra
from sim.signals import FloatArray, Signal, Signals
from sim.stage import UNKNOWN_KEYS_REFUSED, Block


@dataclass(frozen=True)
class SurgeForces:
    """Force of the water along the model, ahead positive, by the motion through the water.

    With the flow's speed U along the model, the velocity v across it and the rate of turn r (w and
    q in the vertical plane):

        X = x_u U + x_uu U abs(U) + x_vv v^2 + x_vr v r + x_rr r^2

    Attributes
    ----------
    x_u, x_uu
        Resistance, negative: N s/m and N s2/m2.
    x_vv, x_vr, x_rr
        N s2/m2, N s2/m and N s2.
    """

    x_u: float = 0.0
    x_uu: float = 0.0
    x_vv: float = 0.0
    x_vr: float = 0.0
    x_rr: float = 0.0

    __pydantic_config__: ClassVar = UNKNOWN_KEYS_REFUSED

    def force(self, ahead: FloatArray, across: FloatArray, turn: FloatArray) -> FloatArray:
        """Return X in N for U, v (m/s) and r (rad/s)."""
        resistance = (self.x_u + self.x_uu * np.abs(ahead)) * ahead
        return np.asarray(
            resistance + self.x_vv * across**2 + self.x_vr * across * turn + self.x_rr * turn**2
        )


@dataclass(frozen=True)
class Surge:
    """The strut that holds the model along the tank; it is stiff, and the model follows the struts.

    It exerts what the model's own acceleration along its axis asks for, less X:

        m (-s a q - x_G q'^2) - X

    with the translation's acceleration a, the rotation q, and s = +1 in the vertical, -1 in the
    horizontal plane.

    Attributes
    ----------
    drift_rad
        Steady heading of the model against the carriage's way.
    """

    plane: Plane
    half_spacing_m: float
    body: Body
    forces: SurgeForces | None = None
    drift_rad: float = 0.0
    flow_factor: float = 1.0

    name: ClassVar[str] = "surge"
    reads: ClassVar[tuple[Signal, ...]] = signals.MODEL_MOTION
    writes: ClassVar[tuple[Signal, ...]] = (signals.FORCE_X,)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the force follows from the motion at once."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:
        """Return the strut's force on the model over the block."""
        return state, {signals.FORCE_X.name: self._force(inputs)}

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of the force."""
        waves = {one.name: period.values(inputs[one.name]) for one in self.reads}
        return period, {signals.FORCE_X.name: period.harmonics(self._force(waves))}

    def _force(self, inputs: Signals) -> FloatArray:
        columns = [inputs[one.name] for one in self.reads[:6]]
        (_, angle), (pace, turn), (rate, _) = (
            to_motion(aft, fore, self.half_spacing_m, self.plane)
            for aft, fore in zip(columns[::2], columns[1::2], strict=True)
        )
        side = 1.0 if self.plane is Plane.VERTICAL else -1.0
        body = self.body
        inertia = body.mass_kg * (-side * rate * angle - body.cg_x_m * turn**2)
        if self.forces is None:
            return np.asarray(inertia)
        speed = self.flow_factor * inputs[signals.CARRIAGE_SPEED.name]
        ahead = speed * math.cos(self.drift_rad)
        across = pace + side * (ahead * angle + speed * math.sin(self.drift_rad))
        return np.asarray(inertia - self.forces.force(ahead, across, turn))
