"""H1: an added mass that is not the one that was believed."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.hydrodynamics import added_mass_at, load, with_more
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class AddedMassError(Effect):
    """``-dA w^2 a`` in phase: as a mass error, but absent in air.

    Relative to the added mass at the run's frequency; the coupling of both motions is left.
    """

    code = "H1"
    name = "added-mass-error"
    title = "Added mass other than believed"
    stage = StageName.MODEL

    translation: float = parameter(
        0.1,
        -0.5,
        1.0,
        "1",
        "of heave or sway, relative",
        one_sign="added mass stays positive: it is short of a belief by less than it may exceed it",
    )
    rotation: float = parameter(
        0.1,
        -0.5,
        1.0,
        "1",
        "of pitch or yaw, relative",
        one_sign="added mass stays positive: it is short of a belief by less than it may exceed it",
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this added mass on top of what its water has."""
        return with_more(rig, added_mass=self._added_mass_change(rig, set_point))

    def signature(self, situation: Situation) -> Signature:
        """Return ``s dA`` times the velocity through the water."""
        more = self._added_mass_change(situation.rig, situation.set_point).astype(np.complex128)
        return load(situation, lambda s: np.complex128(s) * more)

    def _added_mass_change(self, rig: SimulatedRig, set_point: SetPoint) -> FloatArray:
        added_mass = np.diag(added_mass_at(rig, 2.0 * np.pi * set_point.frequency_hz))
        more: FloatArray = np.diag(added_mass * (self.translation, self.rotation))
        return more
