"""The motion at which the forms of an effect are as large as each other. No effect itself.

A third of the largest frequency at a third of the largest eccentricity: a law is the same in all
runs of a rig, so that what it is matched at may depend on the rig but not on the set-point.
"""

import math
from typing import Final

from sim.effects.hydrodynamics import added_mass_at, damping_at
from sim.rig import SimulatedRig

_SHARE: Final = 1.0 / 3.0


def omega_rad_s(rig: SimulatedRig) -> float:
    """Return the angular frequency."""
    return 2.0 * math.pi * _SHARE * rig.oscillator.frequency_hz.high


def amplitude_m(rig: SimulatedRig) -> float:
    """Return the amplitude of a strut."""
    return _SHARE * rig.oscillator.eccentricity_m.high


def speed_m_s(rig: SimulatedRig) -> float:
    """Return the amplitude of a strut's velocity."""
    return omega_rad_s(rig) * amplitude_m(rig)


def force_n(rig: SimulatedRig) -> float:
    """Return the amplitude of a strut's force in heave or sway.

    Inertia, damping and restoring are added as if a quarter of a turn apart: no resonance matters.
    """
    omega = omega_rad_s(rig)
    inertia = rig.body.mass_kg + float(added_mass_at(rig, omega)[0, 0])
    parts = (
        omega**2 * inertia,
        omega * float(damping_at(rig, omega)[0, 0]),
        rig.water.restoring[0][0],
    )
    return math.hypot(*parts) * amplitude_m(rig) / 2.0


def power_share(exponent: float) -> float:
    """Return the first harmonic of ``|cos|^n sgn(cos)``: 4/pi, 1, 8/(3 pi), 3/4 for n = 0 to 3."""
    return (
        2.0
        / math.sqrt(math.pi)
        * math.gamma(exponent / 2.0 + 1.0)
        / math.gamma(exponent / 2.0 + 1.5)
    )


def even_share(exponent: float) -> float:
    """Return the second harmonic of ``|cos|^n``: 4/(3 pi), 1/2 for n = 1, 2."""
    upper = 2.0 ** (1.0 - exponent) * math.gamma(exponent + 1.0)
    return float(upper / (math.gamma(exponent / 2.0 + 2.0) * math.gamma(exponent / 2.0)))
