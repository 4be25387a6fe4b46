"""The runs that are selected against every subset of a small grid, and against closed forms."""

import math
from itertools import product

import numpy as np
import pytest

from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import Belief
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.regression import Prospects, prospects
from analysis.design.selection import select
from benchmarks.coefficients_campaigns import BODY, HORIZONTAL
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from tests.analysis.design.designs import EXACT, LINEAR, NOISE, WHOLE, covariance, grid


def _shortest(known: Prospects, targets: list[DesignTarget]) -> float:
    """Least tank time of any set of runs, none twice, that meets all targets."""
    costs = np.array([one.cost_s for one in known.candidates])
    least = math.inf
    for taken in product((False, True), repeat=len(costs)):
        chosen = list(np.flatnonzero(taken))
        if not chosen or costs[chosen].sum() >= least:
            continue
        met = all(
            (np.diag(covariance(one, chosen)) <= one.wanted**2).all()
            for one in known.regressions(targets, chosen)
        )
        least = costs[chosen].sum() if met else least
    return least


@pytest.mark.parametrize("wanted", [0.8, 1.5, 3.0])
def test_no_subset_is_much_shorter(wanted: float) -> None:
    runs = grid(phases_rad=(0.0, 1.5, 2.5), periods=(5,))[:11]
    targets = [
        DesignTarget("Y_v", wanted),
        DesignTarget("N_r", wanted),
        DesignTarget("Y_vdot", 4.0 * wanted),
    ]
    known = prospects(runs, LINEAR, NOISE, EXACT)
    found = select(known, targets)
    assert found.met
    used = sum(known.candidates[k].cost_s for k in found.chosen)
    assert used <= 1.15 * _shortest(known, targets)


def test_no_subset_of_the_time_has_a_much_smaller_determinant() -> None:
    runs, time_s = grid(phases_rad=(0.0, 1.5), periods=(4, 8))[2:11], 600.0
    known = prospects(runs, WHOLE, NOISE, EXACT)
    found = select(known, [], time_s)

    def volume(chosen: list[int]) -> float:
        fits = known.regressions([], chosen)
        return sum(float(np.linalg.slogdet(covariance(one, chosen))[1]) for one in fits)

    costs = np.array([one.cost_s for one in runs])
    subsets = [list(np.flatnonzero(taken)) for taken in product((False, True), repeat=len(runs))]
    best = min(volume(one) for one in subsets if one and costs[one].sum() <= time_s)
    assert sum(costs[list(found.chosen)]) <= time_s
    assert volume(list(found.chosen)) <= best + 0.3 * len(WHOLE.values)


def test_one_motion_takes_the_time_of_the_closed_form() -> None:
    """Two coefficients of a pure sway: ``u(Y_v) = s / (w e)`` and ``u(Y_vdot) = s / (w^2 e)``.

    Both gauges' density 2 sigma^2 / f_s over the time T gives ``s^2 = 4 sigma^2 / (f_s T)``.
    """
    belief = Belief(HORIZONTAL_1963, BODY, {k: HORIZONTAL[k] for k in ("Y_v", "Y_vdot")})
    run = CandidateRun(SetPoint(0.2, 0.15, 0.0, 1.2), 10, 60.0)
    (known,) = prospects([run], belief, NOISE, EXACT).regressions([DesignTarget("Y_v", 1.0)])
    omega = 2.0 * math.pi * 0.2
    s = math.sqrt(4.0 * NOISE.force_n**2 / (NOISE.sample_rate_hz * run.measured_s))
    closed = [s / (omega * 0.15), s / (omega**2 * 0.15)]
    assert np.sqrt(np.diag(covariance(known, [0]))) == pytest.approx(closed, rel=1e-6)
    for repeats in (1, 4, 9):
        wanted = 1.02 * closed[0] / math.sqrt(repeats)
        found = select(prospects([run], belief, NOISE, EXACT), [DesignTarget("Y_v", wanted)])
        assert found.met
        assert len(found.chosen) == repeats


def test_a_lone_coefficient_is_asked_of_the_fastest_run() -> None:
    """``u = s / (w e)`` falls with the speed of the struts, so that the largest serves best."""
    belief = Belief(HORIZONTAL_1963, BODY, {k: HORIZONTAL[k] for k in ("Y_v", "Y_vdot")})
    runs = grid((0.05, 0.1, 0.25), (0.05, 0.2, 0.1), (0.0,), (5,))
    found = select(prospects(runs, belief, NOISE, EXACT), [DesignTarget("Y_v", 0.5)])
    assert {runs[k].point for k in found.chosen} == {SetPoint(0.25, 0.2, 0.0, 1.2)}


def test_what_is_stated_is_not_measured_away() -> None:
    known = prospects(grid(), LINEAR, NOISE, StatedUncertainties(mass_kg=1.0))
    assert not select(known, [DesignTarget("Y_vdot", 0.9)], time_s=5e3).met
    found = select(known, [DesignTarget("Y_vdot", 1.3)], time_s=5e3)
    (force,) = known.regressions([DesignTarget("Y_vdot", 1.3)], found.chosen)
    assert found.met
    assert covariance(force, found.chosen)[0, 0] > 1.0


def test_runs_that_were_made_are_not_asked_for_again() -> None:
    known = prospects(grid(), LINEAR, NOISE, EXACT)
    targets = [DesignTarget("Y_v", 1.0), DesignTarget("N_r", 1.0)]
    first = select(known, targets)
    assert select(known, targets, made=first.chosen).chosen == ()
    rest = select(known, targets, made=first.chosen[:1])
    assert rest.met
    assert len(rest.chosen) <= len(first.chosen) - 1


def test_each_frequency_of_a_band_is_met_by_its_own_runs() -> None:
    runs = grid((0.1, 0.15, 0.2, 0.25), (0.1, 0.2), (0.0, 1.5), (5,))
    known = prospects(runs, LINEAR, NOISE, EXACT)
    found = select(known, [DesignTarget("Y_v", 1.0, (0.12, 0.2))])
    assert found.met
    assert {runs[k].point.frequency_hz for k in found.chosen} == {0.15, 0.2}
