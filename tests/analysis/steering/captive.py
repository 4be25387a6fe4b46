"""Captive tests of KVLCC2 by the MMG paper's own equations, with errors drawn for every gauge.

Nothing of the product makes these numbers: ``tests/analysis/manoeuvring/kvlcc2.py`` writes the
paper out for one ship on plain numbers.
"""

import math

import numpy as np

from analysis.steering.observations import Particulars, SteeringRuns
from tests.analysis.manoeuvring import kvlcc2 as paper

KNOWN = Particulars(
    paper.L, paper.RHO, paper.D_P, paper.K, paper.A_R, paper.H_R, paper.F_ALPHA, -0.5 * paper.L
)
TRUTH = {
    "1-t_P": 1.0 - paper.T_P, "w_P0": paper.W_P0, "t_R": paper.T_R, "a_H": paper.A_H,
    "x_H'": paper.X_H, "epsilon": paper.EPSILON, "kappa": paper.KAPPA, "gamma_R+": paper.GAMMA[0],
    "gamma_R-": paper.GAMMA[1], "l_R'": paper.L_R, "delta_0": 0.0,
}  # fmt: skip
UNCERTAINTY = np.array([0.15, 0.15, 0.3, 0.05, 0.08])  # N, N, N m, N, N
ZERO_N = 0.05  # of the zero runs that all runs share, of thrust and of normal force
RATES = (7.0, 9.5, 12.0)
RUDDERS = (-20.0, -10.0, 0.0, 10.0, 20.0)
STRAIGHT = [(0.0, 0.0, rate, rudder) for rate in RATES for rudder in RUDDERS]
OBLIQUE = [(beta, 0.0, 9.5, rudder) for beta in (-12.0, -6.0, 6.0, 12.0) for rudder in RUDDERS]
TURNING = [(0.0, r, 9.5, rudder) for r in (-0.4, -0.2, 0.2, 0.4) for rudder in RUDDERS]
CAMPAIGN = (*STRAIGHT, *OBLIQUE, *TURNING)
"""Drift (deg), r L / U, revolutions (1/s), rudder angle (deg)."""


def runs(
    rng: np.random.Generator | None,
    points: tuple[tuple[float, float, float, float], ...] = CAMPAIGN,
    spread: np.ndarray = UNCERTAINTY,
) -> SteeringRuns:
    """One campaign; without a generator the numbers are exact."""
    motion, values = [], []
    for beta_deg, turn, rate, rudder_deg in points:
        beta, rudder = math.radians(beta_deg), math.radians(rudder_deg)
        u, v = paper.U0 * math.cos(beta), -paper.U0 * math.sin(beta)
        r = turn * paper.U0 / paper.L
        told = paper.steering(u, v, r, rudder, rate)
        x, y, n = paper.hull(u, v, r)
        motion.append((u, v, r))
        values.append((x + told.x, y + told.y, n + told.n, told.thrust, told.normal))
    exact = np.array(values).T
    u_of = np.repeat(spread[:, None], len(points), axis=1)
    shared = np.zeros((5, len(points), 2))
    shared[3, :, 0] = shared[4, :, 1] = ZERO_N
    drawn = np.zeros_like(exact)
    if rng is not None:
        drawn = rng.standard_normal(exact.shape) * u_of + shared @ rng.standard_normal(2)
    _, _, rates, rudders = np.array(points).T
    names = tuple(f"run-{k}" for k in range(len(points)))
    return SteeringRuns(
        names, np.array(motion).T, np.radians(rudders), rates, exact + drawn, u_of, shared
    )
