"""Formulas of estimates that share inputs, against GTC's uncertain numbers."""

import math

import GTC
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, difference, joint

spread = st.floats(1e-3, 0.05)
freedom = st.integers(2, 30).map(float)


@given(spread, spread, spread, freedom, freedom)
def test_a_chain_of_formulas_is_gtcs(
    u_period: float, u_mass: float, u_scale: float, nu_period: float, nu_mass: float
) -> None:
    """A moment made with the mass goes into an inertia with the mass, and that into a gyradius."""
    period = Estimate.of(2.0, u_period, "s", nu_period)
    mass = Estimate.of(3.0, u_mass, "kg", nu_mass)
    arm = Estimate.of(0.7, 0.01, "m").widened(u_scale, label="scale")
    moment = derived("S", lambda mass, arm: mass * arm, "kg m", mass=mass, arm=arm)
    about = derived("I", lambda t, s: t * t * s * 0.25, "kg m2", t=period, s=moment)
    inputs = {"about": about, "mass": mass, "arm": arm}
    own = derived("k", lambda about, mass, arm: np.sqrt(about / mass + arm * arm), "m", **inputs)

    t, m = GTC.ureal(2.0, u_period, nu_period), GTC.ureal(3.0, u_mass, nu_mass)
    d = GTC.ureal(0.7, 0.01) + GTC.ureal(0.0, u_scale)
    inertia = t * t * (m * d) * 0.25
    k = GTC.sqrt(inertia / m + d * d)
    for ours, number in ((about, inertia), (own, k)):
        assert ours.value == pytest.approx(GTC.value(number))
        assert ours.uncertainty == pytest.approx(GTC.uncertainty(number), rel=1e-5)
        assert ours.degrees_of_freedom == pytest.approx(GTC.dof(number), rel=1e-4)
    covariance = joint((about, own)).covariance()[0, 1]
    assert covariance == pytest.approx(GTC.get_covariance(inertia, k), rel=1e-4)


@given(st.floats(0.1, 3.0), freedom, freedom)
def test_differences_and_their_intervals_are_gtcs(u: float, nu: float, other: float) -> None:
    first = Estimate.of(5.0, u, "s", nu).widened(0.7, label="scale")
    second = Estimate.of(4.0, 0.4, "s", other).widened(0.5, label="scale")
    scale = GTC.ureal(0.0, 1.0)
    number = (GTC.ureal(5.0, u, nu) + 0.7 * scale) - (GTC.ureal(4.0, 0.4, other) + 0.5 * scale)
    apart = difference(first, second)
    assert apart.value == pytest.approx(1.0)
    assert apart.uncertainty == pytest.approx(GTC.uncertainty(number))
    factor = GTC.reporting.k_factor(GTC.dof(number))
    assert apart.half_width() == pytest.approx(factor * GTC.uncertainty(number), rel=1e-6)


def test_estimates_of_one_input_move_together_in_the_trials() -> None:
    one = Estimate.of(1.0, 0.2, "m", 5.0)
    twice = one.following(2.0, 2.0)
    drawn = joint((one, twice)).draw(1000, np.random.default_rng(5))
    assert drawn[1] == pytest.approx(2.0 * drawn[0])
    assert math.isclose(joint((one, twice)).covariance()[0, 1], 2.0 * 0.2**2)
