"""The region in the phasor plane that holds the true phasor with 95 % confidence."""

from dataclasses import dataclass

import numpy as np

from analysis.resolver.harmonics import Harmonics, IntervalSource
from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class Ellipse:
    """Half-axes in the phasor's unit, and the angle of the major one from in phase."""

    half_major: float
    half_minor: float
    angle_rad: float


def region_factor(
    degrees_of_freedom: float, level: float = 0.95, *, one_variance: bool = False
) -> float:
    """Return by how much the standard ellipse of a phasor is to be widened.

    The covariance is itself estimated from nu + 1 periods, so the squared distance of the estimate
    from the truth, in standard ellipses, follows Hotelling's T^2: ``2 nu / (nu - 1)`` times F with
    2 and ``d = nu - 1`` degrees of freedom (H. Hotelling, The generalization of Student's ratio,
    Annals of Mathematical Statistics 2, 1931; T. W. Anderson, An Introduction to Multivariate
    Statistical Analysis, section 5.2). Where both parts share one variance, estimated from lines
    beside the harmonic, it is 2 F with 2 and ``d = nu``. With two degrees of freedom above, F has
    the closed distribution ``P(F > x) = (1 + 2 x / d)^(-d / 2)``, and the square is in both cases
    ``nu ((1 - level)^(-2 / d) - 1)``. For large nu that is ``-2 ln(1 - level)``, chi-squared with 2
    degrees; it always exceeds Student's t of a single part, because both are covered at once.

    It is infinite where d is not above 0 (two periods, say): they span no region.

    Parameters
    ----------
    one_variance
        Whether the covariance is one variance times the unit matrix.
    """
    below = degrees_of_freedom - (0.0 if one_variance else 1.0)
    if not below > 0.0:
        return float("inf")
    with np.errstate(over="ignore"):
        grown = np.expm1(-2.0 * np.log1p(-level) / below)
    return float(np.sqrt(degrees_of_freedom * grown))


def confidence_ellipse(covariance: FloatArray, factor: float) -> Ellipse | None:
    """Return the confidence ellipse of a phasor.

    It is ``None`` where too few periods, or a covariance that is not known, span no region.

    Parameters
    ----------
    covariance
        Of ``(S_n, C_n)``, shape ``(2, 2)``.
    factor
        See :func:`region_factor`.
    """
    if not (np.isfinite(factor) and np.isfinite(covariance).all()):
        return None
    variances, axes = np.linalg.eigh(covariance)
    minor, major = factor * np.sqrt(np.maximum(variances, 0.0))
    return Ellipse(float(major), float(minor), float(np.arctan2(axes[1, 1], axes[0, 1])))


def ellipses(reading: Harmonics) -> list[list[Ellipse | None]]:
    """Return the ellipse of each channel (outer list) and harmonic (inner list) of a reading."""
    blocks = reading.phasor_covariance()
    freedom = reading.degrees_of_freedom[1:].reshape(reading.order, 2).min(axis=1)
    one_variance = reading.interval_source is IntervalSource.BINS
    factors = [region_factor(float(nu), one_variance=one_variance) for nu in freedom]
    return [
        [confidence_ellipse(block, factor) for block, factor in zip(row, factors, strict=True)]
        for row in blocks
    ]
