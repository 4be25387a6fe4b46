"""What a wrong mass, lag or frequency does to a coefficient, from the formulas of one motion."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.cycle_trials import draw_cycles
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.strut_phasors import MOTION_ASKED
from analysis.ideal_rig import mass_matrix
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from tests.analysis.coefficients.ideal import (
    BODY,
    ECCENTRICITY_M,
    RESTORING,
    covariance,
    ideal_struts,
    net,
    pair,
    scattered,
)

FREQUENCY_HZ = 0.8
OMEGA = 2.0 * math.pi * FREQUENCY_HZ
HEAVE = SetPoint(FREQUENCY_HZ, ECCENTRICITY_M)


def solve(
    cycles: list[BodyCycle],
    form: Form = Form.SEAKEEPING,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008
) -> CycleFit:
    return linear_fit(cycles, form, stated).fit


def spread_of(fit: CycleFit, name: str) -> float:
    return float(fit.uncertain.standard_uncertainty[fit.names.index(name)])


def heave(stated: StatedUncertainties, name: str) -> float:
    return spread_of(solve([net(ideal_struts(HEAVE))], stated=stated), name)


# F/x = c - w^2 (m + a) + i w b with c = 6900, m = 70, a = 75, b = 190
STIFF = 6900.0 - OMEGA**2 * 145.0
CASES = [
    (StatedUncertainties(mass_kg=0.2), "a33", 0.2),
    (StatedUncertainties(mass_kg=0.2), "b33", 0.0),
    (StatedUncertainties(mass_kg=0.2), "a53", 0.2 * 0.02),
    (StatedUncertainties(cg_x_m=0.001), "a53", 70.0 * 0.001),
    (StatedUncertainties(lag_s=1e-3), "b33", abs(STIFF) * 1e-3),
    (StatedUncertainties(lag_s=1e-3), "a33", 190.0 * 1e-3),
    (StatedUncertainties(amplitude_relative=0.01), "b33", 1.90),
    (StatedUncertainties(amplitude_relative=0.01), "a33", abs(STIFF) / OMEGA**2 * 0.01),
    (StatedUncertainties(force_gain_relative=0.01), "b33", 1.90),
    (StatedUncertainties(restoring_relative=0.01), "a33", 69.0 / OMEGA**2),
    (StatedUncertainties(frequency_relative=0.01), "b33", 1.90),
    (StatedUncertainties(frequency_relative=0.01), "a33", 2.0 * 0.01 * abs(75.0 + 70.0)),
    (StatedUncertainties(speed_m_s=0.1), "a33", 0.0),
]


@pytest.mark.parametrize(("stated", "name", "expected"), CASES, ids=str)
def test_stated_uncertainty_of_pure_heave(
    stated: StatedUncertainties, name: str, expected: float
) -> None:
    assert heave(stated, name) == pytest.approx(expected, rel=1e-4, abs=1e-9)


def test_strut_phase_and_pitch() -> None:
    """Pitch: the moment's quadrature by an unnoticed lag, and inertia one to one."""
    run = net(ideal_struts(SetPoint(FREQUENCY_HZ, ECCENTRICITY_M, math.pi)))
    result = solve([run], stated=StatedUncertainties(inertia_kg_m2=0.3))
    assert spread_of(result, "a55") == pytest.approx(0.3, rel=1e-6)
    stiff = 2400.0 + BODY.mass_kg * 9.80665 * BODY.cg_z_m - OMEGA**2 * (27.5 + 22.0)
    lag = solve([run], stated=StatedUncertainties(lag_s=1e-3))
    assert spread_of(lag, "b55") == pytest.approx(abs(stiff) * 1e-3, rel=1e-4)


def test_strut_phase_turns_the_mean_motion_by_half_of_it() -> None:
    """Phi off by eps turns heave by eps/2 and brings -i eps x / (2 l) of pitch, 2 l = 1 m."""
    result = solve([net(ideal_struts(HEAVE))], stated=StatedUncertainties(strut_phase_rad=0.01))
    coupling = RESTORING[0, 1] - OMEGA**2 * 1.4
    expected = abs(STIFF / 2.0 - coupling) * 0.01 / OMEGA
    assert spread_of(result, "b33") == pytest.approx(expected, rel=1e-4)


def test_speed_acts_on_the_derivatives_of_rotation() -> None:
    """v = U pitch: Z_q off by Z_wdot dU, as b35 = B35 + U A33 has it."""
    result = solve(
        [net(ideal_struts(p, name=f"{k}")) for k, p in enumerate(pair())],
        Form.MANOEUVRING,
        stated=StatedUncertainties(speed_m_s=0.05),
    )
    assert spread_of(result, "Z_q") == pytest.approx(75.0 * 0.05, rel=1e-6)
    assert spread_of(result, "Z_w") == pytest.approx(0.0, abs=1e-6)


