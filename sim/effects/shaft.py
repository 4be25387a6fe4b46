"""Motion and forces where the shaft turns unevenly, and the torques that make it do so."""

import math
from collections import defaultdict
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from hardware.description.motor import ShuntMotor, SpeedLoop
from sim.effects.effect import Signature
from sim.effects.situation import Situation
from sim.mechanism.geometry import AT_REST

if TYPE_CHECKING:
    from hardware.description.arrays import ComplexArray

HIGHEST = 12  # order that is carried on
_NOMINAL = 4  # orders of the nominal motion that count
_POWERS = 3  # of each wave


def uneven_signature(
    situation: Situation, waves: Mapping[int, complex], frequency_ratio: float = 1.0
) -> Signature:
    """Return the signature of a shaft at ``w t + Re sum_k X_k exp(i k w t)``, by Jacobi and Anger.

    ``exp(i n |X| cos u)`` is the sum of ``i^m J_m(n |X|) exp(i m u)``. Time counts from the
    photocell's pulse, which moves with the angle.

    Parameters
    ----------
    waves
        X by order k.
    frequency_ratio
        Mean speed over the one that was set.
    """
    moved: dict[int, ComplexArray] = defaultdict(lambda: np.zeros(2, dtype=np.complex128))
    moved[0] += situation.displacement(0)
    for order in range(1, _NOMINAL + 1):
        nominal = situation.displacement(order)
        for shift, factor in _spread(waves, order).items():
            value, at = factor * nominal, order + shift
            if at == 0:
                moved[0] += value.imag
            elif abs(at) <= HIGHEST:
                moved[abs(at)] += value if at > 0 else -value.conj()
    pulse = _pulse(waves)
    changes = {
        order: value * np.exp(1j * order * pulse) - situation.displacement(order)
        for order, value in moved.items()
    }
    return situation.moved(changes, frequency_ratio)


def _spread(waves: Mapping[int, complex], order: int) -> dict[int, complex]:
    """Return the factors of ``exp(i n Re sum X exp(i k u))`` by the order that they add."""
    from scipy.special import jv

    spread = {0: 1.0 + 0j}
    for step, wave in waves.items():
        unit = 1j * wave / abs(wave) if wave else 0j
        wider: dict[int, complex] = defaultdict(complex)
        for at, value in spread.items():
            for m in range(-_POWERS, _POWERS + 1):
                # (-i)^-m J_-m = i^m J_m: both signs of m have the same power of i.
                turn = unit**m if m >= 0 else (-unit.conjugate()) ** -m
                wider[at + m * step] += value * turn * float(jv(abs(m), order * abs(wave)))
        spread = wider
    return spread


def _pulse(waves: Mapping[int, complex]) -> float:
    """Return the angle w t at which the shaft passes zero."""
    pulse = 0.0
    for _ in range(_POWERS):
        pulse = -sum((wave * np.exp(1j * k * pulse)).real for k, wave in waves.items())
    return pulse


@dataclass(frozen=True)
class Yielding:
    """A shaft that gives way to a torque: ``J th'' + c th' + k th = -T``."""

    inertia_kg_m2: float
    per_speed_n_m_s: float
    per_angle_n_m: float = 0.0

    def motor(self) -> ShuntMotor:
        """Return a shunt motor that does so; its armature has next to no inductance."""
        usual = ShuntMotor()
        constant = usual.constant_v_s * usual.gear_ratio
        resistance = constant**2 / self.per_speed_n_m_s
        return ShuntMotor(
            resistance_ohm=resistance,
            inductance_h=1e-6 * resistance,
            inertia_kg_m2=0.0,
            gear_inertia_kg_m2=self.inertia_kg_m2,
            loop=SpeedLoop(integral=self.per_angle_n_m * resistance / constant),
        )

    def signature(self, situation: Situation, more: Mapping[int, complex]) -> Signature:
        """Return the signature of the nominal load, and of further torques ``Re X exp(i k u)``."""
        mean, torque = nominal_torque(situation)
        for order, value in more.items():
            torque[order] = torque.get(order, 0j) + value
        waves = {}
        for order, value in torque.items():
            s = 1j * order * situation.omega
            waves[order] = -value / (
                self.inertia_kg_m2 * s**2 + self.per_speed_n_m_s * s + self.per_angle_n_m
            )
        slower = 0.0 if self.per_angle_n_m else mean / (self.per_speed_n_m_s * situation.omega)
        return uneven_signature(situation, waves, 1.0 - slower)


def nominal_torque(situation: Situation) -> tuple[float, dict[int, complex]]:
    """Return the load of the nominal rig at the shaft: its mean, and X by order.

    The sum of F dy/dth over the struts, of first harmonics and of what they hold at rest, and the
    friction of their guides, ``F_c |dy/dth|`` and ``b w (dy/dth)^2``; ``|cos u|`` is ``2/pi`` and
    the sum of ``(4/pi) (-1)^(k+1)/(4 k^2 - 1) cos(2 k u)``.
    """
    guides = situation.rig.drive.guides
    lever = 1j * situation.displacement()
    force = situation.force() + guides.viscous_n_s_m * situation.omega * lever
    rubbing = guides.coulomb_n * np.abs(lever)
    mean = float((force * lever.conj()).real.sum()) / 2.0 + 2.0 / math.pi * float(rubbing.sum())
    lifted_n = situation.rig.oscillator.lifted * situation.system.numbers[AT_REST, :2]
    waves = {
        1: complex(lifted_n @ situation.displacement()),
        2: -complex((force * lever).sum()) / 2.0,
    }
    for order in range(2, HIGHEST + 1, 2) if guides.coulomb_n else ():
        size = (4.0 / math.pi) * (-1) ** (order // 2 + 1) / (order**2 - 1)
        wave = size * complex((rubbing * situation.turn**order).sum())
        waves[order] = waves.get(order, 0j) + wave
    return mean, waves
