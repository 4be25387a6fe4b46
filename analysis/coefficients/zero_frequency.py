"""Coefficients extrapolated to zero frequency, with the uncertainty of the extrapolation.

Added mass and damping of a fluid with decaying memory are even functions of the frequency, so
polynomials in its square are fitted: constant, linear, quadratic. Their values at zero are averaged
by the weights that Akaike's criterion gives them, and what they differ by is part of the
uncertainty. Three frequencies that reject a straight line, as with a memory that is strong there,
leave nothing to check the quadratic one by: then all that the polynomials differ by is.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.uncertainty.values import UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_DEGREES = (0, 1, 2)
_REJECTED = 25.0  # squares left, over their variance: five standard deviations


@dataclass(frozen=True, eq=False)
class Extrapolation:
    """A value at zero frequency.

    Attributes
    ----------
    uncertain
        One value: what the inputs add, and what the choice of polynomial leaves open
        (``extrapolation of NAME``).
    weights
        Of the polynomials, by their degree.
    checked
        Whether the data are described by a polynomial that they could have contradicted.
    """

    uncertain: UncertainValues
    weights: tuple[float, ...]
    checked: bool = True


def extrapolate(name: str, frequency_hz: Sequence[float], values: UncertainValues) -> Extrapolation:
    """Return the value at zero frequency.

    Parameters
    ----------
    frequency_hz
        Of each value, shape ``(n,)``.
    values
        The values, with what they have in common.

    Raises
    ------
    DataError
        If there are fewer than two frequencies.
    """
    square = np.asarray(frequency_hz, dtype=np.float64) ** 2
    if len(np.unique(square)) < 2:
        raise DataError(
            f"{name} at zero frequency needs runs at two frequencies or more, and there is "
            f"{', '.join(f'{f:g} Hz' for f in frequency_hz)}; add runs at a lower one"
        )
    variance = own_variance(values)
    pace = square / square.max()
    degrees = [k for k in _DEGREES if k < len(np.unique(square))]
    fits = [_at_zero(pace, variance, degree) for degree in degrees]
    squares = np.array([_chi_square(pace, variance, values.values, d) for d in degrees])
    spare = len(pace) - degrees[-1] - 1
    dispersion = max(1.0, squares[-1] / spare) if spare > 0 else 1.0
    criterion = squares / dispersion + 2.0 * (np.array(degrees) + 1.0)
    weights = np.exp((criterion.min() - criterion) / 2.0)
    weights /= weights.sum()
    singles = np.array([row @ values.values for row in fits])
    value = values.mapped((weights @ np.array(fits))[None, :])
    between = float(weights @ (singles - value.values[0]) ** 2)
    checked = not (spare == 0 and len(fits) == len(_DEGREES) and squares[-2] > _REJECTED)
    if not checked:
        between += float(np.max((singles - singles[-1]) ** 2))  # nothing checks the highest one
    lack = (dispersion - 1.0) * float((weights @ np.array(fits)) ** 2 @ variance)
    label = f"extrapolation of {name}"
    total = value.plus(label, np.array([np.sqrt(between + lack)]))
    return Extrapolation(total, tuple(float(weight) for weight in weights), checked)


def own_variance(values: UncertainValues) -> FloatArray:
    """Return the scatter that the values do not share; stated uncertainty moves them together."""
    by_input = values.variances()
    scattered = np.array(
        [np.isfinite(contribution.degrees_of_freedom) for contribution in values.contributions],
        dtype=bool,
    )
    variance = (
        np.asarray(by_input[scattered].sum(axis=0)) if scattered.any() else np.zeros(len(values))
    )
    size = np.abs(values.values).max() + 1e-300
    return np.asarray(np.maximum(np.nan_to_num(variance), (1e-9 * size) ** 2))


def _design(pace: FloatArray, degree: int) -> FloatArray:
    return np.asarray(pace[:, None] ** np.arange(degree + 1))


def _at_zero(pace: FloatArray, variance: FloatArray, degree: int) -> FloatArray:
    """Return the row that gives the value at zero from the values."""
    root = 1.0 / np.sqrt(variance)
    inverse = np.linalg.pinv(_design(pace, degree) * root[:, None])
    return np.asarray(inverse[0] * root)


def _chi_square(pace: FloatArray, variance: FloatArray, values: FloatArray, degree: int) -> float:
    root = 1.0 / np.sqrt(variance)
    design = _design(pace, degree) * root[:, None]
    residual = values * root - design @ np.linalg.lstsq(design, values * root, rcond=None)[0]
    return float(residual @ residual)
