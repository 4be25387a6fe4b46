"""Surge terms of exact rigs whose resistance goes with u^2, or not at all, as they turn."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.resistance_form import BY_SPEED, fit_surge
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import (
    HULLS,
    campaign,
    cycle_of,
    less_known,
    struts_of,
)
from tests.exact.hull import polynomial

SPEED_M_S, X_UU, ORDERS = 1.2, -5.5, 7
NAMES = ("X_0", "X_vv", "X_rr", "X_vr")


def cycles(by_speed: bool) -> list[BodyCycle]:
    rigs = campaign(Plane.HORIZONTAL, Arrangement())
    if by_speed:
        terms = {k: v for k, v in HULLS[Plane.HORIZONTAL].items() if k != "X_0"}
        rigs = [replace(rig, hull=polynomial(terms | {"X_uu": X_UU})) for rig in rigs]
    return [cycle_of(rig, str(k), ORDERS) for k, rig in enumerate(rigs)]


def test_a_resistance_by_the_square_of_u_leaves_the_other_terms_alone() -> None:
    found, choice = fit_surge(cycles(by_speed=True), NAMES, (0, 1, 2))
    truth = HULLS[Plane.HORIZONTAL] | {"X_0": X_UU * SPEED_M_S**2}
    for name in NAMES:
        assert found[name] == pytest.approx(truth[name], rel=1e-4), name
    assert choice is not None
    assert choice.fitted == BY_SPEED
    assert found.terms[0].unit == "N"
    constant = fit_cycles(cycles(by_speed=True), NAMES, (0, 1, 2))
    assert abs(constant["X_rr"] - truth["X_rr"]) > 0.1 * truth["X_rr"]


def test_a_constant_one_is_taken_as_constant() -> None:
    found, choice = fit_surge(cycles(by_speed=False), NAMES, (0, 1, 2))
    assert choice is None
    for name in NAMES:
        assert found[name] == pytest.approx(HULLS[Plane.HORIZONTAL][name], rel=1e-4), name


def test_the_speed_that_it_is_divided_by_counts_in_the_budget() -> None:
    """The same records, said to be of another carriage speed: X_0 is that at the speed said."""
    rigs = campaign(Plane.HORIZONTAL, Arrangement())
    terms = {k: v for k, v in HULLS[Plane.HORIZONTAL].items() if k != "X_0"}
    rigs = [replace(rig, hull=polynomial(terms | {"X_uu": X_UU})) for rig in rigs]

    def fitted(by_m_s: float, **stated: float):
        said = []
        for k, rig in enumerate(rigs):
            struts = struts_of(rig, str(k), ORDERS)
            point = replace(struts.set_point, carriage_speed_m_s=SPEED_M_S + by_m_s)
            said.append(less_known(replace(struts, set_point=point), rig))
        return fit_surge(said, NAMES, (0, 1, 2), stated=StatedUncertainties(**stated))[0]

    fit = fitted(0.0, speed_m_s=1.0)
    (told,) = [one.dense(len(NAMES))[:, 0] for one in fit.uncertain.contributions
               if one.label == "speed_m_s"]  # fmt: skip
    shown = (fitted(1e-4).values - fitted(-1e-4).values) / 2e-4
    np.testing.assert_allclose(np.abs(told), np.abs(shown), rtol=0.01, atol=0.01)


def test_its_terms_follow_each_number_of_the_cycles_as_other_fits_do() -> None:
    found, _ = fit_surge(cycles(by_speed=True), NAMES, (0, 1, 2))
    problem, step = found.problem, 1e-5
    told = problem.sensitivities(found.values)
    generator = np.random.default_rng(9)
    for _ in range(4):
        way = generator.standard_normal(problem.numbers.parts.shape)
        both = np.stack((problem.numbers.parts + step * way, problem.numbers.parts - step * way))
        up, down = problem.solve(both)
        expected = np.einsum("ktn,kn->t", told, way)
        np.testing.assert_allclose((up - down) / (2.0 * step), expected, rtol=1e-4)
