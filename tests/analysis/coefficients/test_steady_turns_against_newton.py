"""Runs on a circle, whose loads are those of point masses by Newton's law in axes that stand.

The body is a cloud of points on a rigid frame. Their accelerations are the second differences of
where they are in the tank as the frame goes round: no term of the product's equations of motion is
used. The water's loads are put in by their coefficients.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.steady_turns import SteadyTurn, turn_cycle
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError

# Masses in kg, ahead and to starboard of the midpoint in m; symmetric about the middle line.
MASSES = np.array([[20.0, 0.7, 0.0], [15.0, -0.5, 0.1], [15.0, -0.5, -0.1], [10.0, 0.1, 0.0]])
PUT_IN = {"Y_v": -120.0, "Y_r": 30.0, "N_v": -40.0, "N_r": -25.0}
CUBIC = {"Y_vvv": -300.0, "Y_rrr": 8.0, "Y_vvr": 60.0, "Y_vrr": -45.0}
U_M_S = 1.0
NAMES = (*PUT_IN, "X_0")


def body() -> Body:
    mass, ahead, aside = MASSES.T
    total, about = mass.sum(), (mass * (ahead**2 + aside**2)).sum()
    cg = float((mass * ahead).sum() / total)
    return Body(mass_kg=float(total), inertia_kg_m2=float(about), cg_x_m=cg)


def held(
    radius_m: float, rate: float, drift: float, astern_m: float = 0.0
) -> tuple[float, float, float]:
    """Force to starboard, moment and force ahead that the cloud takes on its circle, by Newton.

    The cloud may lie further astern of the midpoint, which goes round the circle.
    """
    step = 1e-4
    places_ahead = MASSES[:, 1:2] - astern_m

    def places(time_s: float) -> np.ndarray:
        turned = rate * time_s  # of the way's direction; x north, y east, turning to starboard
        way = np.array([math.cos(turned), math.sin(turned)])
        right = np.array([-math.sin(turned), math.cos(turned)])
        middle = -math.copysign(radius_m, rate) * right
        heading = turned + drift
        bow = np.array([math.cos(heading), math.sin(heading)])
        star = np.array([-math.sin(heading), math.cos(heading)])
        assert np.dot(way, right) == pytest.approx(0.0, abs=1e-12)
        return middle + places_ahead * bow + MASSES[:, 2:3] * star

    acceleration = (places(step) - 2.0 * places(0.0) + places(-step)) / step**2
    forces = MASSES[:, :1] * acceleration
    bow = np.array([math.cos(drift), math.sin(drift)])
    star = np.array([-math.sin(drift), math.cos(drift)])
    ahead, across = forces @ bow, forces @ star
    moment = (places_ahead[:, 0] * across - MASSES[:, 2] * ahead).sum()
    return float(across.sum()), float(moment), float(ahead.sum())


def turn(
    radius_m: float,
    drift: float,
    coefficients: dict[str, float],
    sign: float,
    astern_m: float = 0.0,
) -> SteadyTurn:
    """A circle of the midpoint; the point that body and coefficients are about may lie astern."""
    rate = sign * U_M_S / radius_m
    v = -U_M_S * math.sin(drift) - rate * astern_m
    water = {"Y": 0.0, "N": 0.0}
    for name, value in coefficients.items():
        load, factors = name.split("_")
        water[load] += value * v ** factors.count("v") * rate ** factors.count("r")
    water["N"] -= astern_m * water["Y"]
    force, moment, ahead = held(radius_m, rate, drift, astern_m)
    return SteadyTurn(
        f"turn-{radius_m}-{drift}-{sign}", radius_m, rate, force - water["Y"], moment - water["N"],
        1e-3, 1e-3, drift, ahead + 5.0, 1e-3,
    )  # fmt: skip


def solved(coefficients: dict[str, float], point_ahead_m: float = 0.0) -> dict[str, float]:
    turns = [
        turn(radius, drift, coefficients, sign)
        for radius in (3.0, 5.0, 9.0)
        for drift in (-0.1, -0.04, 0.0, 0.07, 0.12)
        for sign in (1.0, -1.0)
    ]
    cycles = [turn_cycle(one, 0.5, body()).about(point_ahead_m) for one in turns]
    found = campaign_coefficients(cycles, Request())
    return {entry.name: float(found.uncertain.values[k]) for k, entry in enumerate(found.entries)}


def test_linear_coefficients_come_back() -> None:
    found = solved(PUT_IN)
    assert {name: found[name] for name in PUT_IN} == pytest.approx(PUT_IN, rel=1e-5)
    assert found["X_0"] == pytest.approx(-5.0, abs=1e-4)


def test_cubic_terms_and_their_cross_terms_come_back() -> None:
    put_in = PUT_IN | CUBIC
    found = solved(put_in)
    assert {name: found[name] for name in put_in} == pytest.approx(put_in, rel=1e-3)


def test_about_a_point_ahead_they_are_those_of_the_shifted_hull() -> None:
    """Y(v, r) with v at the midpoint is v at the point less its lever times r; N by the lever."""
    ahead = 0.3
    found = solved(PUT_IN, ahead)
    y_v, y_r, n_v, n_r = PUT_IN.values()
    shifted = {
        "Y_v": y_v,
        "Y_r": y_r - ahead * y_v,
        "N_v": n_v - ahead * y_v,
        "N_r": n_r - ahead * n_v - ahead * (y_r - ahead * y_v),
    }
    assert {name: found[name] for name in shifted} == pytest.approx(shifted, rel=1e-5)


@pytest.mark.parametrize(
    ("stated", "key"), [("turn_rate_relative", "turn_rate_rad_s"), ("turn_radius_m", "radius_m")]
)
def test_radius_and_rate_are_budgeted_as_a_slip_of_theirs_moves_the_values(stated, key) -> None:
    """About a point ahead, where a rate moves the velocity across too; no noise, no scatter."""
    turns = [turn(radius, drift, PUT_IN, sign) for radius in (3.0, 8.0)
             for drift in (-0.1, 0.0, 0.12) for sign in (1.0, -1.0)]  # fmt: skip

    def values(by: float) -> np.ndarray:
        slipped = [
            replace(
                one, **{key: getattr(one, key) * (1.0 + by) if "rate" in key else one.radius_m + by}
            )
            for one in turns
        ]
        fitted = fit_cycles(
            [turn_cycle(one, 0.5, body()).about(0.3) for one in slipped], NAMES, (0,)
        )
        return fitted.values

    cycles = [turn_cycle(one, 0.5, body()).about(0.3) for one in turns]
    fit = fit_cycles(cycles, NAMES, (0,), stated=StatedUncertainties(**{stated: 1.0}))
    (found,) = [one.dense(len(NAMES))[:, 0] for one in fit.uncertain.contributions
                if one.label == stated]  # fmt: skip
    shown = (values(1e-5) - values(-1e-5)) / 2e-5
    assert found == pytest.approx(shown, rel=1e-4, abs=1e-4 * np.abs(shown).max())


def test_a_midpoint_that_stands_elsewhere_is_budgeted_as_it_moves_the_values() -> None:
    """The hull's own point further astern than is believed: Newton's loads, and slower across."""
    circles = [(radius, drift, sign) for radius in (3.0, 8.0)
               for drift in (-0.1, 0.0, 0.12) for sign in (1.0, -1.0)]  # fmt: skip

    def fitted(astern_m: float, **stated: float):
        turns = [turn(radius, drift, PUT_IN, sign, astern_m) for radius, drift, sign in circles]
        cycles = [turn_cycle(one, 0.5, body()) for one in turns]
        return fit_cycles(cycles, tuple(PUT_IN), (0,), stated=StatedUncertainties(**stated))

    fit, by = fitted(0.0, midpoint_x_m=1.0), 1e-3
    (found,) = [one.dense(len(PUT_IN))[:, 0] for one in fit.uncertain.contributions
                if one.label == "midpoint_x_m"]  # fmt: skip
    shown = (fitted(by).values - fitted(-by).values) / (2.0 * by)
    assert np.abs(found) == pytest.approx(np.abs(shown), rel=1e-3, abs=1e-3 * np.abs(shown).max())
    assert np.sign(found @ shown) * (found @ shown) == pytest.approx(found @ found, rel=1e-3)


@pytest.mark.parametrize(
    ("key", "value"), [("radius_m", 0.0), ("turn_rate_rad_s", 0.0), ("u_force_n", 0.0)]
)
def test_what_is_no_circle_is_refused(key, value) -> None:
    given = {"radius_m": 3.0, "turn_rate_rad_s": 0.3, "u_force_n": 1.0} | {key: value}
    with pytest.raises(ConfigurationError, match=key):
        SteadyTurn(run="t", force_n=1.0, moment_n_m=1.0, u_moment_n_m=1.0, **given)
