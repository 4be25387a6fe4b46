"""The water in which propeller and rudder work: w_P, epsilon, kappa, gamma_R, l_R and neutral.

Thrust and normal force of all runs at once, by the MMG standard method (Yasukawa and Yoshimura
2015, equations 14, 18 and 21 to 25), with a wake for each motion of the hull:

    T = rho n^2 D^4 K_T(J),  J = u (1 - w_P) / (n D)
    F_N = rho/2 A_R f_alpha (u_R^2 + v_R^2) sin(delta - delta_0 - atan(v_R / u_R))
    u_R = epsilon sqrt(eta (u_P + kappa (sqrt(u_P^2 + 8 T / (pi rho D^2)) - u_P))^2 + (1-eta) u_P^2)
    v_R = gamma_R (U beta - l_R r)

with gamma_R by the sign of ``beta_R = beta - l_R r / U``. f_alpha is taken as given: epsilon holds
what it is off by.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.steering.observations import Particulars, SteeringRuns
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

INFLOW: Final = ("epsilon", "kappa", "gamma_R+", "gamma_R-", "l_R", "delta_0")
_STARTS: Final = (1.0, 0.5, 0.4, 0.4, -0.8, 0.0)  # l_R over L
_BLIND: Final = 1e10  # condition number of the scaled normal equations
_RATES_APART: Final = 0.02  # of the rates, so that they are two
_ANGLES: Final = 2  # on straight course: they tell lift and neutral
_DRIFTS: Final = 1e-3  # rad


@dataclass(frozen=True, eq=False)
class Inflow:
    """What was found.

    Attributes
    ----------
    names
        Of the wakes (``w_P`` of each condition, by its number) and of :data:`INFLOW` as far as the
        runs tell them; l_R in metres, delta_0 in rad.
    by_data
        How they follow the measured numbers, shape ``(names, 5, n)``.
    missing
        What the runs do not tell, with what run would.
    squares, spare
        Weighted squares of the residuals, and their degrees of freedom.
    """

    names: tuple[str, ...]
    values: FloatArray
    by_data: FloatArray
    missing: dict[str, str]
    squares: float
    spare: int


def wake_name(condition: int) -> str:
    """Return what the wake of a condition is called among the results."""
    return f"w_P {condition}"


def inflow(runs: SteeringRuns, particulars: Particulars) -> Inflow:
    """Return wakes and inflow of the rudder of all runs.

    Raises
    ------
    DataError
        If no wake has the thrust that was measured, or parameters cannot be told apart.
    """
    from scipy.optimize import least_squares

    _check_neutral(runs)
    missing = _missing(runs)
    wakes = thrust_identity(runs, particulars)
    # Of one loading the race is a part of epsilon, which then is none to be told.
    free = [k for k, name in enumerate(INFLOW) if name == "epsilon" or name not in missing]
    fixed = np.array(_STARTS)
    fixed[4] *= particulars.length_m
    if "kappa" in missing:
        fixed[1] = 0.0
    scale = np.array(
        [1.0] * runs.conditions + [particulars.length_m if k == 4 else 1.0 for k in free]
    )

    def model(unknown: FloatArray) -> FloatArray:
        values = fixed.copy()
        values[free] = unknown[runs.conditions :]
        return propeller_and_rudder(
            runs, particulars, unknown[: runs.conditions][runs.condition], values
        )

    def residual(scaled: FloatArray) -> FloatArray:
        error = (runs.values[3:] - model(scaled * scale)) / runs.uncertainty[3:]
        return np.asarray(error.ravel())

    start = np.concatenate((wakes, fixed[free])) / scale
    outcome = least_squares(residual, start, method="lm", xtol=1e-12, ftol=1e-12)
    if not outcome.success:
        raise DataError(f"thrust and normal force could not be fitted: {outcome.message}")
    jacobian: FloatArray = -np.asarray(outcome.jac)
    normal = jacobian.T @ jacobian
    size = np.sqrt(np.diagonal(normal)).clip(1e-300)
    if np.linalg.cond(normal / np.outer(size, size)) > _BLIND:
        unresolved = ", ".join(INFLOW[k] for k in free)
        raise DataError(
            f"the runs do not tell {unresolved} apart: make oblique tows to both sides with the "
            "rudder at different angles besides the yaw with rudder"
        )
    gain = scale[:, None] * np.linalg.solve(normal, jacobian.T)
    by_data = np.zeros((len(start), 5, len(runs.names)))
    by_data[:, 3:] = gain.reshape(len(start), 2, -1) / runs.uncertainty[3:]
    names = (*map(wake_name, range(runs.conditions)), *(INFLOW[k] for k in free))
    determined = [k for k, name in enumerate(names) if name not in missing]
    return Inflow(
        tuple(names[k] for k in determined),
        (outcome.x * scale)[determined],
        by_data[determined],
        missing,
        float((outcome.fun**2).sum()),
        outcome.fun.size - len(start),
    )


def propeller_and_rudder(
    runs: SteeringRuns, particulars: Particulars, wake: FloatArray, values: FloatArray
) -> FloatArray:
    """Return thrust and normal force, shape ``(2, n)``.

    Parameters
    ----------
    wake
        Of each run, shape ``(n,)``.
    values
        :data:`INFLOW`.
    """
    epsilon, kappa, plus, minus, lever, neutral = values
    u, v, r = runs.motion
    density, diameter = particulars.density_kg_m3, particulars.diameter_m
    inflow_p = u * (1.0 - wake)
    k0, k1, k2 = particulars.thrust
    pace = runs.rate_hz * diameter
    thrust = density * diameter**2 * (k0 * pace**2 + k1 * pace * inflow_p + k2 * inflow_p**2)
    race = inflow_p**2 + 8.0 * thrust / (math.pi * density * diameter**2)
    jet = inflow_p + kappa * (np.sqrt(np.maximum(race, 0.0)) - inflow_p)
    covered = diameter / particulars.height_m
    along = epsilon * np.sqrt(covered * jet**2 + (1.0 - covered) * inflow_p**2)
    across = runs.speed_m_s * np.arctan2(-v, u) - lever * r
    across = across * np.where(across > 0.0, plus, minus)
    attack = runs.rudder_rad - neutral - np.arctan2(across, along)
    pressure = 0.5 * density * particulars.area_m2 * particulars.slope * (along**2 + across**2)
    return np.stack((thrust, pressure * np.sin(attack)))


def thrust_identity(runs: SteeringRuns, particulars: Particulars) -> FloatArray:
    """Return the wake of each condition at which the open-water propeller has the mean thrust.

    Raises
    ------
    DataError
        If there is none; the message names the run.
    """
    k0, k1, k2 = particulars.thrust
    unit = particulars.density_kg_m3 * runs.rate_hz**2 * particulars.diameter_m**4
    under = k1**2 - 4.0 * k2 * (k0 - runs.values[3] / unit)
    bad = np.flatnonzero((under < 0.0) | (runs.values[3] / unit > k0))
    if bad.size:
        run = int(bad[0])
        raise DataError(
            f"{runs.names[run]}: K_T = {float(runs.values[3, run] / unit[run]):.4g}, which the "
            f"open-water propeller does not have at any J (it begins at {k0:g}); look at "
            "revolutions, thrust and the propeller's diameter"
        )
    advance = -2.0 * (k0 - runs.values[3] / unit) / (k1 - np.sqrt(under))
    wakes = 1.0 - advance * runs.rate_hz * particulars.diameter_m / runs.motion[0]
    return np.array([wakes[runs.condition == k].mean() for k in range(runs.conditions)])


def _check_neutral(runs: SteeringRuns) -> None:
    straight = np.isin(runs.condition, runs.straight_runs)
    angles = np.unique(np.round(runs.rudder_rad[straight], 4))
    if len(angles) < _ANGLES:
        raise DataError(
            f"the rudder's neutral is not known: on straight course it was laid at {len(angles)} "
            f"angles, where {_ANGLES} are needed; make static rudder tests to both sides and "
            "amidships"
        )


def _missing(runs: SteeringRuns) -> dict[str, str]:
    """Return what no run tells, and what run would."""
    rates = np.ptp(runs.rate_hz / runs.speed_m_s) / np.max(runs.rate_hz / runs.speed_m_s)
    u, v, r = runs.motion
    drift = np.arctan2(-v, u)
    remedies: dict[str, str] = {}
    if rates < _RATES_APART:
        remedy = "static rudder at two or more rates of revolutions"
        remedies |= {"epsilon": remedy, "kappa": remedy}
    for name, side in (("gamma_R+", 1.0), ("gamma_R-", -1.0)):
        if not np.any((side * drift > _DRIFTS) | (side * r > 0.0)):
            remedies[name] = (
                f"oblique tow with rudder, bow to {'port' if side < 0 else 'starboard'}"
            )
    if not r.any():
        remedies["l_R"] = "yaw with rudder"
    return remedies
