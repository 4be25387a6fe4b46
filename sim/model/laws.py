"""Forces that depend on the motion at once: drag, springs, friction; each one small law.

A law gives the force that a strut (or the couple that both) has to exert because of it, positive
along the motion, from the motion at one :class:`sim.model.law_point.Point` of the model.

Each law is written once, as a function of its parameters and of the motion at one instant or at an
array of them: :func:`sim.solve.compilation.compile_loop` makes compiled ones of the same functions.
A new law is such a function, its class, and its line in :data:`AnyLaw` and :func:`law_value`; a law
of one's own needs a class with a method ``force`` only.

A law that jumps where the velocity changes sign is averaged over the sample: the velocity is taken
as linear over the sample, so that sgn(v) becomes the part of the sample with v > 0 less the part
with v < 0. Its harmonics then lack sinc(n w h / 2), as those of every mean over a sample do: 4e-5
of the first at 200 samples a period, where sampling sgn(v) itself is off by up to 1.5 %. A periodic
steady state has no samples: there the law is integrated between its ``corners``, which it names.
"""

import math
from dataclasses import dataclass
from typing import Final, get_args

import numpy as np

from sim.mechanism.geometry import Value
from sim.model.force_law import (
    CREEP_M_S,
    Argument,
    Corner,
    LawInput,
    NumberedLaw,
    Parameters,
    dynamic,
    half_change,
)
from sim.model.friction import (
    Coulomb,
    LoadFriction,
    RubbingSpring,
    Stribeck,
    coulomb,
    load_friction,
    rubbing_spring,
    stribeck,
)


def _viscous(p: Parameters, at: LawInput) -> Value:
    return p[0] * at.velocity


@dataclass(frozen=True)
class Viscous(NumberedLaw):
    """``b v``."""

    viscous_n_s_m: float

    kernel = staticmethod(_viscous)
    strengths = ("viscous_n_s_m",)


def _quadratic(p: Parameters, at: LawInput) -> Value:
    velocity = at.velocity + p[1]
    return p[0] * velocity * np.abs(velocity)


