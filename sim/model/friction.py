"""Laws of dry and lubricated friction.

A law that jumps where the velocity changes sign is averaged over the sample, as
:mod:`sim.model.laws` says; :func:`sim.solve.compilation.compile_loop` makes compiled ones of the
same functions.

Friction turns with the motion in one of three ways. At once, as a sign. Over a distance, while
bristles bend the other way (P. R. Dahl, "A solid friction model", Aerospace Corporation 1968):
``dF/dx = (F_c - F sgn v)/d``, so that at a distance s behind a reversal from full sliding F is
``F_c (1 - 2 exp(-s/d))`` along the motion. There s is taken as ``v^2/(2 |a|)``, which holds for s
much less than the amplitude. Or over a speed at which a film carries, as ``tanh(v/v_f)``.
"""

import math
from dataclasses import dataclass

import numpy as np

from sim.mechanism.geometry import Value
from sim.model.force_law import (
    TURNS,
    Argument,
    Corner,
    LawInput,
    NumberedLaw,
    Parameters,
    direction,
    error_function,
    half_change,
)

# Of the speed on which a law falls or rises: beyond it 1e-4 of the force, or less, is left. It only
# parts the period.
_ENDS = 3.0
_STANDS = 1e-12  # m/s: the speed of a bristle's turn where nothing accelerates
_HALF_ROOT_PI = math.sqrt(math.pi) / 2.0


def film(speed_m_s: float, at: LawInput) -> Value:
    """Return tanh(v/v_f), averaged over the sample."""
    half = half_change(at)
    low, high = (at.velocity - half) / speed_m_s, (at.velocity + half) / speed_m_s
    # By its integral ln cosh u, less ln 2.
    risen = np.abs(high) + np.log1p(np.exp(-2.0 * np.abs(high)))
    risen = risen - np.abs(low) - np.log1p(np.exp(-2.0 * np.abs(low)))
    return risen * speed_m_s / (2.0 * half)


def bristles(distance_m: float, falls_m_s: float, at: LawInput) -> Value:
    """Return bristles' force over that of sliding at no speed, averaged over the sample.

    With u the velocity along the acceleration and ``c^2 = 2 |a| d``: -1 before the reversal,
    ``1 - 2 exp(-(u/c)^2)`` behind it; all of it times ``exp(-(u/v_s)^2)`` where the friction falls
    with the speed. The mean is that of its integral.

    Parameters
    ----------
    falls_m_s
        v_s; NaN for friction that does not fall.
    """
    half, way = half_change(at), np.copysign(1.0, at.acceleration)
    turn = np.sqrt(2.0 * np.abs(at.acceleration) * distance_m) + _STANDS
    if not math.isnan(falls_m_s):
        turn = turn / np.sqrt(1.0 + (turn / falls_m_s) ** 2)
    low, high = way * at.velocity - half, way * at.velocity + half
    behind = error_function(np.maximum(high, 0.0) / turn)
    behind = behind - error_function(np.maximum(low, 0.0) / turn)
    if math.isnan(falls_m_s):
        sliding = np.abs(high) - np.abs(low)
    else:
        sliding = error_function(np.abs(high) / falls_m_s)
        sliding = (sliding - error_function(np.abs(low) / falls_m_s)) * falls_m_s * _HALF_ROOT_PI
    return way * (sliding - 2.0 * _HALF_ROOT_PI * turn * behind) / (2.0 * half)


def _bends(presliding_m: float | None) -> tuple[Corner, ...]:
    """Return where friction turns, and for bristles where the motion begins to slow down."""
    return TURNS if presliding_m is None else (*TURNS, Corner(Argument.ACCELERATION))


def coulomb(p: Parameters, at: LawInput) -> Value:
    """Return the force of :class:`Coulomb`."""
    if not math.isnan(p[2]):
        return p[0] * bristles(p[2], math.nan, at) + p[1]
    if not math.isnan(p[3]):
        return p[0] * film(p[3], at) + p[1]
    return p[0] * direction(at) + p[1]


