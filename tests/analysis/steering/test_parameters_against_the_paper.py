"""MMG parameters of propeller and rudder, against those with which the runs were made."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.steering.identification import identified
from analysis.steering.observations import SteeringRuns
from hardware.description.errors import DataError
from tests.analysis.manoeuvring.published import Published, kcs
from tests.analysis.manoeuvring.published import kvlcc2 as paper
from tests.analysis.steering.captive import (
    CAMPAIGN,
    KNOWN,
    OBLIQUE,
    RATES,
    STRAIGHT,
    TRUTH,
    TURNING,
    known,
    runs,
    truth,
)

CAMPAIGNS = 200
NORMAL_95 = 1.959963984540054


@pytest.mark.parametrize("ship", [paper, kcs])
def test_exact_numbers_give_the_published_parameters(ship: Published) -> None:
    found = identified(runs(None, ship=ship), known(ship))
    assert found.names == tuple(truth(ship))
    assert found.values == pytest.approx(list(truth(ship).values()), abs=1e-6)
    assert found.missing == {}
    assert found.misfit == pytest.approx((0.0, 0.0), abs=1e-5)


def test_the_self_propulsion_point_is_where_the_paper_balances() -> None:
    (point,) = identified(runs(None), KNOWN).self_propulsion
    resistance = -paper.hull(paper.U0, 0.0, 0.0)[0]
    assert point.resistance_n == pytest.approx(resistance, rel=1e-6)
    assert point.rate_hz == pytest.approx(paper.N, rel=1e-6)
    assert point.thrust_n == pytest.approx(resistance / (1.0 - paper.T_P), rel=1e-6)
    pulled = identified(runs(None), KNOWN, 0.2 * resistance).self_propulsion[0]
    assert pulled.thrust_n == pytest.approx(0.8 * point.thrust_n, rel=1e-6)
    assert pulled.rate_hz < point.rate_hz


def test_wakes_in_drift_and_turn_are_the_papers() -> None:
    found = identified(runs(None), KNOWN)
    for u, v, r, wake, _ in found.wakes.T:
        angle = math.atan2(-v, u) - paper.X_P * r * paper.L / math.hypot(u, v)
        c2 = paper.C2[0] if angle > 0.0 else paper.C2[1]
        grown = 1.0 + (1.0 - math.exp(-paper.C1 * abs(angle))) * (c2 - 1.0)
        assert wake == pytest.approx(1.0 - (1.0 - paper.W_P0) * grown, abs=1e-6)


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    rng = np.random.default_rng(29)
    truth = np.array(list(TRUTH.values()))
    errors, rates = [], []
    for _ in range(CAMPAIGNS):
        found = identified(runs(rng), KNOWN)
        errors.append((found.values - truth) / found.standard_uncertainty)
        point = found.self_propulsion[0]
        rates.append((point.rate_hz - paper.N) / point.rate_u)
    within = np.abs(np.column_stack((errors, rates))) < NORMAL_95
    assert 0.93 < within.mean() < 0.975
    assert within.mean(axis=0).min() > 0.90  # 200 draws of 0.95 scatter by 0.015
    assert np.abs(np.mean(errors, axis=0)).max() < 0.25  # nothing is off on average


def test_residuals_beyond_the_stated_scatter_widen_the_intervals() -> None:
    rng = np.random.default_rng(5)
    one = runs(rng)
    sure = SteeringRuns(
        one.names, one.motion, one.rudder_rad, one.rate_hz, one.values, one.uncertainty / 3.0
    )
    one = replace(one, shared=None)
    plain, told = identified(one, KNOWN), identified(sure, KNOWN)
    assert told.misfit == pytest.approx(tuple(3.0 * m for m in plain.misfit), rel=1e-3)
    ratio = told.standard_uncertainty / plain.standard_uncertainty
    assert ratio == pytest.approx(1.0, abs=0.15)


def test_what_the_runs_do_not_tell_is_said() -> None:
    found = identified(runs(None, (*STRAIGHT, *OBLIQUE)), KNOWN)
    assert found.missing == {"l_R": "yaw with rudder"}
    assert found["gamma_R-"] == pytest.approx(paper.GAMMA[1], abs=1e-6)
    one_side = [one for one in OBLIQUE if one[0] > 0.0]
    found = identified(runs(None, (*STRAIGHT, *one_side)), KNOWN)
    assert found.missing["gamma_R-"] == "oblique tow with rudder, bow to port"
    straight = identified(runs(None, tuple(STRAIGHT)), KNOWN)
    assert set(straight.missing) == {"gamma_R+", "gamma_R-", "l_R"}
    assert straight["kappa"] == pytest.approx(paper.KAPPA, abs=1e-6)


def test_runs_that_cannot_tell_are_refused() -> None:
    amidships = [one for one in STRAIGHT if one[3] == 0.0]
    with pytest.raises(DataError, match=r"do not tell 1 - t_R .*; 1 \+ a_H \(make the same tow"):
        identified(runs(None, (*amidships, *amidships)), KNOWN)
    laid = [one for one in STRAIGHT if one[3] == 10.0]
    with pytest.raises(DataError, match=r"neutral is not known: .* laid at 1 angles"):
        identified(runs(None, (*laid, *laid)), KNOWN)
    one_rate = [one for one in CAMPAIGN if one[2] == RATES[1]]
    with pytest.raises(DataError, match=r"1 - t_P \(make load variation"):
        identified(runs(None, tuple(one_rate)), KNOWN)
    with pytest.raises(DataError, match=r"do not tell .* apart: make oblique tows"):
        identified(runs(None, (*STRAIGHT, *TURNING)), KNOWN)
    stands = runs(None)
    with pytest.raises(DataError, match="run-0: its propeller has no revolutions"):
        SteeringRuns(
            stands.names, stands.motion, stands.rudder_rad, 0.0 * stands.rate_hz, stands.values,
            stands.uncertainty,
        )  # fmt: skip
