"""Runs of many lines on a hull with cubic damping, fitted whole and beside single sines.

The readings are the simulator's periodic steady state, which shares no equation with the fit.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_records import JOINT, LINEAR
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.line_cycles import by_lines
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.recommendation import table
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.response.multisine import multisine
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic
from sim.model.water.radiation import Radiation
from sim.rig import horizontal_rig
from sim.run import steady_run

CUBIC = 800.0
TRUE = {
    "Y_v": -120.0, "Y_vdot": -62.0, "Y_r": 15.0, "Y_rdot": -2.0, "Y_vvv": -CUBIC,
    "N_v": -40.0, "N_vdot": -2.0, "N_r": -35.0, "N_rdot": -18.0, "N_vvv": 0.0,
}  # fmt: skip
SCATTER = (1e-7, 1e-7, 2e-4, 2e-4)  # of phasors of both struts, m, and both gauges, N
ORDERS = (1, 3, 5, 7, 9)
LINES = multisine(ORDERS, 1.0 / np.array(ORDERS), (0.0, math.pi))  # sway and yaw in turn


def _with_scatter(phasors: Phasors, name: str) -> Phasors:
    """Return exact phasors that count as known to a scatter of 20 degrees of freedom."""
    size = np.tile(np.repeat(SCATTER, 2), len(phasors.names) // 4)
    source = Contribution(f"scatter: {name}", 20.0, np.arange(size.size), np.diag(size))
    return replace(phasors, real=UncertainValues(phasors.real.values, (source,)))


@cache
def cycle(
    name: str, point: SetPoint, cubic: float = CUBIC, memory: Radiation | None = None
) -> BodyCycle:
    rig = replace(horizontal_rig().ideal(), radiation=memory)
    if cubic:
        law = Acting(Cubic(cubic_n_s3_m3=cubic), Point.THROUGH_WATER, in_water=True)
        rig = replace(rig, forces=(law,))
    orders = 2 * max(line.order for line in point.every_line) if point.lines else 7
    steady = steady_run(rig, point, orders=max(12, orders))
    channels = (*DISPLACEMENTS, *FORCES)
    values = np.stack([1j * steady.referred(f"recorded_{one}")[: orders + 1] for one in channels])
    values[:, 0] = values[:, 0].imag  # H[0] = i A0
    units = ("m", "m", "N", "N") * (orders + 1)
    phasors = _with_scatter(Phasors.of(labels(channels, orders), units, values.T.ravel()), name)
    struts = StrutCycle(name, rig.oscillator, point, point.frequency_hz, phasors, orders, True)
    return struts.model().without(rig.body)


@pytest.mark.slow
def test_one_run_tells_ten_coefficients_of_a_hull_that_is_not_linear() -> None:
    many = cycle("many", SetPoint(0.15, 0.15, lines=LINES))
    fit = fit_cycles([many], tuple(TRUE))
    for name, value in TRUE.items():
        assert fit[name] == pytest.approx(value, rel=0.01, abs=0.05), name


def test_it_is_fitted_with_single_sines() -> None:
    several = [
        cycle("many", SetPoint(0.15, 0.15, lines=LINES)),
        cycle("sway", SetPoint(0.5, 0.05)),
        cycle("yaw", SetPoint(0.5, 0.05, strut_phase_rad=math.pi)),
    ]
    fit = fit_cycles(several, tuple(TRUE))
    for name, value in TRUE.items():
        assert fit[name] == pytest.approx(value, rel=0.01, abs=0.05), name
    assert fit.data[0] == 2 * 9 + 2 * 2 * 3  # harmonics 1 to 9, and 1, 2, 3 of each single sine


def test_a_campaign_fits_them_together_where_lines_alone_would_be_wrong() -> None:
    many, sway = (
        cycle("many", SetPoint(0.15, 0.15, lines=LINES)),
        cycle("sway", SetPoint(0.5, 0.05)),
    )
    found = campaign_coefficients([many, sway])
    told = {row["name"]: row for row in table(found) if row["recommended"]}
    assert {told[name]["method"] for name in told if name.startswith("Y")} == {JOINT}
    for name in ("Y_v", "Y_vdot", "Y_r", "Y_rdot", "Y_vvv"):
        apart = abs(told[name]["value"] - TRUE[name])
        assert apart < 2.0 * told[name]["half_width"] + 1e-3 * abs(TRUE[name]), name
    assert told["Y_v"]["runs"] == ("many", "sway")
    assert math.isnan(told["Y_v"]["frequency_hz"])
    alone = found.values[found.rows("Y_v", method=LINEAR)]
    assert (alone < -121.0).all(), "each line took part of the cube for damping"


def test_a_linear_hull_is_told_line_by_line() -> None:
    many = cycle("many", SetPoint(0.15, 0.15, lines=LINES), cubic=0.0)
    found = campaign_coefficients([many])
    assert not found.rows(method=JOINT)
    for name, value in TRUE.items():
        if not name.endswith("vvv"):
            rows = found.rows(name, method=LINEAR)
            assert found.values[rows] == pytest.approx(value, rel=0.01, abs=0.1), name


def test_a_memory_is_not_taken_for_what_is_not_linear() -> None:
    """K(s) = c/(s + 2): in sway damping 2 c/(4 + w^2) and added mass -c/(4 + w^2)."""
    gain = 120.0
    memory = Radiation(
        np.zeros((2, 2)), np.array([[-2.0]]), np.array([[gain, 0.0]]), np.array([[1.0], [0.0]])
    )
    found = campaign_coefficients([cycle("many", SetPoint(0.15, 0.15, lines=LINES), 0.0, memory)])
    assert not found.rows("Y_v", method=JOINT)
    assert all("no form describes" in one.message for one in found.choices if one.load == "force")
    for k in found.rows("Y_v", method=LINEAR):
        omega = 2.0 * math.pi * found.entries[k].frequency_hz
        damping = 120.0 + 2.0 * gain / (4.0 + omega**2)
        assert found.values[k] == pytest.approx(-damping, rel=0.01)


def test_lines_alone_take_the_cube_for_damping() -> None:
    """By hand for one line: 3/4 B V^2 of it, and 3/2 B of each other line's V^2."""
    lines = multisine((3, 5), np.array([1.0, 0.6]))
    point = SetPoint(0.1, 0.12, lines=lines)
    first, second = by_lines(cycle("sway", point))
    speeds = [2.0 * math.pi * 0.1 * one.order * 0.12 * one.share for one in lines]
    for own, other, of in ((first, 1, 0), (second, 0, 1)):
        found = fit_cycles([own], ("Y_v", "Y_vdot"), (1,))
        more = CUBIC * (0.75 * speeds[of] ** 2 + 1.5 * speeds[other] ** 2)
        assert found["Y_v"] == pytest.approx(-120.0 - more, rel=2e-3)
        assert found["Y_vdot"] == pytest.approx(-62.0, rel=2e-3)


def test_a_run_resolved_too_low_is_refused() -> None:
    many = cycle("many", SetPoint(0.15, 0.1, lines=LINES), cubic=0.0)
    with pytest.raises(DataError, match="resolve as many"):
        by_lines(replace(many, lines=(3, 41)))
