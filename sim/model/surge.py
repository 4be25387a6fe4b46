"""Surge: the water's resistance along the model."""

from dataclasses import dataclass

from sim.stage import UNKNOWN_KEYS_REFUSED


@dataclass(frozen=True)
class SurgeForces:
    """Force of the water along the model, ahead positive, by the motion through the water.

    With the velocities u along the model and v across it and the rate of turn r (w and q in the
    vertical plane):

        X = x_u u + x_uu u abs(u) + x_vv v^2 + x_vr v r + x_rr r^2

    Attributes
    ----------
    x_u, x_uu
        Resistance, negative: N s/m and N s2/m2.
    x_vv, x_vr, x_rr
        N s2/m2, N s2/m and N s2.
    """

    x_u: float = 0.0
    x_uu: float = 0.0
    x_vv: float = 0.0
    x_vr: float = 0.0
    x_rr: float = 0.0

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED
