"""Weights from estimated scatter: intervals as wide as those of a scatter that is known."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit, fit_cycles
from analysis.uncertainty.values import Contribution
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import cycle_of
from tests.analysis.coefficients.sources import of_covariance, of_draws, scattering
from tests.exact.rigs import exact_rig

TERMS, FORCE_N, RUNS, PERIODS, CAMPAIGNS = ("Y_vdot", "Y_v"), 0.2, 6, 6, 80


@pytest.fixture(scope="module")
def sway() -> BodyCycle:
    rig = exact_rig(Plane.HORIZONTAL, Arrangement(), sway_m=0.1, rotation_rad=0.0)
    return cycle_of(rig, "sway", 3)


def spread(cycle: BodyCycle) -> np.ndarray:
    """Standard deviation of one period's numbers: of the force's first harmonic alone."""
    return np.repeat([FORCE_N * (name == "force 1") for name in cycle.phasors.names], 2)


def with_source(cycle: BodyCycle, name: str, source: Contribution) -> BodyCycle:
    return replace(cycle, name=name, phasors=scattering(cycle.phasors, source))


def repeated(cycle: BodyCycle, generator: np.random.Generator, runs: int) -> CycleFit:
    """Fit repeats whose scatter a few periods each tell."""
    found = []
    for k in range(runs):
        draws = spread(cycle) * generator.standard_normal((PERIODS, 2 * len(cycle.phasors.names)))
        found.append(with_source(cycle, f"run {k}", of_draws(f"scatter {k}", draws)))
    return fit_cycles(found, TERMS, (1,))


@pytest.mark.slow
def test_repeats_are_as_sure_as_with_the_scatter_known(sway: BodyCycle) -> None:
    covariance = np.diag(spread(sway) ** 2 / PERIODS)
    known = [
        with_source(sway, f"run {k}", of_covariance(f"scatter {k}", covariance, np.inf))
        for k in range(RUNS)
    ]
    truth = fit_cycles(known, TERMS, (1,)).uncertain.standard_uncertainty
    generator = np.random.default_rng(29)
    found = np.array([
        repeated(sway, generator, RUNS).uncertain.standard_uncertainty for _ in range(CAMPAIGNS)
    ])  # fmt: skip
    ratio = (found**2).mean() / (truth**2).mean()
    # 160 variances of about 50 degrees of freedom: 1.6 %. Without what luck adds it is 0.91.
    assert ratio == pytest.approx(1.0, abs=0.05)


def test_a_run_that_tells_its_terms_alone_has_its_own_scatter(sway: BodyCycle) -> None:
    fit = repeated(sway, np.random.default_rng(29), 1)
    problem, (cycle,) = fit.problem, fit.problem.numbers.cycles
    (source,) = cycle.hull.phasors.real.contributions
    parts = problem.sensitivities(fit.values)[0] @ problem.numbers.scatter(cycle, source)
    expected = np.sqrt((parts**2).sum(axis=1))
    np.testing.assert_allclose(fit.uncertain.standard_uncertainty, expected, rtol=1e-9)
    np.testing.assert_allclose(problem.shares[0], np.eye(2), atol=1e-12)
