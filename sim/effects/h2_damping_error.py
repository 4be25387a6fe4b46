"""H2: a linear damping that is not the one that was believed."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.hydrodynamics import damping_at, load, with_more
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class DampingError(Effect):
    """``dB w a`` in quadrature, and with forward speed ``dB U`` per rotation; absent in air.

    Relative to the damping at the run's frequency; the coupling of both motions is left.
    """

    code = "H2"
    name = "damping-error"
    title = "Linear damping other than believed"
    stage = StageName.MODEL

    translation: float = parameter(
        0.2,
        -0.9,
        3.0,
        "1",
        "of heave or sway, relative",
        one_sign="damping stays positive: it is short of a belief by less than it may exceed it",
    )
    rotation: float = parameter(
        0.2,
        -0.9,
        3.0,
        "1",
        "of pitch or yaw, relative",
        one_sign="damping stays positive: it is short of a belief by less than it may exceed it",
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this damping on top of what its water has."""
        return with_more(rig, damping=self._damping_change(rig, set_point))

    def signature(self, situation: Situation) -> Signature:
        """Return ``dB`` times the velocity through the water."""
        more = self._damping_change(situation.rig, situation.set_point).astype(np.complex128)
        return load(situation, lambda _: more)

    def _damping_change(self, rig: SimulatedRig, set_point: SetPoint) -> FloatArray:
        damping = np.diag(damping_at(rig, 2.0 * np.pi * set_point.frequency_hz))
        more: FloatArray = np.diag(damping * (self.translation, self.rotation))
        return more
