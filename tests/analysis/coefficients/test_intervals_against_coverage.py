"""95 % intervals hold the put-in value 95 % of the time, whatever the runs and the scatter."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.setpoint import SetPoint
from sim.rig import vertical_rig
from tests.analysis.coefficients.campaign import loaded, pure
from tests.analysis.coefficients.ideal import (
    ECCENTRICITY_M,
    HULL,
    covariance,
    ideal_struts,
    net,
    pair,
    scattered,
)
from tests.analysis.coefficients.sources import of_covariance, scattering

TRUTH = {
    "Z_wdot": -75.0, "Z_qdot": -3.0, "M_wdot": -3.0, "M_qdot": -22.0,
    "Z_w": -190.0, "Z_q": -12.0, "M_w": -12.0, "M_q": -55.0,
}  # fmt: skip
MIXED = [SetPoint(0.8, ECCENTRICITY_M, phase, 1.2) for phase in (0.0, 1.0, 2.2, 3.0)]


@pytest.mark.slow
@pytest.mark.parametrize("points", [pair(), MIXED, pair(0.15)], ids=["two", "four", "slow"])
@pytest.mark.parametrize("periods", [4, 20])
def test_coverage_of_closed_form_runs(points: list[SetPoint], periods: int) -> None:
    generator = np.random.default_rng(7)
    names = list(TRUTH)
    truth = np.array(list(TRUTH.values()))
    hits, count = np.zeros(len(names)), 300
    clean = [ideal_struts(point, name=f"{k}") for k, point in enumerate(points)]
    for _ in range(count):
        runs = [net(scattered(run, covariance(), periods, generator)) for run in clean]
        fit = linear_fit(runs, Form.MANOEUVRING, StatedUncertainties()).fit
        order = [fit.names.index(name) for name in names]
        miss = np.abs(fit.values[order] - truth)
        hits += miss <= fit.uncertain.half_width()[order]
    rate = hits / count
    assert rate.mean() == pytest.approx(0.95, abs=0.025)
    assert rate.min() > 0.91
    assert rate.max() < 0.995


@pytest.mark.slow
def test_coverage_of_simulated_campaigns() -> None:
    """The whole way, 100 seeded campaigns of heave and pitch through rig, recorder and resolver."""
    rig = vertical_rig()
    names = ("a33", "b33", "a53", "b53", "a35", "b35", "a55", "b55")
    truth = np.array([75.0, 190.0, 3.0, 12.0, 3.0, 12.0, 22.0, 55.0])
    hits, seeds = np.zeros(len(names)), 100
    for seed in range(seeds):
        runs = [
            loaded(rig, point, name=f"{k}", seed=2 * seed + k, rate_hz=50.0)
            for k, point in enumerate(pure(0.8, 0.005))
        ]
        fit = linear_fit(runs, Form.SEAKEEPING, StatedUncertainties()).fit
        assert set(fit.names) == set(names)
        order = [fit.names.index(name) for name in names]
        miss = np.abs(fit.values[order] - truth)
        hits += miss <= fit.uncertain.half_width()[order]
    rate = hits / seeds
    assert rate.mean() == pytest.approx(0.95, abs=0.03)
    assert rate.min() >= 0.88


def test_joint_covariance_matters() -> None:
    """Struts that scatter together: as if independent, moment and force would be wrong."""
    generator = np.random.default_rng(3)
    run = scattered(ideal_struts(pair()[0]), covariance(0.9), 5000, generator)
    joint = run.model().phasors.select(["force 1", "moment 1"]).standard_uncertainty
    variance = np.diag(np.diagonal(run.phasors.real.covariance()))
    source = of_covariance("each by itself", variance, np.inf)
    alone = replace(run, phasors=scattering(run.phasors, source))
    independent = alone.model().phasors.select(["force 1", "moment 1"]).standard_uncertainty
    # force: 1 + rho, moment: 1 - rho
    assert joint[0].real / independent[0].real == pytest.approx(1.9**0.5, rel=0.03)
    assert joint[1].real / independent[1].real == pytest.approx(0.1**0.5, rel=0.1)
    assert HULL.added_mass[0, 0] == 75.0
