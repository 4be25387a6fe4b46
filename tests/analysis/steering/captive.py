"""Captive tests of a published ship by the MMG paper's equations, errors drawn for every gauge.

Nothing of the product makes these numbers: ``tests/analysis/manoeuvring/published.py`` writes the
paper out on plain numbers.
"""

import math

import numpy as np

from analysis.steering.observations import Particulars, SteeringRuns
from tests.analysis.manoeuvring.published import Published
from tests.analysis.manoeuvring.published import kvlcc2 as paper


def known(ship: Published) -> Particulars:
    """What a laboratory knows of the ship before the tests."""
    return Particulars(
        ship.L, ship.RHO, ship.D_P, ship.K, ship.A_R, ship.H_R, ship.F_ALPHA, -0.5 * ship.L
    )


def truth(ship: Published) -> dict[str, float]:
    """What the tests should tell."""
    return {
        "1-t_P": 1.0 - ship.T_P, "w_P0": ship.W_P0, "t_R": ship.T_R, "a_H": ship.A_H,
        "x_H'": ship.X_H, "epsilon": ship.EPSILON, "kappa": ship.KAPPA,
        "gamma_R+": ship.GAMMA[0], "gamma_R-": ship.GAMMA[1], "l_R'": ship.L_R, "delta_0": 0.0,
    }  # fmt: skip


KNOWN, TRUTH = known(paper), truth(paper)
UNCERTAINTY = np.array([0.15, 0.15, 0.3, 0.05, 0.08])  # N, N, N m, N, N
ZERO_N = 0.05  # of the zero runs that all runs share, of thrust and of normal force
RATES = (0.593, 0.805, 1.017)  # of those of self-propulsion; 7, 9.5 and 12 1/s of KVLCC2
RUDDERS = (-20.0, -10.0, 0.0, 10.0, 20.0)
STRAIGHT = [(0.0, 0.0, rate, rudder) for rate in RATES for rudder in RUDDERS]
OBLIQUE = [(beta, 0.0, RATES[1], rudder) for beta in (-12.0, -6.0, 6.0, 12.0) for rudder in RUDDERS]
TURNING = [(0.0, r, RATES[1], rudder) for r in (-0.4, -0.2, 0.2, 0.4) for rudder in RUDDERS]
CAMPAIGN = (*STRAIGHT, *OBLIQUE, *TURNING)
"""Drift (deg), r L / U, revolutions over those of self-propulsion, rudder angle (deg)."""


def runs(
    rng: np.random.Generator | None,
    points: tuple[tuple[float, float, float, float], ...] = CAMPAIGN,
    spread: np.ndarray = UNCERTAINTY,
    ship: Published = paper,
) -> SteeringRuns:
    """One campaign; without a generator the numbers are exact."""
    motion, values = [], []
    for beta_deg, turn, rate, rudder_deg in points:
        beta, rudder = math.radians(beta_deg), math.radians(rudder_deg)
        u, v = ship.U0 * math.cos(beta), -ship.U0 * math.sin(beta)
        r = turn * ship.U0 / ship.L
        told = ship.steering(u, v, r, rudder, rate * ship.N)
        x, y, n = ship.hull(u, v, r)
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
        names, np.array(motion).T, np.radians(rudders), rates * ship.N, exact + drawn, u_of, shared
    )
