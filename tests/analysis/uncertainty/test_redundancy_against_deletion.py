"""Data that are too many, against fits made anew without each of them, and against chance."""

import math

import numpy as np
import pytest
from numpy.random import Generator
from scipy import stats

from analysis.uncertainty.estimate import Estimate, joint
from analysis.uncertainty.redundancy import CHANCE, Redundancy, best_fit, scattered_fit
from analysis.uncertainty.values import UncertainValues
from hardware.description.arrays import FloatArray

NAMES = [f"datum {k}" for k in range(7)]
TIME = np.linspace(-1.0, 2.0, 7)
LINE = np.column_stack([np.ones(7), TIME])


def measured(generator: Generator, common: float = 0.3) -> UncertainValues:
    """Return a line's values with errors of many sizes and one that is common to all."""
    sigma = np.linspace(0.5, 2.0, 7)
    shared = Estimate.of(0.0, common)
    truth = LINE @ [1.0, -2.0]
    own = [Estimate.of(v, s) for v, s in zip(truth, sigma, strict=True)]
    both = joint([*own, shared])
    seen = both.mapped(np.hstack([np.eye(7), TIME[:, None] ** 2]))
    return UncertainValues(seen.draw(1, generator)[:, 0], seen.contributions)


def solved(matrix: FloatArray, values: FloatArray, covariance: FloatArray) -> FloatArray:
    """Solve the normal equations as the textbook has them."""
    weight = np.linalg.inv(covariance)
    return np.asarray(np.linalg.solve(matrix.T @ weight @ matrix, matrix.T @ weight @ values))


def fitted(values: UncertainValues) -> tuple[UncertainValues, Redundancy]:
    return best_fit(LINE, values, subject="line", results=("a_m", "b_m"), data=NAMES)


def test_all_and_without_each_against_fits_made_anew() -> None:
    values = measured(np.random.default_rng(1))
    covariance = values.covariance()
    found, agreement = fitted(values)
    assert found.values == pytest.approx(solved(LINE, values.values, covariance), rel=1e-9)
    whole = values.values - LINE @ found.values
    chi_squared = whole @ np.linalg.solve(covariance, whole)
    assert agreement.chi_squared == pytest.approx(chi_squared, rel=1e-9)
    assert agreement.probability == pytest.approx(stats.chi2.sf(chi_squared, 5), rel=1e-9)
    for k in range(7):
        rest = np.arange(7) != k
        block = covariance[np.ix_(rest, rest)]
        without = solved(LINE[rest], values.values[rest], block)
        assert agreement.without[k] == pytest.approx(without, rel=1e-8)
        left = values.values[rest] - LINE[rest] @ without
        # what chi-squared falls by is the square of the departure
        fall = chi_squared - left @ np.linalg.solve(block, left)
        assert agreement.departure[k] ** 2 == pytest.approx(fall, rel=1e-7)


def test_departures_of_uncorrelated_data_against_the_prediction_of_the_others() -> None:
    values = measured(np.random.default_rng(2), common=0.0)
    _, agreement = fitted(values)
    sigma = values.standard_uncertainty
    for k in range(7):
        rest = np.arange(7) != k
        covariance = np.diag(sigma[rest] ** 2)
        line = solved(LINE[rest], values.values[rest], covariance)
        normal = LINE[rest].T @ np.diag(sigma[rest] ** -2.0) @ LINE[rest]
        spread = math.sqrt(sigma[k] ** 2 + LINE[k] @ np.linalg.inv(normal) @ LINE[k])
        departure = (values.values[k] - LINE[k] @ line) / spread
        assert agreement.departure[k] == pytest.approx(departure, rel=1e-8)


def test_disagreement_widens_by_birge_and_agreement_by_nothing() -> None:
    values = measured(np.random.default_rng(3))
    found, agreement = fitted(values)
    assert agreement.agree
    assert agreement.flags() == ()
    weight = np.linalg.inv(values.covariance())
    clean = np.linalg.inv(LINE.T @ weight @ LINE)
    assert found.covariance() == pytest.approx(clean, rel=1e-8)
    off = UncertainValues(values.values + 40.0 * np.eye(7)[4], values.contributions)
    wider, contradicted = fitted(off)
    birge = contradicted.chi_squared / 5.0
    assert contradicted.stands_out == ("datum 4",)
    assert contradicted.widening == pytest.approx(math.sqrt(birge))
    assert wider.covariance() == pytest.approx(birge * clean, rel=1e-8)
    assert wider.degrees_of_freedom == pytest.approx(5.0 / (1.0 - 1.0 / birge) ** 2, rel=1e-6)
    (flag,) = contradicted.flags()
    assert flag.code == "data_disagree"
    assert "datum 4" in flag.message
    assert contradicted.without[4] == pytest.approx(agreement.without[4], rel=1e-9)


