"""Loads on the struts from the model's inertia and weight, exact: force, moment, surge force.

About the reference point, in body axes; the body's points from there too. What the struts exert
less these is what they exert against the water. All of it is linear in the body's moments, mass,
m x_G, m z_G and I: :func:`inertia_terms` and :func:`weight_terms` give what each of them asks, for
many runs at once and for bodies that are known with an uncertainty.
"""

import numpy as np

from analysis.kinematics.geometry import Waves
from analysis.kinematics.motion import MotionWaves
from hardware.description.oscillator import Plane
from hardware.description.units import STANDARD_GRAVITY_M_S2


def inertia_terms(motion: MotionWaves, plane: Plane) -> Waves:
    """Return the loads per unit of m, m x_G, m z_G and I, shape ``(..., 4, 3, instants)``.

    With the centre of gravity x_G ahead and z_G down (nothing to the side):

        Y = m (v' + u r + x_G r')      N = I r' + m x_G (v' + u r)      X = m (u' - v r - x_G r^2)

        Z = m (w' - u q - x_G q' - z_G q^2)      M = I q' - m x_G (w' - u q) + m z_G (u' + w q)
        X = m (u' + w q + z_G q' - x_G q^2)
    """
    u, v, r = np.moveaxis(motion.velocity, -2, 0)
    u_rate, v_rate, r_rate = np.moveaxis(motion.rate, -2, 0)
    vertical = plane is Plane.VERTICAL
    side = -1.0 if vertical else 1.0
    along, across, none = u_rate - side * v * r, v_rate + side * u * r, np.zeros_like(r)
    below = (-(r**2), along, r_rate) if vertical else (none, none, none)
    return _stacked(
        (across, none, along),
        (side * r_rate, side * across, -(r**2)),
        below,
        (none, r_rate, none),
    )


def heel_terms(motion: MotionWaves, heel: Waves) -> Waves:
    """Return the loads besides of a body that heels, per m z_G, I_xx, product and spread.

    Horizontal plane, in axes that do not heel; rows force, moment, surge force and roll moment:
    shape ``(..., 4, 4, instants)``. With s = sin(heel), c = cos(heel), of unit m z_G, product
    (integral of x z dm) and spread (of (y^2 - z^2) dm):

        Y = s r^2 - s''    N = s (u' - v r)    X = s r' + 2 s' r    K = -c (v' + u r)
        N = -s''           K = -c r'
        N = -(s^2 r)'      K = s c r^2

    Parameters
    ----------
    heel
        Angle and its first two derivatives, shape ``(..., 3, instants)``.
    """
    u, v, r = np.moveaxis(motion.velocity, -2, 0)
    u_rate, v_rate, r_rate = np.moveaxis(motion.rate, -2, 0)
    phi, p, p_rate = np.moveaxis(heel, -2, 0)
    sine, cosine = np.sin(phi), np.cos(phi)
    rate, bend, none = cosine * p, cosine * p_rate - sine * p**2, np.zeros_like(r)
    return _stacked(
        (
            sine * r**2 - bend,
            sine * (u_rate - v * r),
            sine * r_rate + 2.0 * rate * r,
            -cosine * (v_rate + u * r),
        ),
        (none, none, none, p_rate),
        (none, -bend, none, -cosine * r_rate),
        (none, -(sine**2) * r_rate - 2.0 * sine * rate * r, none, sine * cosine * r**2),
    )


def weight_terms(pitch_rad: Waves) -> Waves:
    """Return the weight's loads per mass, m x_G and m z_G, shape ``(..., 3, 3, instants)``.

    In air and in the vertical plane; against the load, so ``Z = -m g cos(theta)``. Of buoyancy
    they are the same per displaced mass and its moments, with the other sign.
    """
    sine = STANDARD_GRAVITY_M_S2 * np.sin(pitch_rad)
    cosine = STANDARD_GRAVITY_M_S2 * np.cos(pitch_rad)
    none = np.zeros_like(sine)
    return _stacked((-cosine, none, sine), (none, cosine, none), (none, sine, none))


def _stacked(*terms: tuple[Waves, ...]) -> Waves:
    return np.stack([np.stack(term, axis=-2) for term in terms], axis=-3)
