"""A gear with backlash between what drives the shaft and its cranks."""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from hardware.description.errors import ConfigurationError
from hardware.description.motor import UNKNOWN_KEYS_REFUSED, Motor
from sim.drive.motor import closed_loop
from sim.solve.linear_system import LinearSystem


@dataclass(frozen=True)
class Gear:
    """A clearance in the last gear: the cranks turn freely in it.

    The teeth are a spring and a damper; the damper acts across the clearance too, as oil does. The
    motor's own inertia, before the gear, is fed forward.

    Attributes
    ----------
    backlash_rad
        Whole clearance, at the crank shaft.
    stiffness_n_m_rad, damping_n_m_s_rad
        Of the teeth in contact, at the crank shaft.
    crank_inertia_kg_m2
        Of what turns behind the gear, without the model.

    Raises
    ------
    ConfigurationError
        If one of them is not positive.
    """

    backlash_rad: float
    stiffness_n_m_rad: float = 1e4
    damping_n_m_s_rad: float = 20.0
    crank_inertia_kg_m2: float = 0.02

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def __post_init__(self) -> None:
        for key in ("backlash_rad", "stiffness_n_m_rad", "crank_inertia_kg_m2"):
            if not getattr(self, key) > 0.0:
                raise ConfigurationError(
                    f"gear: {key} = {getattr(self, key):g} must be positive; "
                    f"leave the gear out for one without backlash"
                )


@lru_cache(maxsize=128)
def geared(motor: Motor | None, gear: Gear, added_inertia_kg_m2: float) -> LinearSystem:
    """Return cranks behind a gear, and the motor before it.

    With d the cranks' deviation, d_m the motor's, and c what the teeth give back in the clearance,

        J d'' = k (d_m - d) + s (d_m' - d') - c - T

    and the motor feels the same torque, less T.

    Inputs: load torque T and c (N m). Outputs: angle (rad), speed (rad/s) and acceleration (rad/s2)
    of the cranks; opening d_m - d of the gear (rad).

    Parameters
    ----------
    motor
        ``None`` for one that turns as it is told.
    """
    front = _ideal_motor() if motor is None else closed_loop(motor, 0.0)
    m, inertia = len(front.A), gear.crank_inertia_kg_m2 + added_inertia_kg_m2
    opening = np.hstack([front.C[0], -1.0, 0.0])
    rate = np.hstack([front.C[1], 0.0, -1.0])
    teeth = gear.stiffness_n_m_rad * opening + gear.damping_n_m_s_rad * rate
    A = np.zeros((m + 2, m + 2))
    A[:m, :m] = front.A
    A[:m] += np.outer(front.B[:, 0], teeth)
    A[m, m + 1] = 1.0
    A[m + 1] = teeth / inertia
    B = np.zeros((m + 2, 2))
    B[:m, 1] = -front.B[:, 0]
    B[m + 1] = -1.0 / inertia
    C = np.zeros((4, m + 2))
    C[[0, 1], [m, m + 1]] = 1.0
    C[2], C[3] = A[m + 1], opening
    D = np.zeros((4, 2))
    D[2] = B[m + 1]
    return LinearSystem(A, B, C, D)


def _ideal_motor() -> LinearSystem:
    """Return a motor that does not deviate."""
    return LinearSystem(np.zeros((0, 0)), np.zeros((0, 1)), np.zeros((3, 0)), np.zeros((3, 1)))