def test_one_datum_too_many_tells_that_and_not_which() -> None:
    three = joint([Estimate.of(v, 0.1) for v in (1.0, 1.05, 2.0)])
    _, agreement = best_fit(LINE[:3], three, subject="line", results=("a", "b"), data=NAMES[:3])
    assert not agreement.agree
    assert agreement.furthest == ()
    assert "cannot be told" in agreement.flags()[0].message


def test_two_that_only_check_each_other_are_both_named() -> None:
    """Without either, the other is no longer contradicted."""
    matrix = np.array([[1.0, 0.0]] * 4 + [[0.0, 1.0]] * 2)
    seen = joint([Estimate.of(v, 0.1) for v in (1.0, 1.1, 0.95, 1.05, 3.0, 5.0)])
    _, agreement = best_fit(matrix, seen, subject="pair", results=("a", "b"), data=NAMES[:6])
    assert set(agreement.stands_out) == {"datum 4", "datum 5"}


def test_a_datum_that_nothing_checks_departs_from_nothing() -> None:
    matrix = np.array([[1.0, 0.0]] * 3 + [[0.0, 1.0]])
    seen = joint([Estimate.of(v, 0.1) for v in (1.0, 1.1, 0.95, 77.0)])
    _, agreement = best_fit(matrix, seen, subject="lonely", results=("a", "b"), data=NAMES[:4])
    assert agreement.departure[3] == 0.0
    assert np.isnan(agreement.without[3]).all()
    assert agreement.agree


@pytest.mark.slow
def test_uncertainties_from_few_repeats_are_no_certainty() -> None:
    """Each datum's uncertainty is itself drawn from five repeats."""
    generator, named = np.random.default_rng(4), 0
    for _ in range(400):
        spread = np.sqrt(generator.chisquare(4.0, 5) / 4.0)
        values = generator.standard_normal(5)
        seen = joint([Estimate.of(v, s, "1", 4.0) for v, s in zip(values, spread, strict=True)])
        _, agreement = best_fit(
            np.ones((5, 1)), seen, subject="mean", results=("m",), data=NAMES[:5]
        )
        named += not agreement.agree
    assert named <= 400 * 2 * CHANCE


def test_own_scatter_against_the_students_t_of_fits_made_anew() -> None:
    generator = np.random.default_rng(5)
    values = LINE @ [1.0, -2.0] + 0.1 * generator.standard_normal(7)
    values[5] += 2.0
    agreement = scattered_fit(LINE, values, subject="line", results=("a", "b"), data=NAMES)
    for k in range(7):
        rest = np.arange(7) != k
        line, (square,), *_ = np.linalg.lstsq(LINE[rest], values[rest], rcond=None)
        inverse = np.linalg.inv(LINE[rest].T @ LINE[rest])
        spread = math.sqrt(square / 4.0 * (1.0 + LINE[k] @ inverse @ LINE[k]))
        t = (values[k] - LINE[k] @ line) / spread
        assert agreement.departure[k] == pytest.approx(t, rel=1e-8)
        assert agreement.chance[k] == pytest.approx(2.0 * stats.t.sf(abs(t), 4), rel=1e-8)
        assert agreement.without[k] == pytest.approx(line, rel=1e-9)
    assert agreement.stands_out == ("datum 5",)
    assert "do not scatter alike" in agreement.flags()[0].message


def test_what_a_datum_changes_is_written_in_digits_that_show_it() -> None:
    values = UncertainValues(np.array([1.73149, 1.73150, 1.73151, 1.73189]))
    for k in range(4):
        values = values.plus(f"own {k}", 1e-6 * np.eye(4)[k])
    _, agreement = best_fit(
        np.ones((4, 1)), values, subject="length", results=("length_m",), data=NAMES[:4]
    )
    (flag,) = agreement.flags()
    assert "without it length_m 1.731500 in place of 1.731597" in flag.message
