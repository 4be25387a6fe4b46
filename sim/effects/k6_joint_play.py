"""K6: play in the last joint of the struts, where friction holds the model within it."""

import math
from dataclasses import dataclass, replace

import numpy as np

from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect, OneSign, Signature, StageName, parameter
from sim.effects.friction import UNLIKE, share_at
from sim.effects.situation import Situation
from sim.rig import SimulatedRig

HIGHEST = 5


@dataclass(frozen=True)
class JointPlay(Effect):
    """The model stops at each reversal until the clearance 2 h is taken up: flat tops, and a lag.

    In phase ``(e/pi) (pi/2 + asin k + k sqrt(1 - k^2))`` with k = 1 - 2 h/e, in quadrature
    ``-(4 h/pi) (1 - h/e)``; a third harmonic of about 0.4 h. Falls with the amplitude.
    """

    code = "K6"
    name = "joint-play"
    title = "Play in the struts' last joints, taken up against friction"
    stage = StageName.MECHANISM
    taken_up = True

    half_play_m: float = parameter(
        5e-5, 0.0, 1e-3, "m", "clearance to either side, h", one_sign=OneSign.PLAY
    )
    unlike: float = parameter(0.0, -1.0, 1.0, "1", UNLIKE, forms=(0.3,))

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        """Return the rig with the play in both struts."""
        shares = (share_at(strut, self.unlike) for strut in range(2))
        aft, fore = (
            replace(setting, half_play_m=setting.half_play_m + share * self.half_play_m)
            for setting, share in zip((rig.linkage_aft, rig.linkage_fore), shares, strict=True)
        )
        return replace(rig, linkage_aft=aft, linkage_fore=fore)

    def signature(self, situation: Situation) -> Signature:
        """Return the Fourier coefficients of the motion behind a yoke's joint; exact."""
        e = situation.amplitude_m
        changes = {}
        for order in range(1, HIGHEST + 1, 2):
            change = _played(e, self.half_play_m, order) - (e if order == 1 else 0.0)
            changes[order] = np.asarray(change * situation.turn**order)
        return situation.moved(changes)


def _played(e: float, h: float, order: int) -> complex:
    """Return ``S + i C`` behind the joint: e - h from the top to where e sin + h has come to it."""
    if h >= e:
        return 0j
    caught, bottom = math.pi - math.asin(1.0 - 2.0 * h / e), 1.5 * math.pi
    total = (
        (e - h) * _wave(order, math.pi / 2.0, caught)
        + h * _wave(order, caught, bottom)
        + e * (_wave(order - 1, caught, bottom) - _wave(order + 1, caught, bottom)) / 2j
    )
    return 2j * total / math.pi


def _wave(order: int, start: float, end: float) -> complex:
    """Return the integral of exp(-i order th)."""
    if order == 0:
        return complex(end - start)
    waves = np.exp(-1j * order * np.array([start, end]))
    return complex(waves[0] - waves[1]) / (1j * order)
