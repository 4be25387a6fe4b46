"""Forces that depend on the motion at once: friction, drag, springs; each one small law.

A law gives the force that a strut (or the couple that both) has to exert because of it, positive
along the motion, from the motion at one :class:`sim.model.law_point.Point` of the model. A new law
is a new class with a method ``force``; nothing else needs to know of it.

A law that jumps where the velocity changes sign is averaged over the sample: the velocity is taken
as linear over the sample, so that sgn(v) becomes the part of the sample with v > 0 less the part
with v < 0. Its harmonics then lack sinc(n w h / 2), as those of every mean over a sample do: 4e-5
of the first at 200 samples a period, where sampling sgn(v) itself is off by up to 1.5 %. A periodic
steady state has no samples: there the law is integrated between its ``corners``, which it names.
"""

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hardware.description.arrays import FloatArray
from sim.model.force_law import CREEP_M_S, TURNS, Argument, Corner, ForceLaw, LawInput

__all__ = ["CREEP_M_S", "ForceLaw", "LawInput"]

# Of the Stribeck speed: beyond it exp(-9), 1e-4 of the force, is left. It only parts the period.
_STRIBECK_ENDS = 3.0


@dataclass(frozen=True)
class Viscous(ForceLaw):
    """``b v``."""

    viscous_n_s_m: float

    strengths: ClassVar[tuple[str, ...]] = ("viscous_n_s_m",)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        return self.viscous_n_s_m * motion.velocity


