"""Runs as believed against runs made sample by sample, and against the analysis that reads them."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.design.belief import ORDERS, Belief, believed_cycles
from benchmarks.coefficients_campaigns import (
    BODY,
    CUBIC,
    HORIZONTAL,
    RESTORING,
    VERTICAL,
    Made,
    made_up,
)
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint

POINTS = [
    SetPoint(0.3, 0.1, 1.8, 1.2),
    SetPoint(0.2, 0.06, 0.0, 0.8, drift_rad=0.1),
    SetPoint(0.5, 0.02, 3.0, 0.0),
]


@pytest.mark.parametrize("plane", Plane)
def test_motion_and_loads_are_those_of_the_terms(plane: Plane) -> None:
    flat = plane is Plane.HORIZONTAL
    truth = {**HORIZONTAL, **CUBIC} if flat else VERTICAL
    restoring = np.zeros((2, 2)) if flat else RESTORING
    belief = Belief(HORIZONTAL_1963 if flat else VERTICAL_1963, BODY, truth, restoring=restoring)
    found = believed_cycles(["a", "b", "c"], POINTS, belief)
    for one, point in zip(found, POINTS, strict=True):
        made = Made(truth, plane, point.drift_rad, orders=ORDERS, restoring=restoring)
        exact = made_up(replace(point, drift_rad=0.0), made, one.name).hull.phasors.values
        assert np.abs(one.hull.phasors.values - exact).max() < 1e-11 * np.abs(exact).max()


def test_the_seakeeping_form_comes_back_at_forward_speed() -> None:
    values = {"a33": 75.0, "b33": 190.0, "a53": 3.0, "b53": -12.0,
              "a35": 5.0, "b35": 80.0, "a55": 22.0, "b55": 55.0}  # fmt: skip
    belief = Belief(VERTICAL_1963, BODY, values, Form.SEAKEEPING, RESTORING)
    points = [SetPoint(0.6, 0.01, 0.0, 1.2), SetPoint(0.6, 0.01, 2.0, 1.2)]
    cycles = believed_cycles(["a", "b"], points, belief)
    fit = linear_fit(cycles, Form.SEAKEEPING, StatedUncertainties()).fit
    found = dict(zip(fit.names, fit.values, strict=True))
    assert found == pytest.approx(values, rel=2e-3, abs=2e-2)  # the load at 1 cm is not linear
