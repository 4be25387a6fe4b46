"""H6: a water that remembers: added mass and damping depend on the frequency."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import load, radiation_of
from sim.effects.situation import Situation
from sim.rig import SimulatedRig


@dataclass(frozen=True)
class Memory(Effect):
    """A kernel ``K exp(-beta t)``: with N = beta^2 + w^2, ``B = K beta/N`` and ``A = A_inf - K/N``.

    Linear in the amplitude; both parts are tied to each other as Kramers and Kronig have it, and
    the first cycles after the start are unlike the later ones.
    """

    code: ClassVar[str] = "H6"
    name: ClassVar[str] = "memory"
    title: ClassVar[str] = "Memory of the water"
    stage: ClassVar[StageName] = StageName.MODEL

    translation_n_m: float = parameter(
        200.0, 0.0, 50000.0, "N/m", "K of heave or sway", one_sign="waves only carry energy away"
    )
    rotation_n_m_rad: float = parameter(
        60.0, 0.0, 20000.0, "N m/rad", "K of pitch or yaw", one_sign="waves only carry energy away"
    )
    rate_1_s: float = parameter(
        5.0, 0.1, 100.0, "1/s", "beta, at which it fades", one_sign=OneSign.RATE
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this memory, one state for each motion, beside what its water has."""
        kernel = np.diag([self.translation_n_m, self.rotation_n_m_rad])
        fading = -self.rate_1_s * np.eye(2)
        return replace(rig, radiation=radiation_of(rig).joined(fading, np.eye(2), kernel))

    def signature(self, situation: Situation) -> Signature:
        """Return ``K/(beta + s)`` times the velocity through the water."""
        kernel = np.diag([self.translation_n_m, self.rotation_n_m_rad]).astype(np.complex128)
        return load(situation, lambda s: kernel / np.complex128(self.rate_1_s + s))