def test_mass_is_common_to_all_runs_and_does_not_average_out() -> None:
    one = heave(StatedUncertainties(mass_kg=0.2), "a33")
    runs = [net(ideal_struts(HEAVE, name=f"{k}")) for k in range(5)]
    many = solve(runs, stated=StatedUncertainties(mass_kg=0.2))
    assert spread_of(many, "a33") == pytest.approx(one, rel=1e-6)


def test_shares_add_up_and_name_the_greatest() -> None:
    generator = np.random.default_rng(1)
    run = net(scattered(ideal_struts(HEAVE, name="heave"), covariance(), 10, generator))
    stated = StatedUncertainties(mass_kg=1.0, lag_s=1e-4, amplitude_relative=0.001)
    result = solve([run], stated=stated)
    row = result.names.index("a33")
    parts = {one.label: (one.dense(4)[row] ** 2).sum() for one in result.uncertain.contributions}
    assert max(parts, key=lambda label: parts[label]) == "mass_kg"
    assert set(parts) == {"scatter of heave", "mass_kg", "lag_s", "amplitude_relative"}
    assert sum(parts.values()) == pytest.approx(spread_of(result, "a33") ** 2, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("form", list(Form))
def test_monte_carlo_beside_the_linear_budget(form: Form) -> None:
    generator = np.random.default_rng(2)
    runs = [
        net(scattered(ideal_struts(p, name=f"{k}"), covariance(), 60, generator))
        for k, p in enumerate(pair())
    ]
    stated = StatedUncertainties(
        mass_kg=0.1, lag_s=2e-4, amplitude_relative=0.002, frequency_relative=1e-4
    )
    fit = solve(runs, form, stated)
    drawn = np.concatenate([draw_cycles(fit, 5_000, (5, k)) for k in range(4)])
    linear = fit.uncertain.covariance()
    spread = fit.uncertain.standard_uncertainty
    np.testing.assert_allclose(drawn.std(axis=0), spread, rtol=0.04)
    np.testing.assert_allclose(drawn.mean(axis=0), fit.values, atol=0.05 * spread.max())
    correlation = linear / np.outer(spread, spread)
    np.testing.assert_allclose(np.corrcoef(drawn.T), correlation, atol=0.05)
    again = draw_cycles(fit, 5_000, (5, 0))
    np.testing.assert_array_equal(again, drawn[:5_000])


def test_every_stated_quantity_acts_on_something() -> None:
    struts = [ideal_struts(p, name=f"{k}") for k, p in enumerate(pair())]
    asked = [replace(one, flags=(MOTION_ASKED,)) for one in struts]
    runs = [net(run) for run in asked]
    for name in STATED:
        unseen = {"alignment_rad", "heel_rad", "roll_gauge_relative", "speed_age_s"}
        if name in {*unseen, "surge_gauge_relative"} or "turn" in name:
            continue  # act on means, X, heeled runs, circles and led carriages: none is here
        fit = solve(runs, Form.MANOEUVRING, stated=StatedUncertainties(**{name: 1e-3}))
        assert fit.uncertain.standard_uncertainty.max() > 1e-4, name


def test_digits_lost_at_low_frequency_are_said() -> None:
    """At 0.1 Hz the inertia is a small part of the restoring."""
    slow = SetPoint(0.1, ECCENTRICITY_M)
    result = linear_fit([net(ideal_struts(slow))], Form.SEAKEEPING, StatedUncertainties())
    omega = 2.0 * math.pi * 0.1
    part = omega**2 * 75.0 / 6900.0
    k = result.fit.names.index("a33")
    assert result.retained[k] == pytest.approx(part, rel=1e-6)
    (flag,) = [f for f in result.flags if f.channel == "a33"]
    assert flag.code == "digits_lost"
    assert f"{100 * part:.2g} %" in flag.message
    fast = linear_fit([net(ideal_struts(HEAVE))], Form.SEAKEEPING, StatedUncertainties())
    assert not [f for f in fast.flags if f.channel == "a33"]


def test_net_load_covariance_is_the_linear_map() -> None:
    """Loads on the hull by mapping against the same by hand: cov = J cov J^T."""
    run = net(scattered(ideal_struts(HEAVE), covariance(), 9, np.random.default_rng(0)))
    known = RESTORING + np.diag([0.0, BODY.mass_kg * 9.80665 * BODY.cg_z_m])
    known = known - OMEGA**2 * mass_matrix(BODY, Plane.VERTICAL)
    slope = np.hstack((np.kron(known, np.eye(2)), -np.eye(4)))
    gross = run.phasors.select(["translation 1", "rotation 1", "force 1", "moment 1"])
    expected = slope @ gross.real.covariance() @ slope.T
    hull = run.hull.phasors.select(["force 1", "moment 1"]).real.covariance()
    np.testing.assert_allclose(hull, expected, atol=1e-8 * np.abs(expected).max())
