"""A7: a window that is not a whole number of cycles."""

import math
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.measurement import MOST, of_waves
from sim.effects.situation import Situation
from sim.rig import SimulatedRig

_TURN: Final = 2.0 * math.pi


@dataclass(frozen=True)
class LateGate(Effect):
    """A spurious pulse a part of a cycle late, by which the gate closes after m + d cycles.

    The signature is what the integrals over that window leave, at the true frequency: every order
    leaks into every other, slowly falling with their distance.
    """

    code = "A7"
    name = "late-gate"
    title = "Window of a non-integer number of cycles"
    stage = StageName.PHOTOCELL
    repeats = False

    fraction: float = parameter(
        0.1,
        0.001,
        0.9,
        "1",
        "d: part of a cycle by which it is too long",
        one_sign="too short by d is too long by 1 - d of one cycle fewer",
    )
    cycles: float = parameter(
        10.0,
        1.0,
        1000.0,
        "1",
        "m: cycles that are wanted, rounded",
        held=True,
        one_sign=OneSign.COUNT,
    )

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with another pulse after each one that closes the gate.

        The gate opens with the first pulse; what extra pulses the photocell had is replaced.
        """
        if rig.photocell is None:
            return rig
        photocell = replace(
            rig.photocell,
            extra_every=round(self.cycles) + 1,
            extra_after_s=self.fraction / set_point.frequency_hz,
        )
        return replace(rig, photocell=photocell)

    def signature(self, situation: Situation) -> Signature:
        """Return the Fourier integrals over m + d cycles less those over whole ones."""
        if situation.rig.photocell is None:
            return {}
        end = _TURN * (round(self.cycles) + self.fraction)

        def change(name: str, order: int) -> complex:
            wave = np.array([situation.phasor(name, n) for n in range(MOST + 1)])
            return _windowed(wave, order, end) - complex(wave[order])

        return of_waves(situation, change)


def _windowed(wave: ComplexArray, order: int, end: float) -> complex:
    """Return (2/end) int wave exp(-i order th) dth over 0 to end, as ``S + i C``; mean for 0."""
    orders = np.arange(wave.size)
    # x = Re sum X_n exp(i n th), X = -i H beyond the mean.
    two_sided = np.where(orders == 0, wave.real, -1j * wave) / np.where(orders == 0, 1.0, 2.0)
    total = np.sum(two_sided * _mean_turn(orders - order, end))
    total += np.sum(np.conj(two_sided[1:]) * _mean_turn(-orders[1:] - order, end))
    return complex(total.real) if order == 0 else complex(2j * total)


def _mean_turn(steps: np.ndarray, end: float) -> ComplexArray:
    """Return the mean of exp(i k th) over 0 to end."""
    angle = steps * end / 2.0
    mean_turn: ComplexArray = np.exp(1j * angle) * np.sinc(angle / np.pi)
    return mean_turn
