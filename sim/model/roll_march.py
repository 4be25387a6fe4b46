"""How a model that is free rolls: its equation, and the march through samples."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.heel import righting_moment

_SMALL = 1e-6  # rad and rad/s: the step of the slopes at rest


@dataclass(frozen=True, eq=False)
class RollCourse:
    """Moments on a model in roll over the instants of its other motion, those of shape ``(n,)``.

    Attributes
    ----------
    inertia
        About the roll axis with the added one, kg m^2.
    tilting, turning
        By the cosine of the heel, and by its sine times the cosine, N m.
    righting, at_rest
        Moments m g GM and m g BM, and the righting moment that ballast holds at rest.
    water
        What stands by each product of heel and rate of roll; factors with bars are sizes.
    """

    inertia: float
    tilting: FloatArray
    turning: FloatArray
    righting: tuple[float, float]
    at_rest: float
    water: Mapping[tuple[str, ...], FloatArray]

    def moment(self, phi: Any, p: Any) -> Any:
        """Return what turns the model, N m, at a heel and a rate of roll."""
        cosine, sine = np.cos(phi), np.sin(phi)
        total = self.tilting * cosine + self.turning * sine * cosine + self.at_rest
        total = total - righting_moment(*self.righting, phi)
        for factors, part in self.water.items():
            total = total + part * rolled(factors, phi, p)
        return total

    def slopes(self) -> tuple[float, float]:
        """Return stiffness and damping of small rolls about upright, the mean of the instants."""
        sides = (1.0, -1.0)
        by_heel = [side * self.moment(side * _SMALL, 0.0) for side in sides]
        by_rate = [side * self.moment(0.0, side * _SMALL) for side in sides]
        stiff, damping = (-np.mean(sum(moments)) / (2.0 * _SMALL) for moments in (by_heel, by_rate))
        return float(stiff), float(damping)


def rolled(factors: tuple[str, ...], phi: Any, p: Any) -> Any:
    """Return the product of a term's factors, of heel ``phi`` (rad) and its rate ``p`` (rad/s)."""
    product: Any = 1.0
    for factor in factors:
        value = phi if "phi" in factor else p
        product = product * (abs(value) if "|" in factor else value)
    return product


def march_roll(
    course: RollCourse, first_rad: float, before: tuple[float, ...], step_s: float
) -> tuple[FloatArray, tuple[float, ...]]:
    """Return phi, p and pdot at each sample, shape ``(3, n)``, and the state after the last.

    Runge and Kutta's fourth order, what drives the model linear between samples.

    Parameters
    ----------
    first_rad
        Heel at the first sample, at rest.
    before
        phi, p and the driving moments at the last sample; empty before the first.
    """
    keys = tuple(sorted(course.water))
    count = len(course.tilting)
    driven = np.stack(
        (course.tilting, course.turning, *(np.broadcast_to(course.water[k], count) for k in keys)),
        axis=1,
    ).tolist()
    of_gm, of_bm = course.righting

    def bent(phi: float, p: float, row: list[float]) -> float:
        cosine, sine = math.cos(phi), math.sin(phi)
        total = row[0] * cosine + row[1] * sine * cosine + course.at_rest
        total -= (of_gm + 0.5 * of_bm * (sine / cosine) ** 2) * sine
        for key, part in zip(keys, row[2:], strict=True):
            total += part * rolled(key, phi, p)
        return total / course.inertia

    phi, p = before[:2] if before else (first_rad, 0.0)
    last = list(before[2:]) if before else None
    rows = []
    for row in driven:
        if last is not None:
            middle = [0.5 * (begin + end) for begin, end in zip(last, row, strict=True)]
            phi, p = _step(bent, phi, p, (last, middle, row), step_s)
        rows.append((phi, p, bent(phi, p, row)))
        last = row
    return np.array(rows).T, (phi, p, *(last or ()))


def _step(bent: Any, phi: float, p: float, rows: Any, step: float) -> tuple[float, float]:
    first, middle, end = rows
    half = 0.5 * step
    a1 = bent(phi, p, first)
    p2 = p + half * a1
    a2 = bent(phi + half * p, p2, middle)
    p3 = p + half * a2
    a3 = bent(phi + half * p2, p3, middle)
    p4 = p + step * a3
    a4 = bent(phi + step * p3, p4, end)
    return (
        phi + step / 6.0 * (p + 2.0 * p2 + 2.0 * p3 + p4),
        p + step / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4),
    )