@dataclass(frozen=True)
class Quadratic(NumberedLaw):
    """``B (v + v0) |v + v0|``, with a mean velocity v0 (drift)."""

    quadratic_n_s2_m2: float
    drift_m_s: float = 0.0

    kernel = staticmethod(_quadratic)
    strengths = ("quadratic_n_s2_m2",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the flow turns."""
        return (Corner(Argument.VELOCITY, -self.drift_m_s),)


def _power(p: Parameters, at: LawInput) -> Value:
    # The mean over the sample, by its integral: friction rises steeply from rest.
    half, velocity, more = half_change(at), at.velocity + p[3], p[2] + 1.0
    low, high = np.abs(velocity - half) / p[1], np.abs(velocity + half) / p[1]
    return p[0] * p[1] * (high**more - low**more) / (2.0 * more * half)


@dataclass(frozen=True)
class Power(NumberedLaw):
    """``F (|v + v0|/V)^n sgn(v + v0)``: F at the speed V, with a mean velocity v0 (drift)."""

    power_n: float
    reference_m_s: float
    exponent: float
    drift_m_s: float = 0.0

    kernel = staticmethod(_power)
    strengths = ("power_n",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the flow turns."""
        return (
            Corner(Argument.VELOCITY, -self.drift_m_s - CREEP_M_S),
            Corner(Argument.VELOCITY, -self.drift_m_s + CREEP_M_S),
        )


def _cubic(p: Parameters, at: LawInput) -> Value:
    return p[0] * at.velocity**3


@dataclass(frozen=True)
class Cubic(NumberedLaw):
    """``B v^3``."""

    cubic_n_s3_m3: float

    kernel = staticmethod(_cubic)
    strengths = ("cubic_n_s3_m3",)


def _spring(p: Parameters, at: LawInput) -> Value:
    return p[3] + at.position * (p[0] + at.position * (p[1] + at.position * p[2]))


@dataclass(frozen=True)
class Spring(NumberedLaw):
    """``F_0 + k x + k_2 x^2 + k_3 x^3``: a cable, a flaring hull."""

    stiffness_n_m: float = 0.0
    stiffness_n_m2: float = 0.0
    stiffness_n_m3: float = 0.0
    preload_n: float = 0.0

    kernel = staticmethod(_spring)
    strengths = (
        "stiffness_n_m",
        "stiffness_n_m2",
        "stiffness_n_m3",
        "preload_n",
    )


def _stiffening(p: Parameters, at: LawInput) -> Value:
    size = p[0] * np.abs(at.position / p[1]) ** p[2]
    return size if p[3] > 0.0 else np.sign(at.position) * size


@dataclass(frozen=True)
class Stiffening(NumberedLaw):
    """``F |x/X|^n sgn(x)``: F at the displacement X; without the sign where it is ``even``."""

    stiffening_n: float
    reference_m: float
    exponent: float
    even: bool = False

    kernel = staticmethod(_stiffening)
    strengths = ("stiffening_n",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return the middle, where it bends."""
        return (Corner(Argument.POSITION),)


def _proximity(p: Parameters, at: LawInput) -> Value:
    return p[0] * dynamic(p[3], at) * ((p[1] / (p[1] - at.position)) ** p[2] - 1.0)


@dataclass(frozen=True)
class Proximity(NumberedLaw):
    """``F_0 (U/U_0)^2 ((h/(h - x))^p - 1)``: a wall, or the bottom, at the distance h."""

    proximity_n: float
    clearance_m: float
    exponent: float = 2.0
    reference_speed_m_s: float | None = None

    kernel = staticmethod(_proximity)
    strengths = ("proximity_n",)


def _exponential(p: Parameters, at: LawInput) -> Value:
    return p[0] * dynamic(p[2], at) * np.expm1(p[1] * at.position)


@dataclass(frozen=True)
class Exponential(NumberedLaw):
    """``F_0 (U/U_0)^2 (exp(k x) - 1)``: suction below a free surface."""

    suction_n: float
    rate_1_m: float
    reference_speed_m_s: float | None = None

    kernel = staticmethod(_exponential)
    strengths = ("suction_n",)


def _tone(p: Parameters, at: LawInput) -> Value:
    decay = 1.0 if math.isnan(p[3]) else np.exp(-at.time_s / p[3])
    return p[0] * decay * np.sin(2.0 * math.pi * p[1] * at.time_s + p[2])


@dataclass(frozen=True)
class Tone(NumberedLaw):
    """A force from outside at a frequency of its own: waves left over, shed vortices.

    It decays with ``decay_s`` if that is given. Being no multiple of the shaft's frequency, it has
    no part in the periodic steady state.
    """

    tone_n: float
    tone_hz: float
    tone_phase_rad: float = 0.0
    decay_s: float | None = None

    periodic = False

    kernel = staticmethod(_tone)
    strengths = ("tone_n",)


# The laws that a configuration file can name, told apart by their keys.
AnyLaw = (
    Viscous
    | Quadratic
    | Cubic
    | Spring
    | Proximity
    | Exponential
    | Tone
    | Coulomb
    | Stribeck
    | LoadFriction
    | RubbingSpring
    | Power
    | Stiffening
)
LAWS: Final[tuple[type[NumberedLaw], ...]] = get_args(AnyLaw)


def law_value(number: int, p: Parameters, at: LawInput) -> Value:  # noqa: C901  # a branch a law
    """Return the force of the law with a number: the place of its class in :data:`LAWS`."""
    if number == 0:
        return _viscous(p, at)
    if number == 1:
        return _quadratic(p, at)
    if number == 2:
        return _cubic(p, at)
    if number == 3:
        return _spring(p, at)
    if number == 4:
        return _proximity(p, at)
    if number == 5:
        return _exponential(p, at)
    if number == 6:
        return _tone(p, at)
    if number == 7:
        return coulomb(p, at)
    if number == 8:
        return stribeck(p, at)
    if number == 9:
        return load_friction(p, at)
    if number == 10:
        return rubbing_spring(p, at)
    if number == 11:
        return _power(p, at)
    return _stiffening(p, at)
