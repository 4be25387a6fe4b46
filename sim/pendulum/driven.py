"""A body on springs or afloat under a known periodic force: the motion that it settles to."""

import math
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from sim.pendulum.body import BodyState, FreeBody
from sim.pendulum.coordinates import RELEASE_HOLD
from sim.pendulum.floating import Floating
from sim.stage import Block

ORDERS: Final = 4
"""Harmonics of a force that the body is driven by."""
_SAMPLES: Final = 48  # a period
_FEWEST_RATIO: Final = 1e-3  # of critical damping, from which the motion is sought at least
_MARCHED: Final = 2  # periods before the motion is sought: what is too large falls off by itself
_CLOSED: Final = 1e-7  # of the motion: how well a period has to close


@dataclass(frozen=True)
class PeriodicForce:
    """A force, or a moment, of some harmonics: ``Re sum F_n exp(i n w t)``.

    Attributes
    ----------
    omega_rad_s
        Its fundamental.
    harmonics
        F_1 and on, at most :data:`ORDERS`, N or N m; a cosine is real, a sine is ``-i``.
    """

    omega_rad_s: float
    harmonics: tuple[complex, ...]

    def __post_init__(self) -> None:
        if not (self.omega_rad_s > 0.0 and 1 <= len(self.harmonics) <= ORDERS):
            raise ConfigurationError(
                f"a periodic force of {self.omega_rad_s:g} rad/s and {len(self.harmonics)} "
                f"harmonics: it needs a frequency above 0 and 1 to {ORDERS} harmonics"
            )

    def scaled(self, factor: complex) -> "PeriodicForce":
        """Return the force with each harmonic times a factor."""
        return replace(self, harmonics=tuple(factor * harmonic for harmonic in self.harmonics))


@dataclass(frozen=True)
class DrivenBody(Floating):
    """One free motion of a body on springs or afloat, under a force.

    ``(I + A) q'' + B q' + ... + C q + ... = f(t)``; A and B are those at the force's frequency.
    """

    force: PeriodicForce = field(default_factory=lambda: PeriodicForce(1.0, (0.0,)))

    @property
    def parameters(self) -> FloatArray:
        """No constant load; the force's frequency, then cosine and sine of each order."""
        row = np.zeros(2 + 2 * ORDERS)
        row[1] = self.force.omega_rad_s
        for at, harmonic in enumerate(self.force.harmonics):
            row[2 + 2 * at : 4 + 2 * at] = harmonic.real, -harmonic.imag
        return row


@lru_cache(maxsize=256)  # sensors of one run see one motion
def settled(body: DrivenBody, orders: int) -> ComplexArray:
    """Return the harmonics of the displacement that a body settles to under its force.

    A linear body's are F_n / (C - n^2 w^2 (I + A) + i n w B). Any other's are those of the motion
    that repeats after a period of the force, friction that holds the body included.

    Parameters
    ----------
    orders
        How many, from the first on.

    Raises
    ------
    ConfigurationError
        If there is no such motion near the linear one, or friction holds the body at rest.
    """
    linear = _linear(body)
    resistance = body.resistance
    if resistance.linear and not resistance.coulomb:
        return np.pad(linear, (0, max(orders - linear.size, 0)))[:orders]
    moved = _repeating(body, linear)
    harmonics = 2.0 * np.fft.rfft(moved)[1 : orders + 1] / moved.size
    if not abs(harmonics[0]) > _CLOSED * abs(linear[0]):
        raise ConfigurationError(
            f"friction of {resistance.coulomb:g} holds the body against its force; take less"
        )
    return np.asarray(harmonics, np.complex128)


def _linear(body: DrivenBody) -> ComplexArray:
    """Return the displacement's harmonics without what is not linear, a resonance kept finite."""
    orders = np.arange(1.0, len(body.force.harmonics) + 1.0, dtype=np.float64)
    return np.asarray(np.array(body.force.harmonics) / impedance(body, orders), np.complex128)


def impedance(body: DrivenBody, orders: FloatArray | ComplexArray) -> ComplexArray:
    """Return force over displacement at some orders of the force, but for what is not linear.

    An order may be complex: ``1 - i s/w`` is that of a force that grows with ``exp(s t)``.
    """
    omega = body.force.omega_rad_s * orders
    mass, stiffness = float(body.mass[0, 0]), body.restoring
    least = 0.0
    if not body.resistance.linear or body.resistance.coulomb:
        least = 2.0 * _FEWEST_RATIO * math.sqrt(mass * stiffness)
    damping = max(body.resistance.viscous, least)
    return np.asarray(stiffness - omega**2 * mass + 1j * omega * damping, np.complex128)


def _repeating(body: DrivenBody, linear: ComplexArray) -> FloatArray:
    """Return the displacement over a period of the motion that repeats, shape ``(samples,)``."""
    from scipy.optimize import fsolve

    omega = body.force.omega_rad_s
    orders = 1.0 + np.arange(linear.size)
    scale = np.array([1.0, omega]) * max(float(np.abs(linear).sum()), 1e-300)
    start = np.array([linear.real.sum(), -omega * float(orders @ linear.imag)]) / scale
    for _ in range(_MARCHED):
        start = _period(body, start * scale)[:, -1] / scale

    def opened(at: FloatArray) -> FloatArray:
        return np.asarray(_period(body, at * scale)[:, -1] / scale - at, np.float64)

    solution, *_ = fsolve(opened, start, epsfcn=1e-6, full_output=True)  # no warning: it is checked
    ran = _period(body, solution * scale)
    gap = float(np.abs(ran[:, -1] / scale - solution).max())
    if not gap < _CLOSED * max(float(np.abs(ran / scale[:, None]).max()), _CLOSED):
        raise ConfigurationError(
            f"the body does not settle to a motion of its force's period (it misses by {gap:.1e} "
            "of the motion); make what is not linear smaller"
        )
    return ran[0, :-1]


def _period(body: DrivenBody, state: FloatArray) -> FloatArray:
    """Return displacement and rate over a period from a state, shape ``(2, samples + 1)``."""
    (coordinate,) = body.coordinates
    rows = (RELEASE_HOLD, coordinate.held_position, coordinate.kick)
    signals = np.repeat([[0.0], *state[:, None]], _SAMPLES + 1, axis=1)
    held = {row.name: values for row, values in zip(rows, signals, strict=True)}
    rate_hz = _SAMPLES * body.force.omega_rad_s / (2.0 * math.pi)
    begun = BodyState((0.0, 0.0), (0.0,), free=False)
    _, run = FreeBody(body).run(begun, Block(0, _SAMPLES + 1, rate_hz), held)
    return np.stack([run[coordinate.displacement.name], run[coordinate.rate.name]])
