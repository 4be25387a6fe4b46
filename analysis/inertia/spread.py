"""One body on several suspensions: whether the gyradii agree, and why they may not.

Each possible cause is one number that all geometries share. It is fitted with the gyradius to the
periods' gyradii; the cause that leaves least over is the likeliest. With few geometries that proves
little: a cause is named only if, fitted to all but one of them, it predicts the one left out.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import Redundancy, best_fit
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

DISAGREE = 0.01
SURE = 0.8  # share of what it has not seen that a cause has to predict to be named


_LONGER = "the lines are longer than measured (knots, clamps, stretch)"
_WIDER = "the lines' spacing is wider than measured"
# What has no opposite cannot be less than nothing.
_OPPOSITES = {
    _LONGER: "the lines are shorter than measured",
    _WIDER: "the lines' spacing is narrower than measured",
}


def cause_statement(cause: str, predicts: float, *, certain: bool) -> str:
    """Return the sentence about the likeliest cause.

    Parameters
    ----------
    predicts
        Share of the gap on what was left out of the fit that goes away with it.
    certain
        Whether it is the cause.
    """
    share = f"{100.0 * max(predicts, 0.0):.0f} % of what it was not fitted to"
    if certain:
        return f"the cause: {cause}, which predicts {share}"
    return f"the cause cannot be told; likeliest cause: {cause}, which accounts for {share}"


@dataclass(frozen=True)
class SuspensionGyradius:
    """One suspension: the gyradius that came out, half spacing and line length in m."""

    name: str
    gyradius: Estimate
    half_spacing_m: float
    line_m: float


@dataclass(frozen=True)
class SpreadCause:
    """A possible cause of the spread, or two of them together.

    Attributes
    ----------
    names, sizes, units
        What, how much, in which unit.
    gyradius_m
        The body's, if that is the cause.
    chi_squared, degrees_of_freedom
        Of the residuals with this cause.
    predicts
        Share of the departure of a geometry, from what the others let expect, that goes away when
        the cause is fitted to those others; root mean square over the geometries in turn.
    """

    names: tuple[str, ...]
    sizes: tuple[float, ...]
    units: tuple[str, ...]
    gyradius_m: float
    chi_squared: float
    degrees_of_freedom: int
    predicts: float = 0.0

    def __str__(self) -> str:
        parts = zip(self.names, self.sizes, self.units, strict=True)
        return " and ".join(
            f"{name if size > 0.0 else _OPPOSITES[name]}, {abs(size):.3g} {unit}"
            for name, size, unit in parts
        )


@dataclass(frozen=True)
class Spread:
    """Comparison of one body's gyradii from several suspensions.

    Attributes
    ----------
    gyradius
        Weighted mean; where they disagree its uncertainty is that of the unexplained spread.
    redundancy
        How they agree, with geometries less 1 degrees of freedom.
    causes
        Likeliest first; empty where they agree.
    """

    gyradius: Estimate
    redundancy: Redundancy
    causes: tuple[SpreadCause, ...]
    flags: tuple[Flag, ...]


def compare_geometries(
    geometries: Sequence[SuspensionGyradius], *, result: str = "k_yaw_m"
) -> Spread:
    """Compare the gyradii of one body on several suspensions.

    Parameters
    ----------
    result
        Name of the gyradius.

    Raises
    ------
    DataError
        For fewer than two geometries.
    """
    if len(geometries) < 2:
        raise DataError(f"{len(geometries)} geometry; at least 2 are needed to compare")
    values = np.array([geometry.gyradius.value for geometry in geometries])
    gyradii = joint(geometry.gyradius for geometry in geometries)
    mean, agreement = best_fit(
        np.ones((values.size, 1)),
        gyradii,
        subject=f"{result} by several suspensions",
        results=(result,),
        data=[geometry.name for geometry in geometries],
    )
    if agreement.agree:
        return Spread(Estimate(mean, "m"), agreement, (), ())
    mean_u = Estimate(mean, "m").uncertainty / agreement.widening
    scatter = max(float(values.std(ddof=1)), mean_u)
    causes = _causes(geometries) if values.size > 2 else ()
    estimate = Estimate.of(float(values.mean()), scatter, "m", float(values.size - 1))
    wider = replace(
        agreement, widening=scatter / mean_u, cause="the spread between the suspensions"
    )
    return Spread(estimate, wider, causes, (_flag(values, agreement, causes, scatter),))


def _shapes(d: FloatArray, line: FloatArray, k: float) -> dict[str, tuple[str, FloatArray]]:
    """Relative change of the gyradius squared per unit of each cause."""
    return {
        _LONGER: ("m", 1.0 / line),
        _WIDER: ("m", -1.0 / d),
        "clamps move with the lines (their mass over the body's)": ("1", (d / k) ** 2 - 1.0),
        "the lines twist stiffly (stiffness over m g)": ("m", -line / d**2),
    }


def _causes(geometries: Sequence[SuspensionGyradius]) -> tuple[SpreadCause, ...]:
    """Fit each cause, and each pair where enough geometries are there, with the gyradius."""
    d = np.array([geometry.half_spacing_m for geometry in geometries])
    line = np.array([geometry.line_m for geometry in geometries])
    values = np.array([geometry.gyradius.value for geometry in geometries])
    weight = values / np.array([geometry.gyradius.uncertainty for geometry in geometries])
    k = float(values.mean())
    shapes = _shapes(d, line, k)
    causes = []
    for size in (1, 2):
        freedom = d.size - 1 - size
        for names in combinations(shapes, size) if freedom > 0 else ():
            matrix = np.column_stack([np.ones(d.size), *(0.5 * shapes[n][1] for n in names)])
            target = np.log(values / k) * weight
            solved, *_ = np.linalg.lstsq(matrix * weight[:, None], target, rcond=None)
            residual = target - (matrix * weight[:, None]) @ solved
            units = tuple(shapes[n][0] for n in names)
            sizes = tuple(solved[1:].tolist())
            if any(
                size < 0.0 and n not in _OPPOSITES for n, size in zip(names, sizes, strict=True)
            ):
                continue
            gyradius = k * math.exp(float(solved[0]))
            share = _predicts(matrix, target, weight)
            causes.append(
                SpreadCause(
                    names, sizes, units, gyradius, float(residual @ residual), freedom, share
                )
            )
    # a second cause has to pay for itself (Akaike)
    return tuple(sorted(causes, key=lambda cause: cause.chi_squared + 2.0 * len(cause.names)))


def _predicts(matrix: FloatArray, target: FloatArray, weight: FloatArray) -> float:
    """Return by how much less the left-out geometries depart with a cause than without."""
    with_it = _left_out(matrix * weight[:, None], target)
    without = _left_out(matrix[:, :1] * weight[:, None], target)
    return 1.0 - float(np.linalg.norm(with_it) / np.linalg.norm(without))


def _left_out(matrix: FloatArray, target: FloatArray) -> FloatArray:
    """Return each row's departure from what the others let expect, in sigma."""
    ways = []
    for at in range(target.size):
        rest = np.arange(target.size) != at
        solved, *_ = np.linalg.lstsq(matrix[rest], target[rest], rcond=None)
        ways.append(target[at] - matrix[at] @ solved)
    return np.array(ways)


def _flag(
    values: FloatArray, agreement: Redundancy, causes: tuple[SpreadCause, ...], scatter: float
) -> Flag:
    cause_words = ""
    if causes:
        best = causes[0]
        cause_words = (
            f"; {cause_statement(str(best), best.predicts, certain=best.predicts >= SURE)} "
            f"(chi-squared {best.chi_squared:.3g} over {best.degrees_of_freedom}, "
            f"gyradius then {best.gyradius_m:.4f} m)"
        )
    message = (
        f"the gyradii range from {values.min():.4f} to {values.max():.4f} m, beyond their "
        f"uncertainties (chi-squared {agreement.chi_squared:.4g} over "
        f"{agreement.degrees_of_freedom}): an unexplained spread of {scatter:.2g} m, which is "
        f"taken for the uncertainty{cause_words}"
    )
    return Flag("unexplained_spread", Severity.WARNING, message)
