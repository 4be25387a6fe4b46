"""The evidence is the density of a multivariate normal, computed directly."""

from itertools import product
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import multivariate_normal

from analysis.gap.inference.constants import VISIBLE
from analysis.gap.inference.gaussian import (
    Nuisances,
    Posterior,
    any_size,
    left_over,
    null_evidence,
    posterior,
    rooted,
)
from analysis.gap.search.polynomial import log_evidence

COUNT = 9
SHARED = 0.5 * COUNT * np.log(2.0 * np.pi)
seeds = st.integers(0, 10_000)


def drawn(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    generator = np.random.default_rng(seed)
    return (
        5.0 * generator.standard_normal(COUNT),
        3.0 * generator.standard_normal((COUNT, 3)),
        2.0 * generator.standard_normal((COUNT, 2)),
    )


@given(seeds)
def test_of_the_nuisances_alone(seed: int) -> None:
    residual, wide, _ = drawn(seed)
    direct = multivariate_normal.logpdf(residual, cov=np.eye(COUNT) + wide @ wide.T)
    assert null_evidence(residual, Nuisances(wide)) == pytest.approx(direct + SHARED, abs=1e-7)


@given(seeds)
def test_of_an_effect_beside_them(seed: int) -> None:
    residual, wide, columns = drawn(seed)
    covariance = np.eye(COUNT) + wide @ wide.T + columns @ columns.T
    direct = multivariate_normal.logpdf(residual, cov=covariance)
    problem = SimpleNamespace(residual=residual, nuisances=Nuisances(wide))
    found = log_evidence(problem, columns, np.ones(COUNT, dtype=bool))
    assert found == pytest.approx(direct + SHARED, abs=1e-7)


@given(seeds, st.sampled_from([1.0, 2.9, 3.1, 40.0]))
def test_of_effects_of_any_size_is_that_of_a_mixture_of_widths(seed: int, reach: float) -> None:
    residual, wide, columns = drawn(seed)
    columns = columns * [100.0, 4.0]
    covariance = np.eye(COUNT) + wide @ wide.T
    shown = [np.sqrt(one @ np.linalg.solve(covariance, one)) for one in columns.T]
    down = [
        [3.0**-k for k in range(7) if not k or one * 3.0**-k >= np.exp(VISIBLE)] for one in shown
    ]
    widths = [down[0], down[1] + [3.0**k for k in range(1, 9) if 3.0**k <= reach]]
    direct = [
        multivariate_normal.logpdf(residual, cov=covariance + (columns * pair**2) @ columns.T)
        for pair in map(np.array, product(*widths))
    ]
    whole = multivariate_normal.logpdf(residual, cov=covariance + columns @ columns.T)
    gained = np.logaddexp.reduce(direct) - np.log(len(direct)) - whole
    found = posterior(residual, columns, Nuisances(wide))
    groups = [np.array([True, False]), np.array([False, True])]
    assert any_size(found, groups, [1.0, reach]) == pytest.approx(gained, abs=1e-6)


@pytest.mark.parametrize("sigma", [2.0, 3.0, 4.0, 5.0])
def test_a_rig_that_shows_an_effect_better_asks_hardly_more_evidence_of_it(sigma: float) -> None:
    """With ten times the signature one wide normal asks ln 10 more, the mixture ln 2.3."""
    gained, wide = [], []
    for shown in (30.0, 300.0):
        found = posterior(
            np.array([sigma, 0.0]), np.array([[shown], [0.0]]), Nuisances(np.zeros((2, 1)))
        )
        wide.append(0.5 * sigma * shown * found.mean[0] + found.log_volume)
        gained.append(wide[-1] + any_size(found, [np.array([True])], [1.0]))
    assert wide[0] - wide[1] == pytest.approx(np.log(10.0), abs=0.02)
    assert gained[0] - gained[1] == pytest.approx(np.log(2.3), abs=0.15)


@given(seeds)
def test_what_has_no_size_gains_nothing(seed: int) -> None:
    residual, wide, columns = drawn(seed)
    found = posterior(residual, columns, Nuisances(wide))
    assert any_size(found, [np.zeros(2, dtype=bool)], [1.0]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("times", [1.0, 10.0, 50.0])
def test_an_effect_far_beyond_the_typical_pays_for_the_orders_of_magnitude_only(
    times: float,
) -> None:
    """One wide normal asks times^2/2 more of it, the mixture less than ln 11."""
    shown, nuisances = 30.0, Nuisances(np.zeros((2, 1)))
    residual, columns = np.array([times * shown, 0.0]), np.array([[shown], [0.0]])
    found = posterior(residual, columns, nuisances)
    explained = 0.5 * float(residual @ columns @ found.mean) + found.log_volume
    gained = explained + any_size(found, [np.array([True])], [100.0])
    known = 0.5 * residual[0] ** 2 - np.log(times * shown)
    assert explained - known == pytest.approx(-0.5 * times**2 + np.log(times), rel=2e-3)
    assert -np.log(11.0) < gained - known < 0.0


@given(seeds)
def test_of_some_observations_is_that_of_their_marginal(seed: int) -> None:
    residual, wide, columns = drawn(seed)
    rows = np.arange(COUNT) < 5
    covariance = (np.eye(COUNT) + wide @ wide.T + columns @ columns.T)[:5, :5]
    direct = multivariate_normal.logpdf(residual[:5], cov=covariance) + 2.5 * np.log(2.0 * np.pi)
    problem = SimpleNamespace(residual=residual, nuisances=Nuisances(wide))
    assert log_evidence(problem, columns, rows) == pytest.approx(direct, abs=1e-7)


@given(seeds)
def test_roots_make_the_nuisances_metric(seed: int) -> None:
    residual, wide, columns = drawn(seed)
    nuisances = Nuisances(wide)
    inverse = np.linalg.inv(np.eye(COUNT) + wide @ wide.T)
    assert left_over(residual, nuisances) ** 2 == pytest.approx(residual @ inverse @ residual)
    root = rooted(nuisances, columns)
    assert root.T @ root == pytest.approx(columns.T @ inverse @ columns)


@given(st.integers(0, 2**31), st.integers(1, 4), st.integers(0, 9))
def test_a_root_of_a_covariance_is_one_however_well_parameters_are_told(
    seed: int, count: int, decades: int
) -> None:
    """Up to a precision of 1e18 beside the prior's 1, where the inverse has lost definiteness."""
    rng = np.random.default_rng(seed)
    columns = rng.standard_normal((12, count)) * 10.0 ** rng.uniform(0.0, decades, count)
    found = Posterior.of(columns.T @ columns, np.zeros(count)).root
    square = found @ found.T
    assert np.isfinite(square).all()
    assert (np.linalg.eigvalsh(square) > -1e-12).all()
    assert (np.diagonal(square) <= 1.0 + 1e-9).all()  # no wider than the prior
    if decades < 3:
        wanted = np.linalg.inv(np.eye(count) + columns.T @ columns)
        assert square == pytest.approx(wanted, rel=1e-6, abs=1e-12)