@dataclass(frozen=True)
class Coulomb(NumberedLaw):
    """``F_c sgn(v)``, and the constant that different friction to either side leaves.

    With F+ and F- the friction forward and backward, ``coulomb_n`` is their mean and ``uneven_n``
    is (F+ - F-)/2. The friction turns over the distance ``presliding_m``, or over the speed
    ``film_m_s``, or at once.
    """

    coulomb_n: float
    uneven_n: float = 0.0
    presliding_m: float | None = None
    film_m_s: float | None = None

    kernel = staticmethod(coulomb)
    strengths = ("coulomb_n", "uneven_n")

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and where little is left to rise."""
        if self.film_m_s is None:
            return _bends(self.presliding_m)
        end = _ENDS * self.film_m_s
        return (Corner(Argument.VELOCITY, end), Corner(Argument.VELOCITY, -end))


def stribeck(p: Parameters, at: LawInput) -> Value:
    """Return the force of :class:`Stribeck`: the mean over the sample, by its integral."""
    if not math.isnan(p[2]):
        return p[0] * bristles(p[2], p[1], at)
    half, velocity = half_change(at) / p[1], at.velocity / p[1]
    low, high = np.abs(velocity - half), np.abs(velocity + half)
    if not math.isnan(p[3]):
        power = 1.0 - p[3]
        return p[0] * ((1.0 + high) ** power - (1.0 + low) ** power) / (2.0 * power * half)
    risen = error_function(high) - error_function(low)
    return p[0] * (math.sqrt(math.pi) / 4.0) * risen / half


@dataclass(frozen=True)
class Stribeck(NumberedLaw):
    """``(F_s - F_c) exp(-(v/v_s)^2) sgn(v)``: what sticking adds to Coulomb friction.

    It turns over the distance ``presliding_m``, or at once; with a ``tail`` n, more than 1, it
    falls as ``(1 + |v|/v_s)^-n``.
    """

    excess_n: float
    stribeck_speed_m_s: float
    presliding_m: float | None = None
    tail: float | None = None

    kernel = staticmethod(stribeck)
    strengths = ("excess_n",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and where little of the force is left."""
        rest = _ENDS * self.stribeck_speed_m_s
        ends = (Corner(Argument.VELOCITY, rest), Corner(Argument.VELOCITY, -rest))
        return (*_bends(self.presliding_m), *ends)


def load_friction(p: Parameters, at: LawInput) -> Value:
    """Return the force of :class:`LoadFriction`."""
    load = p[0] * np.abs(p[2] * at.load + p[1])
    return load * (direction(at) if math.isnan(p[3]) else bristles(p[3], math.nan, at))


@dataclass(frozen=True)
class LoadFriction(NumberedLaw):
    """``mu |N + N_0| sgn(v)``: N the load that the linear parts put on the strut.

    It turns over the distance ``presliding_m``, or at once.
    """

    friction: float
    side_load_n: float = 0.0
    load_share: float = 1.0
    presliding_m: float | None = None

    kernel = staticmethod(load_friction)
    strengths = ("friction",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and where the load changes sides."""
        turns = _bends(self.presliding_m)
        if not self.load_share:
            return turns
        return (*turns, Corner(Argument.LOAD, -self.side_load_n / self.load_share))


def rubbing_spring(p: Parameters, at: LawInput) -> Value:
    """Return the force of :class:`RubbingSpring`."""
    return p[0] * np.abs(at.position) * direction(at)


@dataclass(frozen=True)
class RubbingSpring(NumberedLaw):
    """``k_h |x| sgn(v)``: a loss per cycle that does not depend on the frequency (Reid)."""

    rubbing_n_m: float

    kernel = staticmethod(rubbing_spring)
    strengths = ("rubbing_n_m",)

    @property
    def corners(self) -> tuple[Corner, ...]:
        """Return where the motion turns, and its middle."""
        return (*TURNS, Corner(Argument.POSITION))