@dataclass(frozen=True)
class Quadratic(ForceLaw):
    """``B (v + v0) |v + v0|``, with a mean velocity v0 (drift)."""

    quadratic_n_s2_m2: float
    drift_m_s: float = 0.0

    strengths: ClassVar[tuple[str, ...]] = ("quadratic_n_s2_m2",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the flow turns."""
        return (Corner(Argument.VELOCITY, -self.drift_m_s),)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        velocity = motion.velocity + self.drift_m_s
        return self.quadratic_n_s2_m2 * velocity * np.abs(velocity)


@dataclass(frozen=True)
class Cubic(ForceLaw):
    """``B v^3``."""

    cubic_n_s3_m3: float

    strengths: ClassVar[tuple[str, ...]] = ("cubic_n_s3_m3",)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        return self.cubic_n_s3_m3 * motion.velocity**3


@dataclass(frozen=True)
class Coulomb(ForceLaw):
    """``F_c sgn(v)``, and the constant that different friction to either side leaves.

    With F+ and F- the friction forward and backward, ``coulomb_n`` is their mean and ``uneven_n``
    is (F+ - F-)/2.
    """

    coulomb_n: float
    uneven_n: float = 0.0

    strengths: ClassVar[tuple[str, ...]] = ("coulomb_n", "uneven_n")

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns."""
        return TURNS

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        return self.coulomb_n * motion.direction + self.uneven_n


@dataclass(frozen=True)
class Stribeck(ForceLaw):
    """``(F_s - F_c) exp(-(v/v_s)^2) sgn(v)``: what sticking adds to Coulomb friction."""

    excess_n: float
    stribeck_speed_m_s: float

    strengths: ClassVar[tuple[str, ...]] = ("excess_n",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and where little of the force is left."""
        rest = _STRIBECK_ENDS * self.stribeck_speed_m_s
        return (*TURNS, Corner(Argument.VELOCITY, rest), Corner(Argument.VELOCITY, -rest))

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force that has to be exerted: its mean over the sample, by its integral."""
        from scipy.special import erf

        half, scale = motion.half_change / self.stribeck_speed_m_s, math.sqrt(math.pi) / 4.0
        velocity = motion.velocity / self.stribeck_speed_m_s
        risen = erf(np.abs(velocity + half)) - erf(np.abs(velocity - half))
        mean: FloatArray = self.excess_n * scale * risen / half
        return mean


@dataclass(frozen=True)
class LoadFriction(ForceLaw):
    """``mu |N + N_0| sgn(v)``: N the load that the linear parts put on the strut."""

    friction: float
    side_load_n: float = 0.0
    load_share: float = 1.0

    strengths: ClassVar[tuple[str, ...]] = ("friction",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and where the load changes sides."""
        if not self.load_share:
            return TURNS
        return (*TURNS, Corner(Argument.LOAD, -self.side_load_n / self.load_share))

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        normal = np.abs(self.load_share * motion.load + self.side_load_n)
        return self.friction * normal * motion.direction


@dataclass(frozen=True)
class Spring(ForceLaw):
    """``F_0 + k x + k_2 x^2 + k_3 x^3``: a cable, a flaring hull."""

    stiffness_n_m: float = 0.0
    stiffness_n_m2: float = 0.0
    stiffness_n_m3: float = 0.0
    preload_n: float = 0.0

    strengths: ClassVar[tuple[str, ...]] = (
        "stiffness_n_m",
        "stiffness_n_m2",
        "stiffness_n_m3",
        "preload_n",
    )

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        x = motion.position
        slope = self.stiffness_n_m + x * (self.stiffness_n_m2 + x * self.stiffness_n_m3)
        return self.preload_n + x * slope


@dataclass(frozen=True)
class RubbingSpring(ForceLaw):
    """``k_h |x| sgn(v)``: a loss per cycle that does not depend on the frequency (Reid)."""

    rubbing_n_m: float

    strengths: ClassVar[tuple[str, ...]] = ("rubbing_n_m",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and its middle."""
        return (*TURNS, Corner(Argument.POSITION))

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        return self.rubbing_n_m * np.abs(motion.position) * motion.direction


@dataclass(frozen=True)
class Proximity(ForceLaw):
    """``F_0 (U/U_0)^2 ((h/(h - x))^p - 1)``: a wall, or the bottom, at the distance h."""

    proximity_n: float
    clearance_m: float
    exponent: float = 2.0
    reference_speed_m_s: float | None = None

    strengths: ClassVar[tuple[str, ...]] = ("proximity_n",)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        ratio = self.clearance_m / (self.clearance_m - motion.position)
        return (
            self.proximity_n
            * _dynamic(motion, self.reference_speed_m_s)
            * (ratio**self.exponent - 1.0)
        )


@dataclass(frozen=True)
class Exponential(ForceLaw):
    """``F_0 (U/U_0)^2 (exp(k x) - 1)``: suction below a free surface."""

    suction_n: float
    rate_1_m: float
    reference_speed_m_s: float | None = None

    strengths: ClassVar[tuple[str, ...]] = ("suction_n",)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        dynamic = _dynamic(motion, self.reference_speed_m_s)
        return self.suction_n * dynamic * np.expm1(self.rate_1_m * motion.position)


@dataclass(frozen=True)
class Tone(ForceLaw):
    """A force from outside at a frequency of its own: waves left over, shed vortices.

    It decays with ``decay_s`` if that is given. Being no multiple of the shaft's frequency, it has
    no part in the periodic steady state.
    """

    tone_n: float
    tone_hz: float
    tone_phase_rad: float = 0.0
    decay_s: float | None = None

    periodic: ClassVar[bool] = False

    strengths: ClassVar[tuple[str, ...]] = ("tone_n",)

    def force(self, motion: LawInput) -> FloatArray:
        """Return the force."""
        turned = 2.0 * math.pi * self.tone_hz * motion.time_s + self.tone_phase_rad
        decay = 1.0 if self.decay_s is None else np.exp(-motion.time_s / self.decay_s)
        tone: FloatArray = self.tone_n * decay * np.sin(turned)
        return tone


def _dynamic(motion: LawInput, reference_speed_m_s: float | None) -> FloatArray | float:
    """Return (U/U_0)^2, or 1 where the law does not depend on the speed."""
    if reference_speed_m_s is None:
        return 1.0
    return (motion.speed_m_s / reference_speed_m_s) ** 2
