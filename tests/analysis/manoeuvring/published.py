"""Two ships in the MMG standard method: what was published of them, on plain numbers.

``rates`` writes the equations of Yasukawa and Yoshimura 2015 (J Mar Sci Technol 20, 37-52) out once
more, for one ship: the mass with its added mass on the left, hull, propeller and rudder on the
right.

* KVLCC2, model of 7 m: the same paper's tables 1 to 3.
* KCS, model of 7.28 m (scale 31.6): Yoshimura, Ueno and Tsukada, Analysis of steady hydrodynamic
  force components and prediction of manoeuvring ship motion with KVLCC1, KVLCC2 and KCS, SIMMAN
  2008; the numbers as public implementations have them. It gives the hull by powers of the drift
  angle, which stand here for those of its sine, with m_x in Y_r and m_y in X_vr, which are taken
  out; its wake stays in drift and turn, and x_P is not given.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from analysis.manoeuvring.hull import HullLoads
from analysis.manoeuvring.ship import Ship
from analysis.manoeuvring.steering import Propeller, Rudder
from tests.analysis.coefficients.kvlcc2 import DERIVATIVES


class Behind(NamedTuple):
    """Loads of propeller and rudder, and what gauges behind the ship read."""

    x: float
    y: float
    n: float
    thrust: float
    normal: float


@dataclass(frozen=True)
class Published:
    """One ship: names as the paper has them, SI units, lengths with a prime over L."""

    L: float
    D: float
    VOLUME: float
    U0: float
    X_G: float
    M_X: float
    M_Y: float
    J_Z: float
    HULL: Mapping[str, float]
    D_P: float
    K: tuple[float, float, float]
    T_P: float
    W_P0: float
    X_P: float
    C1: float
    C2: tuple[float, float]
    A_R: float
    H_R: float
    F_ALPHA: float
    T_R: float
    A_H: float
    X_H: float
    EPSILON: float
    KAPPA: float
    GAMMA: tuple[float, float]
    L_R: float
    RATE: float
    RHO: float = 1000.0

    @property
    def MASS(self) -> float:  # noqa: N802
        return self.RHO * self.VOLUME

    @property
    def I_ZG(self) -> float:  # noqa: N802
        return self.MASS * (0.25 * self.L) ** 2

    @property
    def PROPELLER(self) -> Propeller:  # noqa: N802
        return Propeller(self.D_P, self.K, self.T_P, self.W_P0, self.X_P, self.C1, *self.C2)

    @property
    def RUDDER(self) -> Rudder:  # noqa: N802
        return Rudder(
            self.A_R, self.H_R, self.F_ALPHA, self.RATE, self.T_R, self.A_H, self.X_H,
            self.EPSILON, self.KAPPA, *self.GAMMA, self.L_R,
        )  # fmt: skip

    def terms(self, **other: float) -> dict[str, np.ndarray]:
        """The paper's table as terms of the whole load: its m_x u r and m_y v r on the right."""
        own = dict(self.HULL) | {
            "X_udot": -self.M_X, "Y_vdot": -self.M_Y, "N_rdot": -self.J_Z, "Y_ur": -self.M_X,
            "X_vr": self.HULL["X_vr"] + self.M_Y,
        } | other  # fmt: skip
        return {name: np.array([value]) for name, value in own.items()}

    def ship(self, values: dict[str, np.ndarray] | None = None) -> Ship:
        own = self.terms() if values is None else values
        hull = HullLoads(self.L, self.L * self.D, self.RHO, own)
        inertia = self.I_ZG + self.MASS * self.X_G**2
        return Ship(hull, self.PROPELLER, self.RUDDER, self.MASS, inertia, self.X_G, self.U0)

    @cached_property
    def N(self) -> float:  # noqa: N802
        """Revolutions at which (1 - t_P) T is the resistance, by bisection."""
        resistance = -self.HULL["X_0"] * 0.5 * self.RHO * self.L * self.D * self.U0**2
        low, high = 1.0, 100.0
        for _ in range(200):
            n = 0.5 * (low + high)
            j = self.U0 * (1.0 - self.W_P0) / (n * self.D_P)
            k_t = self.K[0] + self.K[1] * j + self.K[2] * j * j
            thrust = (1.0 - self.T_P) * self.RHO * n**2 * self.D_P**4 * k_t
            low, high = (n, high) if thrust < resistance else (low, n)
        return n

    def steering(self, u: float, v: float, r: float, delta: float, rate: float) -> Behind:
        speed = math.sqrt(u * u + v * v)
        beta, rp = math.atan2(-v, u), r * self.L / speed
        beta_p = beta - self.X_P * rp
        c2 = self.C2[0] if beta_p > 0.0 else self.C2[1]
        grown = 1.0 + (1.0 - math.exp(-self.C1 * abs(beta_p))) * (c2 - 1.0)
        u_p = u * (1.0 - self.W_P0) * grown
        j = u_p / (rate * self.D_P)
        k_t = self.K[0] + self.K[1] * j + self.K[2] * j * j
        thrust = self.RHO * rate**2 * self.D_P**4 * k_t
        eta = self.D_P / self.H_R
        race = 1.0 + self.KAPPA * (math.sqrt(1.0 + 8.0 * k_t / (math.pi * j * j)) - 1.0)
        u_r = self.EPSILON * u_p * math.sqrt(eta * race**2 + 1.0 - eta)
        beta_r = beta - self.L_R * rp
        v_r = speed * (self.GAMMA[0] if beta_r > 0.0 else self.GAMMA[1]) * beta_r
        f_n = 0.5 * self.RHO * self.A_R * (u_r**2 + v_r**2) * self.F_ALPHA
        f_n *= math.sin(delta - math.atan2(v_r, u_r))
        across = -f_n * math.cos(delta)
        return Behind(
            (1.0 - self.T_P) * thrust - (1.0 - self.T_R) * f_n * math.sin(delta),
            (1.0 + self.A_H) * across,
            (-0.5 + self.A_H * self.X_H) * self.L * across,
            thrust,
            f_n,
        )

    def hull(self, u: float, v: float, r: float) -> tuple[float, float, float]:
        speed = math.sqrt(u * u + v * v)
        vp, rp = v / speed, r * self.L / speed
        c = self.HULL
        q = 0.5 * self.RHO * self.L * self.D * speed * speed
        x = q * (c["X_0"] + c["X_vv"] * vp**2 + c["X_vr"] * vp * rp + c["X_rr"] * rp**2
                 + c["X_vvvv"] * vp**4)  # fmt: skip
        y = q * (c["Y_v"] * vp + c["Y_r"] * rp + c["Y_vvv"] * vp**3 + c["Y_vvr"] * vp**2 * rp
                 + c["Y_vrr"] * vp * rp**2 + c["Y_rrr"] * rp**3)  # fmt: skip
        n = q * self.L * (c["N_v"] * vp + c["N_r"] * rp + c["N_vvv"] * vp**3
                          + c["N_vvr"] * vp**2 * rp + c["N_vrr"] * vp * rp**2
                          + c["N_rrr"] * rp**3)  # fmt: skip
        return x, y, n

    def rates(self, state: np.ndarray, delta: float) -> np.ndarray:
        u, v, r, _, _, psi = state
        x, y, n = self.hull(u, v, r)
        behind = self.steering(u, v, r, delta, self.N)
        x, y, n = x + behind.x, y + behind.y, n + behind.n
        unit = 0.5 * self.RHO * self.L * self.L * self.D
        m_x, m_y, j_z = self.M_X * unit, self.M_Y * unit, self.J_Z * unit * self.L**2
        mass, x_g = self.MASS, self.X_G
        left = np.array([
            [mass + m_x, 0.0, 0.0],
            [0.0, mass + m_y, x_g * mass],
            [0.0, x_g * mass, self.I_ZG + x_g**2 * mass + j_z],
        ])  # fmt: skip
        right = [
            x + (mass + m_y) * v * r + x_g * mass * r * r,
            y - (mass + m_x) * u * r,
            n - x_g * mass * u * r,
        ]
        way = [u * math.cos(psi) - v * math.sin(psi), u * math.sin(psi) + v * math.cos(psi), r]
        return np.array([*np.linalg.solve(left, right), *way])


