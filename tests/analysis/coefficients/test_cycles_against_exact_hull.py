"""Cycles of exact rigs, up to 23 degrees: the hull's terms come back, in every arrangement."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import PLACES, Form, name_of
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.arrangement import Arrangement
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import HULLS, campaign, cycle_of
from tests.exact.hull import polynomial
from tests.exact.rigs import ARRANGEMENTS, exact_rig

SPEED_M_S, HERTZ, SMALL = 1.2, 0.4, 1e-5
ORDERS = 7  # of what is resolved; the terms' own sums are of the fourth order and below
EVERY = pytest.mark.parametrize(
    "arrangement", ARRANGEMENTS, ids=lambda one: "-".join(vars(one).values())
)


@pytest.mark.sample(7)
@pytest.mark.parametrize(
    ("plane", "floats"),
    [(Plane.HORIZONTAL, True), (Plane.VERTICAL, True), (Plane.VERTICAL, False)],
)
@EVERY
def test_every_term_comes_back(plane: Plane, floats: bool, arrangement: Arrangement) -> None:
    """In the vertical plane with a surface ship's restoring, or heavy and below the surface."""
    rigs = campaign(plane, arrangement, floats=floats)
    cycles = [cycle_of(rig, f"run {k}", ORDERS) for k, rig in enumerate(rigs)]
    fit = fit_cycles(cycles, tuple(HULLS[plane]), (0, 1, 2, 3))
    for name, put_in in HULLS[plane].items():
        assert fit[name] == pytest.approx(put_in, rel=1e-6, abs=1e-6), name


@pytest.mark.sample(12)
@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("form", Form)
@EVERY
def test_linear_coefficients_of_small_motions(
    plane: Plane, form: Form, arrangement: Arrangement
) -> None:
    """Closed form of the seakeeping one: a = A - s U B E / omega^2, b = B + s U A E."""
    letters = ("Z", "M", "w", "q") if plane is Plane.VERTICAL else ("Y", "N", "v", "r")
    terms = {
        f"{load}_{move}{dot}": HULLS[plane][f"{load}_{move}{dot}"]
        for load in letters[:2]
        for move in letters[2:]
        for dot in ("dot", "")
    }
    rigs = [
        exact_rig(
            plane, arrangement, rotation_rad=turn, sway_m=sway, speed_m_s=SPEED_M_S,
            frequency_hz=HERTZ,
        )
        for turn, sway in ((0.0, SMALL), (SMALL, 0.0), (SMALL, SMALL))
    ]  # fmt: skip
    hull = polynomial(terms)
    cycles = [
        cycle_of(
            replace(one, coordinates=one.coordinates[:2], hull=hull, body=one.body.afloat()),
            str(k),
            3,
        )
        for k, one in enumerate(rigs)
    ]
    fit = linear_fit(cycles, form, StatedUncertainties()).fit
    added, damping = (
        -np.array([[terms[f"{load}_{move}{dot}"] for move in letters[2:]] for load in letters[:2]])
        for dot in ("dot", "")
    )
    turned = np.array([[0.0, 1.0 if plane is Plane.VERTICAL else -1.0], [0.0, 0.0]])
    if form is Form.SEAKEEPING:
        square = (2.0 * np.pi * HERTZ) ** 2
        added, damping = (
            added - SPEED_M_S * damping @ turned / square,
            damping + SPEED_M_S * added @ turned,
        )
    sign = 1.0 if form is Form.SEAKEEPING else -1.0
    for place in PLACES:
        matrix = added if place.inertial else damping
        expected = sign * matrix[place.row, place.column]
        name = name_of(place, plane, form)
        assert fit[name] == pytest.approx(expected, rel=1e-6, abs=1e-6), name
