"""The tank around the model: its transverse modes, the delay of its echoes, and its narrowness.

Waves that the model sends to the walls come back. What stands between the walls are transverse
modes: whole waves for heave and pitch (w_m^2 = (2 pi m g/W) tanh(2 pi m h/W)), odd half waves for
sway and yaw. Each is a resonance in added mass and damping, a Lorentzian

    K_m(s) = b 2 zeta w_m s / (s^2 + 2 zeta w_m s + w_m^2)

that adds b to the damping at w_m and a ripple of both signs to the added mass around it. It is
passive by its form, so the model with walls is so as well.

A model that oscillates from rest is undisturbed until the first echo is back, after W/c_g with the
group velocity c_g (:func:`echo_delay_s`). A few modes do not reproduce that silence, as their sum
answers from the start; so they have no input until then. Modes also say nothing of waves that run
along the tank, which is why their strength and damping are given, not computed; at forward speed
the model outruns its echoes.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2
from sim.model.water.radiation import Radiation


@dataclass(frozen=True)
class Tank:
    """A tank of rectangular section with the model on its centre line.

    Attributes
    ----------
    modes
        How many transverse modes are represented.
    strength
        Damping that a mode adds at its frequency, relative to the open water's there: some tenths.
    damping_ratio
        zeta of the modes: how soon waves between the walls die or run away along the tank.
    falls, reference_rad_s
        Power of the frequency with which a mode's strength falls, and where it is ``strength``:
        beaches and rough walls take more of short waves.

    Raises
    ------
    ConfigurationError
        If a value is out of its range.
    """

    breadth_m: float
    depth_m: float
    modes: int = 4
    strength: float = 0.3
    damping_ratio: float = 0.02
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2
    falls: float = 0.0
    reference_rad_s: float = 1.0

    def __post_init__(self) -> None:
        for name in ("breadth_m", "depth_m", "gravity_m_s2"):
            if not getattr(self, name) > 0.0:
                raise ConfigurationError(f"{name} = {getattr(self, name)} must be positive")
        if self.modes < 0:
            raise ConfigurationError(f"modes = {self.modes} must not be negative")
        if not 0.0 <= self.strength <= 10.0:
            raise ConfigurationError(f"strength = {self.strength} must be from 0 to 10")
        if not 0.0 < self.damping_ratio < 1.0:
            raise ConfigurationError(
                f"damping_ratio = {self.damping_ratio} must be between 0 and 1"
            )

    def mode_frequencies_rad_s(self, plane: Plane) -> FloatArray:
        """Return w_m of the modes that motions of this plane drive, rising, ``(modes,)``."""
        m = np.arange(1, self.modes + 1)
        waves = m if plane is Plane.VERTICAL else m - 0.5
        number = 2.0 * math.pi * waves / self.breadth_m
        omega: FloatArray = np.sqrt(self.gravity_m_s2 * number * np.tanh(number * self.depth_m))
        return omega


def with_walls(
    radiation: Radiation,
    tank: Tank,
    plane: Plane,
    constant_damping: ArrayLike = 0.0,
    onset_s: float = 0.0,
) -> Radiation:
    """Return the radiation in the tank: that of open water with the tank's modes added.

    A mode drives both degrees of freedom as they radiate at its frequency: it adds ``strength``
    times the damping matrix there, with two states for each independent motion that radiates.
    ``constant_damping`` is what radiates besides, at all frequencies alike: shape ``(2, 2)``.
    Before ``onset_s`` after the start of a run nothing drives the modes: see :func:`echo_delay_s`.
    """
    omega = tank.mode_frequencies_rad_s(plane)
    radiated = radiation.damping(omega) + np.asarray(constant_damping)
    states, columns = [], []
    for omega_k, damping in zip(omega, radiated, strict=True):
        strength = tank.strength * (omega_k / tank.reference_rad_s) ** -tank.falls
        shapes = _factor(strength * damping)
        gain = math.sqrt(2.0 * tank.damping_ratio * omega_k)
        for shape in shapes:
            states.append([[0.0, omega_k], [-omega_k, -2.0 * tank.damping_ratio * omega_k]])
            columns += [np.zeros(2), gain * shape]
    if not states:
        return radiation
    inputs = np.array(columns)
    return radiation.joined(_along_diagonal(np.array(states)), inputs, inputs.T, onset_s)


def _along_diagonal(blocks: FloatArray) -> FloatArray:
    """Return blocks of shape ``(k, 2, 2)`` along the diagonal of a matrix, shape ``(2 k, 2 k)``."""
    count = len(blocks)
    matrix = np.zeros((count, 2, count, 2))
    matrix[np.arange(count), :, np.arange(count)] = blocks
    return matrix.reshape(2 * count, 2 * count)


def _factor(damping: FloatArray) -> list[FloatArray]:
    """Return vectors g with sum g g^T = the symmetric part of a damping matrix."""
    symmetric = (damping + damping.T) / 2.0
    # Scaled to a unit diagonal, so that the units of translation and rotation do not matter.
    scale = np.sqrt(np.maximum(np.diag(symmetric), 0.0))
    unit = np.where(scale > 0.0, scale, 1.0)
    values, vectors = np.linalg.eigh(symmetric / np.outer(unit, unit))
    pairs = zip(values, vectors.T, strict=True)
    return [math.sqrt(value) * vector * unit for value, vector in pairs if value > 1e-12]


def wave_number(
    omega_rad_s: float, depth_m: float, gravity: float = STANDARD_GRAVITY_M_S2
) -> float:
    """Return k of w^2 = g k tanh(k h), rad/m."""
    from scipy.optimize import brentq

    _check_positive(omega_rad_s=omega_rad_s, depth_m=depth_m, gravity=gravity)
    deep = omega_rad_s**2 / gravity
    shallow = omega_rad_s / math.sqrt(gravity * depth_m)

    def excess(k: float) -> float:
        return k * math.tanh(k * depth_m) - deep

    # tanh(x) < 1 and tanh(x) < x bound k from below, and tanh(x) > x/(1 + x) from above.
    return float(brentq(excess, max(deep, shallow) * (1 - 1e-12), deep + shallow, xtol=1e-14))


def group_velocity_m_s(
    omega_rad_s: float, depth_m: float, gravity: float = STANDARD_GRAVITY_M_S2
) -> float:
    """Return c_g = (w/2k) (1 + 2 k h/sinh(2 k h)): g/(2 w) in deep water, sqrt(g h) in shallow."""
    k = wave_number(omega_rad_s, depth_m, gravity)
    twice = 2.0 * k * depth_m
    # Beyond 700 the hyperbolic sine overflows, and its share is long gone.
    share = twice / math.sinh(twice) if twice < 700.0 else 0.0
    return omega_rad_s / (2.0 * k) * (1.0 + share)


def echo_delay_s(omega_rad_s: float, tank: Tank) -> float:
    """Return W/c_g: the time from the start during which no echo has come back yet."""
    return tank.breadth_m / group_velocity_m_s(omega_rad_s, tank.depth_m, tank.gravity_m_s2)


def blockage_speed_factor(model_section_m2: float, tank_section_m2: float) -> float:
    """Return the mean flow past the model over the carriage's speed: 1/(1 - A_m/A_t).

    What the return flow between hull and walls adds, by continuity; loads that go with U^2 grow by
    its square.

    Raises
    ------
    ConfigurationError
        If the model's section is negative or not smaller than the tank's.
    """
    if not 0.0 <= model_section_m2 < tank_section_m2:
        raise ConfigurationError(
            f"model_section_m2 = {model_section_m2:g} must be from 0 to below the tank's "
            f"{tank_section_m2:g}"
        )
    return 1.0 / (1.0 - model_section_m2 / tank_section_m2)


def _check_positive(**values: float) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise ConfigurationError(f"{name} = {value} must be a positive number")
