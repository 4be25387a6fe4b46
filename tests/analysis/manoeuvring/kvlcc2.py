"""KVLCC2 in the MMG standard method, L7 model: Yasukawa and Yoshimura 2015, tables 1 to 3.

``rates`` writes the paper's equations out once more, for one ship, on plain numbers: the mass with
its added mass on the left, hull, propeller and rudder on the right.
"""

import math
from typing import Final, NamedTuple

import numpy as np

from analysis.manoeuvring.hull import HullLoads
from analysis.manoeuvring.ship import Ship
from analysis.manoeuvring.steering import Propeller, Rudder
from tests.analysis.coefficients.kvlcc2 import DERIVATIVES

L, D, RHO, U0 = 7.0, 20.8 * 7.0 / 320.0, 1000.0, 1.179
VOLUME: Final = 312622.0 * (L / 320.0) ** 3
MASS, X_G = RHO * VOLUME, 11.2 * L / 320.0
I_ZG = MASS * (0.25 * L) ** 2
M_X, M_Y, J_Z = 0.022, 0.223, 0.011
D_P, H_R, A_R = 0.216, 0.345, 0.0539
K = (0.2931, -0.2753, -0.1385)
T_P, W_P0, X_P, C1, C2 = 0.220, 0.40, -0.48, 2.0, (1.6, 1.1)
T_R, A_H, X_H, EPSILON, KAPPA, L_R = 0.387, 0.312, -0.464, 1.09, 0.50, -0.710
GAMMA, F_ALPHA, RATE = (0.640, 0.395), 2.747, 15.8
HULL = {name: one for name, one in DERIVATIVES.items() if not name.endswith("dot")}

PROPELLER = Propeller(D_P, K, T_P, W_P0, X_P, C1, *C2)
RUDDER = Rudder(A_R, H_R, F_ALPHA, RATE, T_R, A_H, X_H, EPSILON, KAPPA, *GAMMA, L_R)


def terms(**other: float) -> dict[str, np.ndarray]:
    """The paper's table as terms of the whole load: its m_x u r and m_y v r are on the right."""
    own = dict(HULL) | {
        "X_udot": -M_X, "Y_vdot": -M_Y, "N_rdot": -J_Z, "Y_ur": -M_X,
        "X_vr": HULL["X_vr"] + M_Y,
    } | other  # fmt: skip
    return {name: np.array([value]) for name, value in own.items()}


def ship(values: dict[str, np.ndarray] | None = None) -> Ship:
    hull = HullLoads(L, L * D, RHO, terms() if values is None else values)
    return Ship(hull, PROPELLER, RUDDER, MASS, I_ZG + MASS * X_G**2, X_G, U0)


def rate_hz() -> float:
    """Revolutions at which (1 - t_P) T is the resistance, by bisection."""
    resistance = -HULL["X_0"] * 0.5 * RHO * L * D * U0**2
    low, high = 1.0, 100.0
    for _ in range(200):
        n = 0.5 * (low + high)
        j = U0 * (1.0 - W_P0) / (n * D_P)
        thrust = (1.0 - T_P) * RHO * n**2 * D_P**4 * (K[0] + K[1] * j + K[2] * j * j)
        low, high = (n, high) if thrust < resistance else (low, n)
    return n


N = rate_hz()


class Behind(NamedTuple):
    """Loads of propeller and rudder, and what gauges behind the ship read."""

    x: float
    y: float
    n: float
    thrust: float
    normal: float


def steering(u: float, v: float, r: float, delta: float, rate: float) -> Behind:
    U = math.sqrt(u * u + v * v)
    beta, rp = math.atan2(-v, u), r * L / U
    beta_p = beta - X_P * rp
    c2 = C2[0] if beta_p > 0.0 else C2[1]
    u_p = u * (1.0 - W_P0) * (1.0 + (1.0 - math.exp(-C1 * abs(beta_p))) * (c2 - 1.0))
    j = u_p / (rate * D_P)
    k_t = K[0] + K[1] * j + K[2] * j * j
    thrust = RHO * rate**2 * D_P**4 * k_t
    eta = D_P / H_R
    race = 1.0 + KAPPA * (math.sqrt(1.0 + 8.0 * k_t / (math.pi * j * j)) - 1.0)
    u_r = EPSILON * u_p * math.sqrt(eta * race**2 + 1.0 - eta)
    beta_r = beta - L_R * rp
    v_r = U * (GAMMA[0] if beta_r > 0.0 else GAMMA[1]) * beta_r
    f_n = 0.5 * RHO * A_R * (u_r**2 + v_r**2) * F_ALPHA * math.sin(delta - math.atan2(v_r, u_r))
    across = -f_n * math.cos(delta)
    return Behind(
        (1.0 - T_P) * thrust - (1.0 - T_R) * f_n * math.sin(delta),
        (1.0 + A_H) * across,
        (-0.5 + A_H * X_H) * L * across,
        thrust,
        f_n,
    )


def hull(u: float, v: float, r: float) -> tuple[float, float, float]:
    U = math.sqrt(u * u + v * v)
    vp, rp = v / U, r * L / U
    c = HULL
    q = 0.5 * RHO * L * D * U * U
    x = q * (c["X_0"] + c["X_vv"] * vp**2 + c["X_vr"] * vp * rp + c["X_rr"] * rp**2
             + c["X_vvvv"] * vp**4)  # fmt: skip
    y = q * (c["Y_v"] * vp + c["Y_r"] * rp + c["Y_vvv"] * vp**3 + c["Y_vvr"] * vp**2 * rp
             + c["Y_vrr"] * vp * rp**2 + c["Y_rrr"] * rp**3)  # fmt: skip
    n = q * L * (c["N_v"] * vp + c["N_r"] * rp + c["N_vvv"] * vp**3 + c["N_vvr"] * vp**2 * rp
                 + c["N_vrr"] * vp * rp**2 + c["N_rrr"] * rp**3)  # fmt: skip
    return x, y, n


def rates(state: np.ndarray, delta: float) -> np.ndarray:
    u, v, r, _, _, psi = state
    x, y, n = hull(u, v, r)
    behind = steering(u, v, r, delta, N)
    x, y, n = x + behind.x, y + behind.y, n + behind.n
    unit = 0.5 * RHO * L * L * D
    m_x, m_y, j_z = M_X * unit, M_Y * unit, J_Z * unit * L * L
    left = np.array([
        [MASS + m_x, 0.0, 0.0],
        [0.0, MASS + m_y, X_G * MASS],
        [0.0, X_G * MASS, I_ZG + X_G**2 * MASS + j_z],
    ])  # fmt: skip
    right = [
        x + (MASS + m_y) * v * r + X_G * MASS * r * r,
        y - (MASS + m_x) * u * r,
        n - X_G * MASS * u * r,
    ]
    way = [u * math.cos(psi) - v * math.sin(psi), u * math.sin(psi) + v * math.cos(psi), r]
    return np.array([*np.linalg.solve(left, right), *way])
