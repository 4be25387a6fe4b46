"""Data that are more than the unknowns: whether they agree, which departs, and what follows then.

Data ``y`` with covariance V follow ``y = A x + e`` with fewer unknowns x. With B an orthonormal
basis of what no unknown can change (``B' A = 0``) and ``P = B (B' V B)^-1 B'``,

    chi-squared = y' P y,      gap_i = (P y)_i / P_ii,      w_i = gap_i sqrt(P_ii)

gap_i is by how much datum i departs from what all others let expect, and w_i the same over its own
standard uncertainty (Baarda, A Testing Procedure for Use in Geodetic Networks, 1968; for
uncorrelated data the deleted residual of Cook and Weisberg, Residuals and Influence in Regression,
1982): a datum that draws the fit to itself has a small residual and no small w. Without it the
answer is ``x - K_i gap_i``, K the best linear unbiased estimator.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.uncertainty.estimate import fresh_label
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity
from hardware.description.words import told_apart

CHANCE = 0.01
"""Probability at which data that agree are said not to, by chi-squared or by the one furthest."""
_ROUNDING = 1e-12  # of a datum that is stated to be exact
_SEEN = 1e-9  # share of a datum's variance, and of its leverage, that the others have to check
_ALIKE = 4.0  # chi-squared by which leaving out one datum has to be better than another


@dataclass(frozen=True, eq=False)
class Redundancy:
    """How data that are more than the unknowns agree.

    Attributes
    ----------
    what
        Is estimated, in words.
    results
        Names of the unknowns, shape ``(p,)``, each with its unit at the end.
    data
        Names of the data, shape ``(n,)``.
    values, without
        The unknowns from all data, shape ``(p,)``, and without each datum in turn, ``(n, p)``;
        NaN where they cannot be told without it.
    departure
        Of each datum from what the others let expect, over its standard uncertainty, ``(n,)``.
    chance
        Probability of a departure that large, ``(n,)``.
    chi_squared, degrees_of_freedom
        By the stated uncertainties; chi-squared is NaN where there are none.
    probability
        Of a chi-squared that large; NaN where the data's own scatter is their uncertainty.
    widening
        How many times as large the uncertainty of the result is as without the disagreement.
    cause
        What the intervals are widened by.
    """

    what: str
    results: tuple[str, ...]
    data: tuple[str, ...]
    values: FloatArray
    without: FloatArray
    departure: FloatArray
    chance: FloatArray
    chi_squared: float
    degrees_of_freedom: int
    probability: float
    widening: float = 1.0
    cause: str = ""

    def of(self, results: Sequence[str], turn: Callable[[FloatArray], FloatArray]) -> "Redundancy":
        """Return the same of what follows from the unknowns, which stand last in an array."""
        return replace(
            self, results=tuple(results), values=turn(self.values), without=turn(self.without)
        )

    @property
    def agree(self) -> bool:
        """Whether neither chi-squared nor the datum that is furthest off is beyond chance."""
        return not (self.probability < CHANCE or self._departs)

    @property
    def _departs(self) -> bool:
        return float(self.chance.min()) * len(self.data) < CHANCE

    @property
    def furthest(self) -> tuple[str, ...]:
        """The datum that departs most; with one datum too many all depart alike, and none does.

        Where it is beyond chance also those whose absence would leave the others no worse (each of
        two that contradict each other, where no third checks them).
        """
        if self.degrees_of_freedom < 2:
            return ()
        square = self.departure**2
        order = np.argsort(-square, kind="stable")
        if not self._departs:
            return (self.data[order[0]],)
        reach = _ALIKE * max(np.nan_to_num(self._remaining_square(square.max())), 1.0)
        suspects = [k for k in order if square.max() - square[k] < reach]
        return () if len(suspects) == len(self.data) else tuple(self.data[k] for k in suspects)

    def _remaining_square(self, square: float) -> float:
        """Return chi-squared per degree of freedom without a datum that departs by this square."""
        if math.isnan(self.probability):
            return math.nan
        return max(self.chi_squared - square, 0.0) / (self.degrees_of_freedom - 1)

    @property
    def stands_out(self) -> tuple[str, ...]:
        """The furthest data, where they are beyond chance."""
        return self.furthest if self._departs else ()

    def flags(self) -> tuple[Flag, ...]:
        """Return ``data_disagree`` where they do not agree."""
        if self.agree:
            return ()
        message = f"{self.what}: {self._how_far()}{self._which_text()}{self._widening_text()}"
        return (Flag("data_disagree", Severity.WARNING, message),)

    def _how_far(self) -> str:
        if math.isnan(self.probability):
            return f"{len(self.data)} data do not scatter alike"
        return (
            f"{len(self.data)} data do not agree (chi-squared {self.chi_squared:.4g} over "
            f"{self.degrees_of_freedom}, probability {self.probability:.2g})"
        )

    def _which_text(self) -> str:
        if self.degrees_of_freedom < 2:
            return "; which of them is wrong cannot be told: measure one more"
        if not self.stands_out:
            return "; none of them stands out alone"
        first = self.data.index(self.stands_out[0])
        alternatives = "".join(f" or {name}" for name in self.stands_out[1:])
        answer = ", ".join(
            f"{name} {told_apart(value, joint_value)}"
            for name, value, joint_value in zip(
                self.results, self.without[first], self.values, strict=True
            )
        )
        size = float(abs(self.departure[first]))
        rest = self._remaining_square(size**2)
        chi_words = "" if math.isnan(rest) else f", and chi-squared {rest:.3g} a degree of freedom"
        return (
            f"; {self.data[first]}{alternatives} stands {size:.3g} standard uncertainties from "
            f"what the others let expect: look at it; without it {answer}{chi_words}"
        )

    def _widening_text(self) -> str:
        if not self.widening > 1.0:
            return ""
        return f"; the uncertainty is {self.widening:.3g} times as large, by {self.cause}"


def best_fit(
    matrix: FloatArray,
    measured: UncertainValues,
    *,
    subject: str,
    results: Sequence[str],
    data: Sequence[str],
) -> tuple[UncertainValues, Redundancy]:
    """Fit unknowns to correlated data; where these do not agree, widen by their scatter.

    Widened by Birge's ratio, the root of chi-squared over its degrees of freedom (Phys. Rev. 40,
    1932): the scatter then counts beside the stated uncertainties, with degrees of freedom of its
    own. The result is the unknowns, and how the data agree; as many as the unknowns always do.

    Parameters
    ----------
    matrix
        A, shape ``(n, p)``, of full rank.
    measured
        The data.
    """
    size, unknowns = matrix.shape
    inverse = np.asarray(np.linalg.pinv(matrix), dtype=np.float64)
    exact = (_ROUNDING * np.maximum(np.abs(measured.values), np.abs(measured.values).max())) ** 2
    covariance = measured.covariance() + np.diag(exact + 1e-300)
    basis = np.linalg.svd(matrix)[0][:, unknowns:]
    weight_matrix = np.linalg.inv(basis.T @ covariance @ basis)
    unseen = basis @ weight_matrix @ basis.T
    estimator = inverse @ (np.eye(size) - covariance @ unseen)
    fitted = measured.mapped(estimator)
    checked = np.diag(unseen) * np.diag(covariance) > _SEEN
    weight = np.where(checked, np.diag(unseen), np.inf)
    residual = unseen @ measured.values
    departure = residual / np.sqrt(weight)
    without = fitted.values - np.where(checked, residual / weight, np.nan)[:, None] * estimator.T
    freedom = size - unknowns
    chi_squared = max(float(measured.values @ residual), 0.0)
    agreement = Redundancy(
        subject, tuple(results), tuple(data), fitted.values, without, departure,
        _two_sided(departure, measured.mapped(unseen).degrees_of_freedom),
        chi_squared, freedom, _probability_beyond(chi_squared, freedom, measured, unseen),
    )  # fmt: skip
    ratio = math.sqrt(chi_squared / max(freedom, 1))
    if agreement.agree or not ratio > 1.0:
        return fitted, agreement
    wider = _scattered(fitted, estimator @ covariance @ estimator.T, ratio, freedom)
    return wider, replace(agreement, widening=ratio, cause="the scatter of the data (Birge)")


def _scattered(
    fitted: UncertainValues, covariance: FloatArray, ratio: float, freedom: int
) -> UncertainValues:
    """Return the values with a covariance that is ``ratio`` squared times as large."""
    size, axes = np.linalg.eigh(covariance)
    parts = axes * np.sqrt(np.maximum(size, 0.0) * (ratio**2 - 1.0))
    scatter = Contribution(fresh_label(), float(freedom), np.arange(len(fitted)), parts)
    return replace(fitted, contributions=(*fitted.contributions, scatter))


def scattered_fit(
    matrix: FloatArray,
    values: FloatArray,
    *,
    subject: str,
    results: Sequence[str],
    data: Sequence[str],
) -> Redundancy:
    """Return how data agree whose uncertainty is their own scatter about an even fit.

    A departure is the externally studentised residual: the scale is the scatter of the others. With
    one datum too many none is left, and nothing departs.

    Parameters
    ----------
    matrix
        Shape ``(n, p)``, with n above p.
    values
        Shape ``(n,)``.
    """
    size, unknowns = matrix.shape
    freedom = size - unknowns
    inverse = np.linalg.pinv(matrix)
    spare = 1.0 - np.einsum("ij,ji->i", matrix, inverse)
    solved = inverse @ values
    residual = values - matrix @ solved
    checked = spare > _SEEN
    gap = residual / np.where(checked, spare, np.inf)
    variances = np.maximum(residual @ residual - residual * gap, 0.0) / max(freedom - 1, 1)
    floor = (_ROUNDING * np.abs(values).max()) ** 2 + 1e-300
    departure = gap * np.sqrt(spare.clip(0.0) / (variances + floor)) * (freedom > 1)
    without = solved - np.where(checked, gap, np.nan)[:, None] * inverse.T
    chance = _two_sided(departure, np.full(size, max(freedom - 1.0, 1.0)))
    names = (subject, tuple(results), tuple(data))
    return Redundancy(*names, solved, without, departure, chance, math.nan, freedom, math.nan)


def _probability_beyond(
    chi_squared: float, freedom: int, measured: UncertainValues, unseen: FloatArray
) -> float:
    """Return the probability of a larger chi-squared, by uncertainties of so many repeats.

    By Welch and James's approximation to it (Johansen, Biometrika 67, 1980): chi-squared over c is
    Fisher's with f and f (f + 2)/(3 A) degrees of freedom.
    """
    from scipy.stats import chi2, f

    if not freedom:
        return 1.0
    loss = 0.0
    for contribution in measured.contributions:
        part = contribution.dense(len(measured))
        part_gram = part.T @ unseen @ part
        loss += (
            0.5
            * (np.trace(part_gram @ part_gram) + np.trace(part_gram) ** 2)
            / contribution.degrees_of_freedom
        )
    if loss == 0.0:
        return float(chi2.sf(chi_squared, freedom))
    scale = freedom + 2.0 * loss - 6.0 * loss / (freedom + 2.0)
    return float(f.sf(chi_squared / scale, freedom, freedom * (freedom + 2.0) / (3.0 * loss)))


def _two_sided(departure: FloatArray, freedom: FloatArray) -> FloatArray:
    from scipy.special import ndtr, stdtr

    endless = np.isinf(freedom)
    size = -np.abs(departure)
    return np.asarray(
        2.0 * np.where(endless, ndtr(size), stdtr(np.where(endless, 1.0, freedom), size))
    )
