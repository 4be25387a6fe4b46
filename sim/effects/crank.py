"""The motion of a strut as a Fourier series of its crank angle, and what a wrong setting makes."""

from typing import TYPE_CHECKING

import numpy as np

from sim.effects.effect import Signature
from sim.effects.situation import Situation

if TYPE_CHECKING:
    from hardware.description.arrays import ComplexArray


def crank_harmonics(
    eccentricity_m: float, rod_length_m: float | None, rod_offset_m: float = 0.0
) -> dict[int, complex]:
    """Return ``H = S + i C`` of ``e sin + sqrt(L^2 - (e cos + o)^2) - sqrt(L^2 - o^2)`` by order.

    Up to (e/L)^5, and to first order in the offset o; a yoke has no rod.
    """
    e = eccentricity_m
    if rod_length_m is None:
        return {1: complex(e)}
    ratio = e / rod_length_m
    askew = -1j * e * rod_offset_m / rod_length_m
    return {
        0: complex(-e * (ratio / 4.0 + 3.0 * ratio**3 / 64.0 + 5.0 * ratio**5 / 256.0)),
        1: e + askew * (1.0 + 3.0 * ratio**2 / 8.0),
        2: -1j * e * (ratio / 4.0 + ratio**3 / 16.0 + 15.0 * ratio**5 / 512.0),
        3: askew * ratio**2 / 8.0,
        4: -1j * e * (ratio**3 / 64.0 + 3.0 * ratio**5 / 256.0),
    }


def linkage_signature(
    situation: Situation,
    eccentricity_m: tuple[float, float],
    turned_rad: tuple[float, float],
    rod_length_m: float | None = None,
    rod_offset_m: float = 0.0,
) -> Signature:
    """Return the signature of struts that move otherwise than set.

    Whatever the crank makes appears at order n with n times the strut's crank angle.

    Parameters
    ----------
    eccentricity_m, turned_rad
        Real eccentricity of each strut (aft, fore), and how far its crank is ahead of the setting.
    rod_length_m, rod_offset_m
        Of the real rod, if it is not the nominal one.
    """
    nominal_rod = situation.rig.oscillator.rod_length_m
    rod = nominal_rod if rod_length_m is None else rod_length_m
    as_set = crank_harmonics(situation.amplitude_m, nominal_rod)
    real = [crank_harmonics(e, rod, rod_offset_m) for e in eccentricity_m]
    ahead = np.exp(1j * np.array(turned_rad))
    changes: dict[int, ComplexArray] = {}
    for order in {*as_set, *real[0]}:
        moved = np.array([phasors.get(order, 0.0) for phasors in real]) * ahead**order
        changes[order] = (moved - as_set.get(order, 0.0)) * situation.turn**order
    return situation.moved(changes)
