"""One body, several suspensions: do the gyradii agree, and if not, what would make them?

Each possible cause is one number that all geometries share. It is fitted with the gyradius to the
periods' gyradii; the cause that leaves least over is the likeliest.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from analysis.inertia.estimate import Estimate
from analysis.inertia.numeric import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

DISAGREE = 0.01


@dataclass(frozen=True)
class Geometry:
    """One suspension of the body: its gyradius as it came out, half spacing and line length in m."""

    name: str
    gyradius: Estimate
    half_spacing_m: float
    line_m: float


@dataclass(frozen=True)
class Cause:
    """A possible cause of the spread.

    Attributes
    ----------
    size
        In ``unit``.
    gyradius_m
        The body's, if that is the cause.
    chi_squared
        What it leaves over; the degrees of freedom are geometries less 2.
    """

    name: str
    size: float
    unit: str
    gyradius_m: float
    chi_squared: float


@dataclass(frozen=True)
class Spread:
    """What several suspensions say of one body.

    Attributes
    ----------
    gyradius
        Weighted mean; where they disagree its uncertainty is that of the unexplained spread.
    chi_squared, probability
        Of the agreement, with geometries less 1 degrees of freedom.
    causes
        Likeliest first; empty where they agree.
    """

    gyradius: Estimate
    chi_squared: float
    probability: float
    agree: bool
    causes: tuple[Cause, ...]
    flags: tuple[Flag, ...]


def compare_geometries(geometries: Sequence[Geometry]) -> Spread:
    """Compare the gyradii of one body on several suspensions.

    Raises
    ------
    DataError
        For fewer than two geometries.
    """
    from scipy.stats import chi2

    if len(geometries) < 2:
        raise DataError(f"{len(geometries)} geometry; at least 2 are needed to compare")
    values = np.array([one.gyradius.value for one in geometries])
    weights = np.array([1.0 / one.gyradius.uncertainty**2 for one in geometries])
    mean = float(np.average(values, weights=weights))
    misfit = float(weights @ (values - mean) ** 2)
    probability = float(chi2.sf(misfit, values.size - 1))
    inner = 1.0 / math.sqrt(float(weights.sum()))
    if probability >= DISAGREE:
        return Spread(Estimate(mean, inner, "m"), misfit, probability, True, (), ())
    scatter = float(values.std(ddof=1))
    causes = _causes(geometries) if values.size > 2 else ()
    estimate = Estimate(float(values.mean()), max(scatter, inner), "m", float(values.size - 1))
    return Spread(
        estimate, misfit, probability, False, causes, (_flag(values, misfit, causes, scatter),)
    )


def _shapes() -> dict[str, tuple[str, Callable[[FloatArray, FloatArray, float], FloatArray]]]:
    """Relative change of the gyradius squared per unit of each cause."""
    return {
        "the lines swing about points further apart than measured (length, each pair)": (
            "m",
            lambda d, line, k: np.asarray(1.0 / line),
        ),
        "the spacing is another than measured (full spacing 2d)": (
            "m",
            lambda d, line, k: np.asarray(-1.0 / d),
        ),
        "clamps move with the lines (their mass over the body's)": (
            "1",
            lambda d, line, k: np.asarray((d / k) ** 2 - 1.0),
        ),
        "the lines twist stiffly (stiffness over m g)": (
            "m",
            lambda d, line, k: np.asarray(-line / d**2),
        ),
    }


def _causes(geometries: Sequence[Geometry]) -> tuple[Cause, ...]:
    """Fit each cause, to first order in its size, with the gyradius."""
    d = np.array([one.half_spacing_m for one in geometries])
    line = np.array([one.line_m for one in geometries])
    values = np.array([one.gyradius.value for one in geometries])
    weight = values / np.array([one.gyradius.uncertainty for one in geometries])
    k = float(values.mean())
    relative = np.log(values / k)
    found = []
    for name, (unit, shape) in _shapes().items():
        matrix = np.column_stack([np.ones(d.size), 0.5 * shape(d, line, k)])
        solved, *_ = np.linalg.lstsq(matrix * weight[:, None], relative * weight, rcond=None)
        left = weight * (relative - matrix @ solved)
        found.append(
            Cause(name, float(solved[1]), unit, k * math.exp(float(solved[0])), float(left @ left))
        )
    return tuple(sorted(found, key=lambda cause: cause.chi_squared))


def _flag(values: FloatArray, misfit: float, causes: tuple[Cause, ...], scatter: float) -> Flag:
    why = ""
    if causes:
        best = causes[0]
        freedom = values.size - 2
        rest = "which explains it" if best.chi_squared < 3.0 * freedom else "which leaves a rest"
        why = (
            f"; the likeliest single cause: {best.name}, {best.size:.3g} {best.unit}, {rest} "
            f"(chi-squared {best.chi_squared:.3g} over {freedom})"
        )
    message = (
        f"the gyradii range from {values.min():.4f} to {values.max():.4f} m, beyond their "
        f"uncertainties (chi-squared {misfit:.4g} over {values.size - 1}): an unexplained spread "
        f"of {scatter:.2g} m, which is taken for the uncertainty{why}"
    )
    return Flag("unexplained_spread", Severity.WARNING, message)
