"""Manoeuvres against SciPy's integrator on the equations of the paper, written out once more."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from analysis.manoeuvring import imo
from analysis.manoeuvring.hull import HullLoads
from analysis.manoeuvring.manoeuvres import spiral, turning_circle, zigzag
from analysis.manoeuvring.ship import Ship
from analysis.manoeuvring.stability import straight_course
from analysis.manoeuvring.steering import Propeller
from hardware.description.errors import ConfigurationError
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2


class Helm:
    """One ship under SciPy: rudder laid at its rate, then held, until a heading or a turn back."""

    def __init__(self, rates=None, ship: Published = kvlcc2) -> None:  # type: ignore[no-untyped-def]
        self.rates = ship.rates if rates is None else rates
        self.rate_rad_s = math.radians(ship.RATE)
        self.state = np.array([ship.U0, 0.0, 0.0, 0.0, 0.0, 0.0])
        self.delta = 0.0

    def until(self, order: float, event) -> np.ndarray:  # type: ignore[no-untyped-def]
        sign = math.copysign(1.0, order - self.delta)
        start, lasts = self.delta, abs(order - self.delta) / self.rate_rad_s
        for moving, span in ((True, lasts), (False, 1000.0)):
            if span == 0.0:
                continue

            def rates(t: float, y: np.ndarray, moving: bool = moving) -> np.ndarray:
                return self.rates(y, start + sign * self.rate_rad_s * t if moving else order)

            def at(t: float, y: np.ndarray) -> float:
                return float(event(y))

            at.terminal, at.direction = True, 1.0  # type: ignore[attr-defined]
            found = solve_ivp(
                rates, (0.0, span), self.state, "DOP853", events=at, rtol=1e-10, atol=1e-12
            )
            self.state = found.y[:, -1]
            self.delta = start + sign * self.rate_rad_s * found.t[-1] if moving else order
            if found.status == 1:
                return self.state
        raise AssertionError("the event did not come")


def test_rates_are_those_of_the_paper() -> None:
    draw, ship = np.random.default_rng(5), kvlcc2.ship()
    for _ in range(20):
        state = np.array([1.0, *draw.uniform(-0.3, 0.3, 1), *draw.uniform(-0.1, 0.1, 1), 0, 0, 1.0])
        delta = float(draw.uniform(-0.6, 0.6))
        found = ship.rates(state[:, None], np.array([delta]))[:, 0]
        np.testing.assert_allclose(found, kvlcc2.rates(state, delta), rtol=1e-11, atol=1e-14)
    assert ship.rate_hz[0] == pytest.approx(kvlcc2.N, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(("ship", "side"), [(kvlcc2, 1.0), (kvlcc2, -1.0), (kcs, 1.0), (kcs, -1.0)])
def test_turning_circle(ship: Published, side: float) -> None:
    order, helm = side * math.radians(35.0), Helm(ship=ship)
    quarter = helm.until(order, lambda y: side * y[5] - 0.5 * math.pi)
    half = helm.until(order, lambda y: side * y[5] - math.pi)
    found = turning_circle(ship.ship(), order)
    for value, expected in (
        (found.advance, quarter[3]),
        (found.transfer, side * quarter[4]),
        (found.tactical_diameter, side * half[4]),
    ):
        assert value[0] == pytest.approx(expected / ship.L, rel=1e-6)


BY_ANGLE = {"Y_d": -0.055, "N_d": 0.026, "X_dd": -0.03, "Y_ddd": 0.02, "N_ddd": -0.01, "Y_vvd": 0.3}


def _by_angle(state: np.ndarray, delta: float) -> np.ndarray:
    """The paper's hull and propeller with a rudder of Abkowitz's terms, written out."""
    u, v = state[:2]
    still = replace(kvlcc2, A_R=1e-300)  # no rudder of its own
    q = 0.5 * kvlcc2.RHO * kvlcc2.L * kvlcc2.D * (u * u + v * v)
    c, vp2 = BY_ANGLE, v * v / (u * u + v * v)
    x = q * c["X_dd"] * delta**2
    y = q * (c["Y_d"] * delta + c["Y_ddd"] * delta**3 + c["Y_vvd"] * vp2 * delta)
    n = q * kvlcc2.L * (c["N_d"] * delta + c["N_ddd"] * delta**3)
    unit = 0.5 * kvlcc2.RHO * kvlcc2.L**2 * kvlcc2.D
    left = np.diag([1.0, 1.0, 1.0]) * kvlcc2.MASS
    left[0, 0] += kvlcc2.M_X * unit
    left[1, 1] += kvlcc2.M_Y * unit
    left[1, 2] = left[2, 1] = kvlcc2.X_G * kvlcc2.MASS
    left[2, 2] = kvlcc2.I_ZG + kvlcc2.X_G**2 * kvlcc2.MASS + kvlcc2.J_Z * unit * kvlcc2.L**2
    added = np.linalg.solve(left, [x, y, n])
    return still.rates(state, 0.0) + np.array([*added, 0.0, 0.0, 0.0])


@pytest.mark.slow
def test_a_rudder_of_abkowitz_terms_turns_as_written_out() -> None:
    values = kvlcc2.terms() | {name: np.array([one]) for name, one in BY_ANGLE.items()}
    ship = replace(kvlcc2.ship(), rudder=None, helm_deg_s=kvlcc2.RATE, hull=HullLoads(
        kvlcc2.L, kvlcc2.L * kvlcc2.D, kvlcc2.RHO, values))  # fmt: skip
    order, helm = math.radians(35.0), Helm(_by_angle)
    quarter = helm.until(order, lambda y: y[5] - 0.5 * math.pi)
    half = helm.until(order, lambda y: y[5] - math.pi)
    found = turning_circle(ship, order)
    assert found.advance[0] == pytest.approx(quarter[3] / kvlcc2.L, rel=1e-6)
    assert found.tactical_diameter[0] == pytest.approx(half[4] / kvlcc2.L, rel=1e-6)
    with pytest.raises(ConfigurationError, match=r"Y_d, N_d, .* not taken beside the rudder"):
        replace(ship, rudder=kvlcc2.RUDDER)
    with pytest.raises(ConfigurationError, match="no Y_d and N_d: without"):
        replace(kvlcc2.ship(), rudder=None)


@pytest.mark.sample(1)
@pytest.mark.parametrize("ship", [kvlcc2, kcs])
@pytest.mark.parametrize(("degrees", "side"), [(10.0, 1.0), (20.0, -1.0)])
def test_zigzag(ship: Published, degrees: float, side: float) -> None:
    size, helm, way = math.radians(degrees), Helm(ship=ship), side
    helm.until(way * size, lambda y: way * y[5] - size)
    expected = []
    for _ in range(2):
        order = -way * size
        top = helm.until(order, lambda y, way=way: -way * y[2])
        expected.append(way * top[5] - size)
        helm.until(order, lambda y, way=way: -way * y[5] - size)
        way = -way
    found = zigzag(ship.ship(), side * size, size)
    np.testing.assert_allclose(found.overshoots_rad[:, 0], expected, rtol=1e-6)


def test_stability_is_that_of_the_derivatives_and_of_the_papers_equations() -> None:
    c, unit = kvlcc2.HULL, 0.5 * kvlcc2.RHO * kvlcc2.L**2 * kvlcc2.D
    m = kvlcc2.MASS / unit
    arm = m * kvlcc2.X_G / kvlcc2.L
    expected = c["Y_v"] * (c["N_r"] - arm) - c["N_v"] * (c["Y_r"] - kvlcc2.M_X - m)
    found = straight_course(kvlcc2.ship())
    assert found.criterion[0] == pytest.approx(expected, rel=1e-5)
    still = np.array([kvlcc2.U0, 0.0, 0.0, 0.0, 0.0, 0.0])
    roots = []
    for side in (1.0, -1.0):  # the rudder straightens the flow of each otherwise
        matrix = np.zeros((2, 2))
        for k, (row, step) in enumerate(((1, -side * 1e-6), (2, side * 1e-6))):
            way = np.zeros(6)
            way[row] = step
            change = kvlcc2.rates(still + way, 0.0) - kvlcc2.rates(still, 0.0)
            matrix[:, k] = change[1:3] / step
        roots.append(np.linalg.eigvals(matrix).real.max() * kvlcc2.L / kvlcc2.U0)
    assert roots[0] < 0.0 < roots[1]  # stable to starboard alone
    assert found.root[0] == pytest.approx(max(roots), rel=1e-4)
    assert (found.root[0] > 0.0) == (found.with_rudder[0] < 0.0)


def alike(ship: Ship) -> Ship:
    """The ship with the same propeller and rudder to either side."""
    rudder = replace(ship.rudder, straightening_plus=0.5, straightening_minus=0.5)
    propeller = replace(ship.propeller, wake_c2_plus=1.4, wake_c2_minus=1.4)
    return replace(ship, rudder=rudder, propeller=propeller)


@pytest.mark.slow
def test_port_mirrors_starboard() -> None:
    ship, order = alike(kvlcc2.ship()), math.radians(35.0)
    starboard, port = turning_circle(ship, order), turning_circle(ship, -order)
    for name in ("advance", "transfer", "tactical_diameter", "steady_drift_rad"):
        assert getattr(port, name)[0] == pytest.approx(getattr(starboard, name)[0], rel=1e-9)
    found = spiral(ship, math.radians(5.0), math.radians(5.0))
    np.testing.assert_allclose(found.up, -found.down[::-1], atol=1e-4)


@pytest.mark.slow
def test_a_spiral_has_no_lag() -> None:
    """Each turn is where the paper's equations stand still, near to neutral stability too."""
    found = spiral(kvlcc2.ship(), math.radians(5.0), math.radians(5.0))
    for k, rudder in enumerate(found.rudder_rad.tolist()):
        for turn in (float(found.down[k, 0]), float(found.up[k, 0])):

            def still(motion: np.ndarray, angle: float = rudder) -> np.ndarray:
                rates = kvlcc2.rates(np.array([*motion, 0.0, 0.0, 0.0]), angle)
                return np.asarray(rates[:3])

            near = [kvlcc2.U0, -0.4 * turn * kvlcc2.U0, turn * kvlcc2.U0 / kvlcc2.L]
            u, v, r = fsolve(still, near, xtol=1e-12)
            assert r * kvlcc2.L / math.hypot(u, v) == pytest.approx(turn, abs=2e-4)


