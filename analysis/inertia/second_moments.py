"""Whether a body can have some moments of inertia: none is above the sum of the other two.

``sum m n^2`` along any direction is not below zero. It is the least eigenvalue of the matrix with
``(Iyy + Izz - Ixx)/2 = sum m x^2`` ... on its diagonal and the products ``sum m x y`` beside it.
"""

import math
from typing import Final

import numpy as np

from analysis.inertia.parts import BodyPart
from hardware.description.flags import Flag, Severity

CODE: Final = "inertia_impossible"
_SURE: Final = 2.0  # standard uncertainties by which the sum is below zero
_ROUNDING: Final = 1e-6  # of all moments: what has no uncertainty is rounded
_STRAIGHT: Final = 0.99  # along an axis, where products of inertia do not matter
_AXES: Final = ("ixx", "iyy", "izz")


def impossible_moments(body: BodyPart) -> tuple[Flag, ...]:
    """Flag moments and products of inertia that no body has, by more than their uncertainty.

    Moments that are zero were not given, and nothing is said of them.
    """
    moments, products = body.parameters[4:7], body.parameters[7:10]
    if not (moments > 0.0).all():
        return ()
    second = np.diag(0.5 * moments.sum() - moments)
    for value, (row, column) in zip(products, ((0, 1), (0, 2), (1, 2)), strict=True):
        second[row, column] = second[column, row] = value
    values, vectors = np.linalg.eigh(second)
    least, direction = float(values[0]), vectors[:, 0]
    slope = np.zeros(len(body.parameters))
    slope[4:7], slope[7:10] = 0.5 - direction**2, 2.0 * direction[[0, 0, 1]] * direction[[1, 2, 2]]
    u = math.sqrt(max(float(slope @ body.uncertain.covariance() @ slope), 0.0))
    if least >= -max(_SURE * u, _ROUNDING * moments.sum()):
        return ()
    large = int(np.argmax(np.abs(direction)))
    first_axis, second_axis = (axis for k, axis in enumerate(_AXES) if k != large)
    excess, first = (
        f"{_AXES[large]} above {first_axis} + {second_axis}",
        _first_to_measure(body, large, -2.0 * least),
    )
    if abs(direction[large]) < _STRAIGHT:
        excess, first = "products of inertia so large for its moments", "measure the products first"
    below = f", {-least / u:.2g} standard uncertainties below zero" if u > 0.0 else ""
    message = (
        f"{body.name}: no body has {excess}: sum m n2 would be {least:.3g} kg m2 along "
        f"({', '.join(f'{part:.2g}' for part in direction)}){below}; {first}, then the others"
    )
    return (Flag(CODE, Severity.WARNING, message),)


def _first_to_measure(body: BodyPart, large: int, lacks: float) -> str:
    """Say which moment mends it with the fewest of its uncertainties, or the smallest share."""
    moments = body.parameters[4:7]
    sigmas = np.array([moment.uncertainty for moment in body.inertia])
    share = lacks / moments
    changes = np.round(lacks / sigmas, 1) if (sigmas > 0.0).all() else share
    wrong = int(np.lexsort((share, changes))[0])
    change = -lacks if wrong == large else lacks
    return (
        f"measure {_AXES[wrong]} again first, which {change:+.3g} kg m2 "
        f"({100.0 * change / moments[wrong]:+.2g} %) would mend"
    )
