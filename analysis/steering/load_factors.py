"""What thrust and the rudder's normal force do to the ship: t_P, t_R, a_H and x_H.

For the runs of one motion of the hull (index c), with the hull's own loads X_c, Y_c, N_c unknown:

    X = X_c + (1 - t_P) T - (1 - t_R) F_N sin(delta)
    Y = Y_c - (1 + a_H) F_N cos(delta)
    N = N_c - (x_R + a_H x_H) F_N cos(delta)

(Yasukawa and Yoshimura 2015, equations 13, 19 and 20). Thrust and normal force are measured too,
so both sides have errors: the residuals are weighed with the whole covariance, and the normal
equations use thrust and force as the loads make them likely, which leaves no bias of regression.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.steering.observations import SteeringRuns
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

FACTORS: Final = ("1 - t_P", "1 - t_R", "1 + a_H", "x_R + a_H x_H")
_MOST_STEPS: Final = 50
_DONE: Final = 1e-12
_BLIND: Final = 1e-9


@dataclass(frozen=True, eq=False)
class LoadFactors:
    """The factors, and the hull's loads.

    Attributes
    ----------
    values
        :data:`FACTORS`, then X_c, Y_c and N_c of each condition: ``(4 + 3 conditions,)``.
    by_data
        How they follow the measured numbers, shape ``(4 + 3 conditions, 5, n)``.
    squares, spare
        Weighted squares of the residuals, and their degrees of freedom.
    """

    values: FloatArray
    by_data: FloatArray
    squares: float
    spare: int


def load_factors(runs: SteeringRuns) -> LoadFactors:
    """Return the factors of all runs.

    Raises
    ------
    DataError
        If the runs do not tell one of them; the message says what run would.
    """
    loads, behind = runs.values[:3].T, runs.values[3:].T
    spread, behind_spread = runs.uncertainty[:3].T ** 2, runs.uncertainty[3:].T ** 2
    values, count = np.zeros(4 + 3 * runs.conditions), len(runs.names)
    likely = behind.copy()
    for _ in range(_MOST_STEPS):
        design = _design(runs, likely)
        slopes = _slopes(runs, values)
        covariance = np.einsum("nij,nj,nkj->nik", slopes, behind_spread, slopes)
        covariance[:, range(3), range(3)] += spread
        weight = np.linalg.inv(covariance)
        residual = loads - _design(runs, behind) @ values
        normal = np.einsum("nip,nij,njq->pq", design, weight, design)
        _check(normal)
        step = np.linalg.solve(normal, np.einsum("nip,nij,nj->p", design, weight, residual))
        values = values + step
        residual = loads - _design(runs, behind) @ values
        likely = behind + behind_spread * np.einsum("nij,nik,nk->nj", slopes, weight, residual)
        if np.abs(step).max() <= _DONE * np.abs(values).max():
            break
    gain = np.einsum("pq,niq,nij->npj", np.linalg.inv(normal), design, weight)
    by_data = np.concatenate((gain, -gain @ slopes), axis=2)
    squares = float(np.einsum("ni,nij,nj->", residual, weight, residual))
    return LoadFactors(values, by_data.transpose(1, 2, 0), squares, 3 * count - len(values))


def _design(runs: SteeringRuns, behind: FloatArray) -> FloatArray:
    """Return how loads follow the unknowns, ``(n, 3, unknowns)``, at thrust and normal force."""
    count = len(runs.names)
    thrust, normal = behind.T
    across = -normal * np.cos(runs.rudder_rad)
    design = np.zeros((count, 3, 4 + 3 * runs.conditions))
    design[:, 0, 0] = thrust
    design[:, 0, 1] = -normal * np.sin(runs.rudder_rad)
    design[:, 1, 2] = design[:, 2, 3] = across
    for row in range(3):
        design[range(count), row, 4 + row * runs.conditions + runs.condition] = 1.0
    return design


def _slopes(runs: SteeringRuns, values: FloatArray) -> FloatArray:
    """Return how loads follow thrust and normal force, ``(n, 3, 2)``."""
    slopes = np.zeros((len(runs.names), 3, 2))
    slopes[:, 0, 0] = values[0]
    slopes[:, 0, 1] = -values[1] * np.sin(runs.rudder_rad)
    slopes[:, 1, 1] = -values[2] * np.cos(runs.rudder_rad)
    slopes[:, 2, 1] = -values[3] * np.cos(runs.rudder_rad)
    return slopes


_TELLING: Final = (
    "load variation: the same tow at two or more rates of revolutions",
    "the same tow with the rudder laid at angles of different size",
    "the same tow with the rudder at different angles",
    "the same tow with the rudder at different angles",
)


def _check(normal: FloatArray) -> None:
    """Refuse factors that the runs do not tell apart from the hull's own loads."""
    factors, hull = normal[:4, :4], normal[4:, 4:]
    cross = normal[:4, 4:]
    shares = np.diagonal(factors - cross @ np.linalg.solve(hull, cross.T)) / np.diagonal(
        factors
    ).clip(1e-300)
    silent = [
        f"{name} (make {how})"
        for name, how, share in zip(FACTORS, _TELLING, shares, strict=True)
        if share < _BLIND
    ]
    if silent:
        raise DataError(f"the runs do not tell {'; '.join(silent)}")
