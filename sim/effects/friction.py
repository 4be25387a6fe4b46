"""Common parts of what rubs and damps in one form or another. No effect itself."""

from collections.abc import Callable
from dataclasses import replace
from typing import Final

from sim.effects.hydrodynamics import with_laws
from sim.effects.typical import power_share, speed_m_s
from sim.model.force_law import ForceLaw
from sim.model.law_point import Acting, Point
from sim.model.laws import Power
from sim.rig import SimulatedRig

BOTH_MOTIONS: Final = (Point.THROUGH_WATER, Point.ROTATION)
UNLIKE: Final = "by which share the aft strut has more than said, and the fore strut less"


def at_both_struts(rig: SimulatedRig, law: ForceLaw, unlike: float = 0.0) -> SimulatedRig:
    """Return the rig with a law at each strut.

    Parameters
    ----------
    unlike
        See :data:`UNLIKE`.
    """
    laws = [law.scaled(share_at(strut, unlike)) if unlike else law for strut in range(2)]
    acting = map(Acting, laws, (Point.AFT, Point.FORE))
    return replace(rig, forces=(*rig.forces, *acting))


def share_at(strut: int, unlike: float) -> float:
    """Return how much of what is said a strut has, 0 for aft and 1 for fore; :data:`UNLIKE`."""
    return 1.0 - unlike if strut else 1.0 + unlike


def power_law(
    strength: float, exponent: float, new_exponent: float, speed: float, drift: float = 0.0
) -> Power:
    """Return ``B |v|^n sgn(v)`` with another exponent, and the same first harmonic at a speed.

    Parameters
    ----------
    strength, exponent
        B and n of the law whose place it takes.
    new_exponent
        The exponent that it has.
    speed, drift
        Amplitude and mean of the velocity, in its unit.
    """
    as_large = power_share(exponent) / power_share(new_exponent)
    return Power(strength * speed**exponent * as_large, speed, new_exponent, drift)


def with_damping(
    rig: SimulatedRig,
    sizes: tuple[float, float],
    exponent: float,
    power: float,
    law: Callable[[float], ForceLaw],
) -> SimulatedRig:
    """Return the rig with damping of both motions that goes with a power of their velocities.

    Parameters
    ----------
    sizes
        Of translation and rotation.
    exponent, law
        Of the power that the sizes are meant for; another one has as large a first harmonic.
    """
    speed = speed_m_s(rig)
    laws = [
        law(size) if power == exponent else power_law(size, exponent, power, typical)
        for size, typical in zip(sizes, (speed, speed / rig.oscillator.half_spacing_m), strict=True)
    ]
    return with_laws(rig, *zip(BOTH_MOTIONS, laws, strict=True))