def test_a_turn_that_is_not_steady_has_no_number(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("analysis.manoeuvring.manoeuvres._SPIRAL_MOST", 1)
    found = spiral(kvlcc2.ship(), math.radians(5.0), math.radians(5.0))
    assert np.isnan(found.height).all(), "10 L/U leave a lag in the loop of KVLCC2"


@pytest.mark.slow
@given(st.floats(2.0, 100.0))
@settings(max_examples=3)
def test_a_ship_of_another_size_does_the_same_by_froude(scale: float) -> None:
    small = kvlcc2.ship()
    hull = replace(small.hull, length_m=kvlcc2.L * scale, area_m2=small.hull.area_m2 * scale**2)
    propeller = replace(small.propeller, diameter_m=kvlcc2.D_P * scale)
    rudder = replace(
        small.rudder, area_m2=kvlcc2.A_R * scale**2, height_m=kvlcc2.H_R * scale,
        rate_deg_s=kvlcc2.RATE / math.sqrt(scale),
    )  # fmt: skip
    large = Ship(
        hull, propeller, rudder, small.mass_kg * scale**3, small.inertia_kg_m2 * scale**5,
        small.cg_x_m * scale, small.approach_m_s * math.sqrt(scale),
    )  # fmt: skip
    assert large.rate_hz[0] == pytest.approx(small.rate_hz[0] / math.sqrt(scale))
    turns = [turning_circle(one, math.radians(35.0)) for one in (small, large)]
    assert turns[1].tactical_diameter[0] == pytest.approx(turns[0].tactical_diameter[0], rel=1e-9)


@pytest.mark.slow
def test_many_ships_at_once_are_each_as_one() -> None:
    """Three ships with other derivatives, turned together and one by one."""
    values = {name: np.repeat(one, 3) for name, one in kvlcc2.terms().items()}
    values["Y_v"] = values["Y_v"] * np.array([1.0, 1.1, 0.9])
    together = zigzag(kvlcc2.ship(values), 0.2, 0.2).overshoots_rad
    for k in range(3):
        alone = kvlcc2.ship({name: one[k : k + 1] for name, one in values.items()})
        found = zigzag(alone, 0.2, 0.2).overshoots_rad[:, 0]
        np.testing.assert_allclose(together[:, k], found, rtol=1e-12)


def test_a_ship_that_does_not_turn_has_no_circle() -> None:
    """Stable on straight course, and a rudder that hardly does anything."""
    ship = kvlcc2.ship(kvlcc2.terms(N_v=0.0))
    stuck = replace(ship, rudder=replace(ship.rudder, slope=1e-9))
    found = turning_circle(alike(stuck), math.radians(35.0), step=1.0)
    assert np.isnan(found.advance[0])
    assert np.isnan(found.steady_diameter[0])


@pytest.mark.parametrize(
    ("seconds", "first", "second"),
    [(5.0, 10.0, 25.0), (10.0, 10.0, 25.0), (20.0, 15.0, 32.5), (30.0, 20.0, 40.0),
     (60.0, 20.0, 40.0)],
)  # fmt: skip
def test_limits_of_the_resolution(seconds: float, first: float, second: float) -> None:
    assert imo.first_overshoot_deg(seconds) == first
    assert imo.second_overshoot_deg(seconds) == second


def test_what_is_missing_or_cannot_be_is_said() -> None:
    values = kvlcc2.terms()
    del values["X_udot"]
    with pytest.raises(ConfigurationError, match="no X_udot: a turning ship needs them"):
        HullLoads(7.0, 3.0, 1000.0, values)
    with pytest.raises(ConfigurationError, match=r"Y_vdot\|v\|, X_vdot: of terms by an accel"):
        HullLoads(
            7.0, 3.0, 1000.0, kvlcc2.terms() | {"Y_vdot|v|": np.ones(1), "X_vdot": np.ones(1)}
        )
    weak = Propeller(0.216, (-0.1, 0.0, 0.0), 0.2, 0.4)
    with pytest.raises(ConfigurationError, match="no revolutions balance a resistance of"):
        _ = replace(kvlcc2.ship(), propeller=weak).rate_hz
