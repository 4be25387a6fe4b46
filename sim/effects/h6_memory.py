"""H6: a water that remembers: added mass and damping depend on the frequency."""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.hydrodynamics import load, radiation_of
from sim.effects.situation import Situation
from sim.effects.typical import omega_rad_s
from sim.rig import SimulatedRig

_APART: Final = 4.0  # of two rates of a kernel


@dataclass(frozen=True)
class Memory(Effect):
    """A kernel ``K exp(-beta t)``: with N = beta^2 + w^2, ``B = K beta/N`` and ``A = A_inf - K/N``.

    Linear in the amplitude; both parts are tied to each other as Kramers and Kronig have it, and
    the first cycles after the start are unlike the later ones. No hull's kernel is one exponential:
    a share of it fades more slowly, or sooner; the whole is as large at a typical frequency.
    """

    code = "H6"
    name = "memory"
    title = "Memory of the water"
    stage = StageName.MODEL

    translation_n_m: float = parameter(
        200.0, 0.0, 50000.0, "N/m", "K of heave or sway", one_sign="waves only carry energy away"
    )
    rotation_n_m_rad: float = parameter(
        60.0, 0.0, 20000.0, "N m/rad", "K of pitch or yaw", one_sign="waves only carry energy away"
    )
    rate_1_s: float = parameter(
        5.0, 0.1, 100.0, "1/s", "beta, at which it fades", one_sign=OneSign.RATE
    )

    slow: float = parameter(
        0.0,
        0.0,
        0.9,
        "1",
        "share of the kernel that fades at a quarter of the rate",
        one_sign=OneSign.SHARE,
        forms=(0.3,),
    )
    quick: float = parameter(
        0.0,
        0.0,
        0.9,
        "1",
        "share of the rest that fades at four times the rate",
        one_sign=OneSign.SHARE,
        forms=(0.5,),
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with this memory, a state for each motion and rate, beside what it has."""
        kernel = np.diag([self.translation_n_m, self.rotation_n_m_rad])
        parts, s = self._parts, 1j * omega_rad_s(rig)
        response = sum(share / (rate + s) for rate, share in parts)
        as_large = 1.0 / (abs(response) * abs(self.rate_1_s + s))
        radiation = radiation_of(rig)
        for rate, share in parts:
            fading = -rate * np.eye(2)
            radiation = radiation.joined(fading, np.eye(2), as_large * share * kernel)
        return replace(rig, radiation=radiation)

    @property
    def _parts(self) -> list[tuple[float, float]]:
        """Rates and shares of the kernel's exponentials."""
        rest = 1.0 - self.slow
        shares = (rest * (1.0 - self.quick), self.slow, rest * self.quick)
        rates = (self.rate_1_s, self.rate_1_s / _APART, self.rate_1_s * _APART)
        return [(rate, share) for rate, share in zip(rates, shares, strict=True) if share]

    def signature(self, situation: Situation) -> Signature:
        """Return ``K/(beta + s)`` times the velocity through the water."""
        kernel = np.diag([self.translation_n_m, self.rotation_n_m_rad]).astype(np.complex128)
        return load(situation, lambda s: kernel / np.complex128(self.rate_1_s + s))