kvlcc2 = Published(
    L=7.0, D=20.8 * 7.0 / 320.0, VOLUME=312622.0 * (7.0 / 320.0) ** 3, U0=1.179,
    X_G=11.2 * 7.0 / 320.0, M_X=0.022, M_Y=0.223, J_Z=0.011,
    HULL={name: one for name, one in DERIVATIVES.items() if not name.endswith("dot")},
    D_P=0.216, K=(0.2931, -0.2753, -0.1385), T_P=0.220, W_P0=0.40, X_P=-0.48, C1=2.0, C2=(1.6, 1.1),
    A_R=0.0539, H_R=0.345, F_ALPHA=2.747, T_R=0.387, A_H=0.312, X_H=-0.464, EPSILON=1.09,
    KAPPA=0.50, GAMMA=(0.640, 0.395), L_R=-0.710, RATE=15.8,
)  # fmt: skip

_SCALE = 31.6
_L = 230.0 / _SCALE
_UNIT = 0.5 * 230.0**2 * 10.8  # of added masses, m3
_M_X, _M_Y = 1790.85 / _UNIT, 44324.18 / _UNIT
kcs = Published(
    L=_L, D=10.8 / _SCALE, VOLUME=0.651 * 230.0 * 32.2 * 10.8 / _SCALE**3,
    U0=0.26 * math.sqrt(9.80665 * _L), X_G=-3.404 / _SCALE,
    M_X=_M_X, M_Y=_M_Y, J_Z=140067300.0 / (_UNIT * 230.0**2),
    HULL={
        "X_0": -0.0167, "X_vv": -0.0549, "X_vr": 0.1084 - _M_Y, "X_rr": -0.0120,
        "X_vvvv": -0.0417,
        "Y_v": -0.2252, "Y_r": 0.0398 + _M_X, "Y_vvv": -1.7179, "Y_vvr": -0.4832,
        "Y_vrr": -0.8341, "Y_rrr": -0.0050,
        "N_v": -0.1111, "N_r": -0.0465, "N_vvv": -0.1752, "N_vvr": -0.6168, "N_vrr": -0.0512,
        "N_rrr": -0.0387,
    },
    D_P=7.9 / _SCALE, K=(0.5228, -0.4390, -0.0609), T_P=0.207, W_P0=0.355, X_P=-0.5, C1=0.0,
    C2=(1.0, 1.0), A_R=_L * 10.8 / _SCALE / 54.86, H_R=7.9 / _SCALE / 0.7979,
    F_ALPHA=6.13 * 2.164 / (2.25 + 2.164), T_R=0.258, A_H=0.361, X_H=-0.436, EPSILON=0.956,
    KAPPA=0.633, GAMMA=(0.492, 0.338), L_R=-0.755, RATE=2.32 * math.sqrt(_SCALE),
)  # fmt: skip
