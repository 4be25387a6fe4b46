"""Static drift against hull forces written here: the form found, and what a misfit does."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.campaign_nonlinear import STATIC_DRIFT
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import BOTH, CUBIC, LINEAR_FORM, QUADRATIC
from analysis.coefficients.phasors import Phasors
from analysis.kinematics.body_frame import CHANNELS, UNITS
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.single_row import single_row
from tests.analysis.coefficients.sources import of_covariance

SPEED_M_S = 1.2
Y_V, N_V = -120.0, -40.0
NOISE_N = 0.02  # standard deviation of a run's mean force; of the moment a third of it
ANGLES_DEG = (-12.0, -9.0, -6.0, -3.0, 0.0, 3.0, 6.0, 9.0, 12.0)
Hull = Callable[[float], float]

HULLS: dict[str, Hull] = {
    LINEAR_FORM: lambda v: Y_V * v,
    CUBIC: lambda v: Y_V * v - 900.0 * v**3,
    QUADRATIC: lambda v: Y_V * v - 300.0 * v * abs(v),
    BOTH: lambda v: Y_V * v - 900.0 * v**3 - 300.0 * v * abs(v),
}


def towed(
    hull: Hull,
    angles_deg: tuple[float, ...] = ANGLES_DEG,
    seed: int = 1,
    between_n: float = 0.0,
) -> CampaignCoefficients:
    """Coefficients of tows whose struts hold the model against the hull's force.

    Runs repeat within ``between_n``, which no run's own scatter tells of.
    """
    generator = np.random.default_rng(seed)
    noise = np.array([0.0, 0.0, NOISE_N, NOISE_N / 3.0])
    spread = np.zeros(12)
    spread[8::2] = noise[2:]
    cycles = []
    for k, angle in enumerate(np.radians(angles_deg)):
        v = -SPEED_M_S * math.sin(angle)
        u = SPEED_M_S * math.cos(angle)
        held = np.array([0.0, 0.0, -hull(v), -N_V * v]) + noise * generator.normal(size=4)
        held[2] += between_n * generator.normal()
        struts = np.array([*held[:2], u, v, *held[2:]])
        phasors = Phasors.of(
            labels(CHANNELS[:-1], 0),
            UNITS[:-1],
            struts.astype(np.complex128),
            (of_covariance(f"run {k}", np.diag(spread**2), 50.0),),
        )
        drifting = {"drift_rad": float(angle), "mean_known": True}
        cycles.append(
            BodyCycle(f"drift {k}", Plane.HORIZONTAL, 0.5, 0.0, SPEED_M_S, phasors, 0, **drifting)
        )
    return campaign_coefficients(cycles, Request())


def slope(found: CampaignCoefficients) -> tuple[float, float, float]:
    """Value, half-width and misfit of Y_v."""
    row = single_row(found, "Y_v", method=STATIC_DRIFT)
    return float(found.values[row]), float(found.half_widths[row]), found.entries[row].misfit


@pytest.mark.parametrize("form", HULLS)
def test_the_form_of_the_hull_is_named_and_its_slope_found(form: str) -> None:
    found = towed(HULLS[form])
    force, moment = found.choices
    assert (force.verdict, force.fitted, moment.fitted) == (form, form, LINEAR_FORM)
    value, half_width, misfit = slope(found)
    assert abs(value - Y_V) < 1.5 * half_width < 2.0
    assert 0.2 < misfit < 2.0


def test_a_hull_that_no_form_describes_widens_the_interval_and_is_named() -> None:
    """A corner that none of the forms has: the boundary layer separates beyond 5 degrees."""

    def corner(v: float) -> float:
        return Y_V * v - 600.0 * math.copysign(max(abs(v) - 0.1, 0.0), v)

    found = towed(corner)
    value, half_width, misfit = slope(found)
    assert misfit > 10.0
    assert abs(value - Y_V) < 1.5 * half_width
    row = single_row(found, "Y_v", method=STATIC_DRIFT)
    largest, share = next(iter(found.uncertain.shares(row).items()))
    assert largest.startswith("misfit of the force, static drift")
    assert share > 0.9
    assert "no form describes these runs" in found.choices[0].message


@pytest.mark.slow
@pytest.mark.parametrize("between_n", [0.0, 30.0 * NOISE_N])
def test_intervals_hold_the_slope_as_often_as_they_say(between_n: float) -> None:
    inside = 0
    for seed in range(60):
        value, half_width, _ = slope(towed(HULLS[QUADRATIC], seed=seed, between_n=between_n))
        inside += abs(value - Y_V) < half_width
    assert inside >= 51, "57 expected; fewer than 51 come less than once in 100"


def test_two_angles_make_a_line_and_say_that_no_other_form_was_judged() -> None:
    found = towed(HULLS[LINEAR_FORM], (0.0, 6.0))
    value, half_width, misfit = slope(found)
    assert abs(value - Y_V) < 1.5 * half_width < 2.0
    assert math.isnan(misfit)
    assert found.choices[0].fitted == LINEAR_FORM
    assert "too few runs" in found.choices[0].message


def test_one_angle_tells_no_slope_and_says_what_would() -> None:
    found = towed(HULLS[LINEAR_FORM], (0.0,))
    told = {one.name: one.message for one in found.missing}
    assert "drift angle" in told["Y_v"]
