"""What an effect does to the coefficients that a user reports."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from pmm.gap.examine import Examined
from sim.rig import SimulatedRig

FloatArray = NDArray[np.float64]

_TERMS: Final = {"a": "added_mass", "b": "damping", "c": "restoring"}
_BODY: Final = ("mass_kg", "inertia_kg_m2", "cg_x_m", "cg_z_m")
UNITS: Final = {
    "a11": "kg", "a12": "kg m", "a21": "kg m", "a22": "kg m²",
    "b11": "N s/m", "b12": "N s", "b21": "N s", "b22": "N m s",
    "c11": "N/m", "c12": "N", "c21": "N", "c22": "N m",
    "mass_kg": "kg", "inertia_kg_m2": "kg m²", "cg_x_m": "m", "cg_z_m": "m",
}  # fmt: skip


@dataclass(frozen=True)
class CoefficientRow:
    """One coefficient of model and water, in SI.

    Attributes
    ----------
    stated
        What the campaign says.
    without, with_effect
        Fitted to the campaign without and with the cause; the same where the answer names none.
    u_without, u_with
        Their standard uncertainties.
    """

    name: str
    unit: str
    stated: float
    without: float
    u_without: float
    with_effect: float
    u_with: float


def coefficient_rows(examined: Examined) -> Iterator[CoefficientRow]:
    """Yield every free coefficient of model and water."""
    found = examined.diagnosis
    problem, cause = found.problem, found.cause
    plain = _fitted(problem.residual, problem.nuisances.columns)
    cured = plain
    if cause is not None:
        both = np.hstack((problem.nuisances.columns, cause.columns))
        cured = _fitted(cause.linearised(problem.residual), both)
    for at, one in enumerate(examined.free):
        if not one.is_coefficient:
            continue
        here = _stated(problem.simulator.rig, one.name)
        moved = examined.recentred.moved.get(one.name, 0.0)
        values = [
            number * one.deviation
            for mean, spread in (plain, cured)
            for number in (float(mean[at]), float(spread[at]))
        ]
        unit = UNITS.get(one.name, "")
        yield CoefficientRow(
            one.name, unit, here - moved, here + values[0], values[1], here + values[2], values[3]
        )


def _fitted(residual: FloatArray, columns: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return most probable value and standard deviation, in units of the prior."""
    covariance = np.linalg.inv(np.eye(columns.shape[1]) + columns.T @ columns)
    return covariance @ (columns.T @ residual), np.sqrt(np.diagonal(covariance))


def _stated(rig: SimulatedRig, name: str) -> float:
    if name in _BODY:
        return float(getattr(rig.body, name))
    matrix = getattr(rig.water, _TERMS[name[0]])
    return float(matrix[int(name[1]) - 1][int(name[2]) - 1])
