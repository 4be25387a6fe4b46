"""A force law of few terms, found in what is not explained: a description, not a cause.

Orthogonal least squares: S. Chen, S. A. Billings, W. Luo, "Orthogonal least squares methods and
their application to non-linear system identification", Int. J. Control 50 (1989).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import rooted
from analysis.gap.observe.components import Part
from analysis.gap.search.polynomial import Moved, components_of, scaled_motion
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES

FORM: Final = (Part.MEAN, Part.IN_PHASE, Part.QUADRATURE)
# Terms in displacement, velocity and acceleration, each over its largest value in the campaign.
LIBRARY: Final[Mapping[str, Callable[[Moved], FloatArray]]] = {
    "1": lambda m: np.ones_like(m[0]),
    "x": lambda m: m[0],
    "v": lambda m: m[1],
    "a": lambda m: m[2],
    "x²": lambda m: m[0] ** 2,
    "x|x|": lambda m: m[0] * np.abs(m[0]),
    "x³": lambda m: m[0] ** 3,
    "sign v": lambda m: np.tanh(m[1] / _SHARP),
    "v²": lambda m: m[1] ** 2,
    "v|v|": lambda m: m[1] * np.abs(m[1]),
    "v³": lambda m: m[1] ** 3,
    "x v": lambda m: m[0] * m[1],
    "x² v": lambda m: m[0] ** 2 * m[1],
    "a|a|": lambda m: m[2] * np.abs(m[2]),
}
MOST_TERMS: Final = 6
_WORTH: Final = 0.02  # of the remainder's square: a term that carries less is not named
_SHARP: Final = 0.02  # of the largest velocity, over which a sign turns


@dataclass(frozen=True)
class Law:
    """A sparse law of the struts' forces.

    Attributes
    ----------
    terms
        Channel, term of the library and its force in newtons at the largest motion of the campaign,
        in the order in which they were found.
    explained
        Share of the remainder's square, in units of its uncertainty and the free coefficients.
    """

    terms: tuple[tuple[str, str, float], ...]
    explained: float


def sparse_law(problem: Problem, residual: FloatArray) -> Law:
    """Return the few terms that carry a whitened difference, beside the free coefficients."""
    stack = problem.simulator.stack
    moved = {channel: scaled_motion(stack, channel) for channel in FORCES}
    names = [(channel, name) for channel in FORCES for name in LIBRARY]
    columns = np.column_stack(
        [
            components_of(
                stack, channel, [LIBRARY[name](run_motion) for run_motion in moved[channel]]
            )
            for channel, name in names
        ]
    )
    columns = rooted(problem.nuisances, columns / stack.uncertainty[:, None])
    target = rooted(problem.nuisances, residual[:, None])[:, 0]
    chosen, explained = _forward(columns, target)
    weights = np.linalg.lstsq(columns[:, chosen], target, rcond=None)[0]
    terms = [(*names[at], float(weight)) for at, weight in zip(chosen, weights, strict=True)]
    return Law(tuple(terms), explained)


def _forward(columns: FloatArray, target: FloatArray) -> tuple[list[int], float]:
    """Choose columns one by one, each by the share of the target that it adds."""
    remainder, basis, chosen = target.copy(), columns.copy(), list[int]()
    total = float(target @ target)
    for _ in range(MOST_TERMS):
        norms = np.sqrt(np.sum(basis**2, axis=0))
        usable = norms > 1e-6 * np.sqrt(np.sum(columns**2, axis=0)).max()
        unit = np.where(usable, basis / np.where(usable, norms, 1.0), 0.0)
        shares = (remainder @ unit) ** 2 / total
        best = int(np.argmax(shares))
        if shares[best] < _WORTH:
            break
        chosen.append(best)
        remainder = remainder - unit[:, best] * (unit[:, best] @ remainder)
        basis = basis - np.outer(unit[:, best], unit[:, best] @ basis)
    return chosen, 1.0 - float(remainder @ remainder) / total
