"""Cubic, quadratic, cross and surge terms put into the simulator, or into exact cycles."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.cycle_fit import FIRST, HIGHER, QUASI_STEADY, STATIC, fit_cycles
from analysis.coefficients.cycle_trials import cycle_trials
from analysis.coefficients.normalisation import mmg, prime
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.coefficients.terms import term_of
from benchmarks.coefficients_campaigns import (
    CUBIC,
    HORIZONTAL,
    SURGE_TRUTH,
    Made,
    Scatter,
    amplitudes,
    made_up,
    without_incidence,
)
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from sim.model.hull import HullCoefficients
from sim.model.water.force_laws import CrossFlow
from sim.rig import SimulatedRig, horizontal_rig
from tests.analysis.coefficients.cycles import simulated, zeroed
from tests.analysis.manoeuvring.published import Published, kcs, kvlcc2

ALL = {**HORIZONTAL, **CUBIC}
ORDERS = 9  # of the motion: what lies above them is rounding
WATER = HullCoefficients(
    added_mass=((62.0, 2.0), (2.0, 18.0)), damping=((120.0, -15.0), (40.0, 35.0))
)
RIG = replace(
    horizontal_rig().ideal(),
    water=WATER,
    cross_flow=CrossFlow(cubic=((900.0, -250.0, 180.0, -20.0), (-90.0, 260.0, -70.0, 40.0))),
)


def runs(rig: SimulatedRig = RIG, **options: object):  # type: ignore[no-untyped-def]
    return [simulated(rig, p, name=n, **options) for n, p in amplitudes()]  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def cycles():  # type: ignore[no-untyped-def]
    return runs(harmonics=5)


@pytest.mark.parametrize("orders", [HIGHER, (1, 3), FIRST])
def test_cubic_and_cross_terms_through_the_simulator(cycles, orders: tuple[int, ...]) -> None:  # type: ignore[no-untyped-def]
    fit = fit_cycles(cycles, tuple(ALL), orders)
    for name, put_in in ALL.items():
        assert fit[name] == pytest.approx(put_in, rel=2e-4, abs=2e-3), name


def test_a_single_run_by_its_third_harmonic(cycles) -> None:  # type: ignore[no-untyped-def]
    names = ("Y_vdot", "Y_v", "Y_vvv", "N_vdot", "N_v", "N_vvv")
    fit = fit_cycles([cycles[1]], names, (1, 3))
    for name in names:
        assert fit[name] == pytest.approx(ALL[name], rel=2e-4), name


def test_quadratic_terms_through_the_simulator() -> None:
    rig = replace(
        RIG, cross_flow=CrossFlow(quadratic=((250.0, 60.0, 40.0, 9.0), (-30.0, 8.0, 25.0, 12.0)))
    )
    truth = {"Y_v|v|": -250.0, "Y_v|r|": -60.0, "Y_r|v|": -40.0, "Y_r|r|": -9.0,
             "N_v|v|": 30.0, "N_v|r|": -8.0, "N_r|v|": -25.0, "N_r|r|": -12.0}  # fmt: skip
    fit = fit_cycles(runs(rig, harmonics=5), (*HORIZONTAL, *truth), (1, 3))
    for name, put_in in truth.items():
        assert fit[name] == pytest.approx(put_in, rel=1e-3, abs=0.02), name


def test_quasi_steady_and_higher_order_of_exact_cycles() -> None:
    """Drift brings the means in: the quasi-steady fit finds the same as the one with all orders."""
    points = [(n, p, 0.0) for n, p in amplitudes()] + [
        (f"drift {a}", amplitudes()[4][1], a) for a in (-0.15, 0.1, 0.2)
    ]
    found = [made_up(p, Made(ALL, drift_rad=a, orders=ORDERS), n) for n, p, a in points]
    for orders in (QUASI_STEADY, (0, 1, 2, 3)):
        fit = fit_cycles(found, tuple(ALL), orders)
        for name, put_in in ALL.items():
            assert fit[name] == pytest.approx(put_in, rel=1e-7), (name, orders)


def test_yaw_with_drift_tells_the_cross_terms() -> None:
    turn = without_incidence(0.3, 1.2)
    points = [SetPoint(0.3, e, turn, 1.2) for e in (0.1, 0.2)]
    sway = [SetPoint(0.3, e, 0.0, 1.2) for e in (0.06, 0.2)]
    straight = [
        made_up(p, Made(ALL, orders=ORDERS), f"{k}") for k, p in enumerate((*points, *sway))
    ]
    drifting = [
        made_up(p, Made(ALL, drift_rad=a, orders=ORDERS), f"drift {a} {k}")
        for k, p in enumerate(points)
        for a in (0.07, 0.28)
    ]
    fit = fit_cycles([*straight, *drifting], tuple(ALL), HIGHER)
    for name in CUBIC:
        assert fit[name] == pytest.approx(ALL[name], rel=1e-7), name
    with pytest.raises(DataError, match="runs in yaw with drift"):
        fit_cycles(straight, tuple(ALL), HIGHER)


def test_surge_forces_less_the_models_own() -> None:
    made = Made(ALL, surge=SURGE_TRUTH, orders=ORDERS)
    found = [made_up(p, made, n) for n, p in amplitudes()]
    fit = fit_cycles(found, tuple(SURGE_TRUTH), (0, 1, 2))
    for name, put_in in SURGE_TRUTH.items():
        assert fit[name] == pytest.approx(put_in, rel=1e-9), name
    assert fit.uncertain.values[0] == fit["X_0"]
    without = [made_up(p, Made(ALL), n) for n, p in amplitudes()]
    with pytest.raises(DataError, match="the channel force_x, which sway"):
        fit_cycles(without, ("X_vv",), (2,))


def test_static_drift() -> None:
    truth = {"Y_0": 1.5, "Y_v": -120.0, "Y_vvv": -900.0}
    still = SetPoint(0.0, 0.0, 0.0, 1.2)
    angles = (-0.2, -0.1, 0.0, 0.1, 0.2)
    found = [made_up(still, Made(truth, drift_rad=a, orders=0), f"{a}") for a in angles]
    fit = fit_cycles(found, tuple(truth), STATIC)
    for name, put_in in truth.items():
        assert fit[name] == pytest.approx(put_in, rel=1e-9), name


# Mariner (Chislett and Stroem-Tejsen), prime system, x 1e-5; Y_r and N_r hold m and m x_G.
MARINER = {"Y_vdot": -748.0, "Y_rdot": -9.354, "N_vdot": 4.646, "N_rdot": -43.8,
           "Y_v": -1160.0, "Y_r": -499.0 + 798.0, "N_v": -264.0, "N_r": -166.0 - 798.0 * 0.023,
           "Y_vvv": -8078.0, "Y_vvr": 15356.0, "N_vvv": 1636.0, "N_vvr": -5483.0}  # fmt: skip


def put_in_prime(values: dict[str, float], factor, quadratic: bool = False) -> SimulatedRig:  # type: ignore[no-untyped-def]
    def si(name: str) -> float:
        return -values.get(name, 0.0) * factor(term_of(name, Plane.HORIZONTAL))

    return replace(
        horizontal_rig().ideal(),
        water=HullCoefficients(
            added_mass=((si("Y_vdot"), si("Y_rdot")), (si("N_vdot"), si("N_rdot"))),
            damping=((si("Y_v"), si("Y_r")), (si("N_v"), si("N_r"))),
        ),
        cross_flow=CrossFlow(
            cubic=tuple(
                tuple(si(f"{load}_{term}") for term in ("vvv", "vvr", "vrr", "rrr"))
                for load in "YN"
            )  # type: ignore[arg-type]
        ),
    )


def test_mariners_cubic_derivatives_put_in_come_out_in_the_prime_system() -> None:
    system = prime(2.0, 1.0, 1000.0)
    rig = put_in_prime({name: value * 1e-5 for name, value in MARINER.items()}, system.term_factor)
    sizes = [(f"{k}", SetPoint(0.2, e, phase, 1.0)) for k, (e, phase) in enumerate(
        [(0.05, 0.0), (0.15, 0.0), (0.05, math.pi), (0.1, math.pi), (0.12, 2.0)])]  # fmt: skip
    found = [simulated(rig, p, name=n, harmonics=5) for n, p in sizes]
    fit = fit_cycles(found, tuple(MARINER), (1, 3))
    for name, value in MARINER.items():
        prime_value = fit[name] / system.term_factor(term_of(name, Plane.HORIZONTAL)) * 1e5
        assert prime_value == pytest.approx(value, rel=2e-4, abs=0.02), name


@pytest.mark.parametrize("ship", [kvlcc2, kcs])
def test_a_published_ship_comes_out_in_the_mmg_system(ship: Published) -> None:
    length = 2.9091
    system = mmg(length, ship.D * length / ship.L, 0.76, 1000.0)
    put_in = {name: one for name, one in ship.HULL.items() if name[0] in "YN"}
    put_in |= {"Y_vdot": -ship.M_Y, "N_rdot": -ship.J_Z}
    rig = put_in_prime(put_in, system.term_factor)
    sizes = [(f"{k}", SetPoint(0.2, e, phase, 0.76)) for k, (e, phase) in enumerate(
        [(0.05, 0.0), (0.15, 0.0), (0.05, math.pi), (0.1, math.pi), (0.12, 2.0)])]  # fmt: skip
    found = [simulated(rig, p, name=n, harmonics=5) for n, p in sizes]
    fit = fit_cycles(found, tuple(put_in), (1, 3))
    for name, value in put_in.items():
        own = fit[name] / system.term_factor(term_of(name, Plane.HORIZONTAL))
        assert own == pytest.approx(value, rel=5e-4, abs=2e-5), name


@pytest.mark.slow
def test_scatter_of_fits_is_what_their_budget_says() -> None:
    generator = np.random.default_rng(4)
    names = ("Y_vdot", "Y_v", "Y_vvv")
    points, scatter = amplitudes()[:3], Scatter(periods=40)
    widths, values = [], []
    for _ in range(60):
        cycles = [made_up(p, Made(ALL), n, generator, scatter) for n, p in points]
        fit = fit_cycles(cycles, names)
        values.append(fit.values)
        widths.append(fit.uncertain.standard_uncertainty)
    ratio = np.std(values, axis=0, ddof=1) / np.mean(widths, axis=0)
    np.testing.assert_allclose(ratio, 1.0, atol=0.3)  # 60 campaigns leave 0.09 open


def test_monte_carlo_beside_the_budget_of_a_fit() -> None:
    generator = np.random.default_rng(4)
    cycles = [
        made_up(p, Made(ALL), n, generator, Scatter(periods=200)) for n, p in amplitudes()[:3]
    ]
    stated = StatedUncertainties(mass_kg=0.1, lag_s=1e-4, amplitude_relative=1e-3)
    fit = fit_cycles(cycles, ("Y_vdot", "Y_v", "Y_vvv"), stated=stated)
    drawn = cycle_trials(fit, 4000, seed=1)
    ratio = drawn.standard_uncertainty / fit.uncertain.standard_uncertainty
    np.testing.assert_allclose(ratio, 1.0, atol=0.05)
    half = (drawn.high - drawn.low) / 2.0
    np.testing.assert_allclose(half, fit.uncertain.half_width(), rtol=0.06)
    np.testing.assert_array_equal(cycle_trials(fit, 4000, seed=1).low, drawn.low)


def test_a_stated_mass_moves_only_what_it_should() -> None:
    sway = [made_up(p, Made(ALL), n) for n, p in amplitudes()[:3]]
    names = ("Y_vdot", "Y_v", "Y_vvv")
    fit = fit_cycles(sway, names, stated=StatedUncertainties(mass_kg=0.1, alignment_rad=1e-3))
    spread = dict(zip(fit.names, fit.uncertain.standard_uncertainty, strict=True))
    assert spread["Y_vdot"] == pytest.approx(0.1, rel=1e-6)
    assert spread["Y_vvv"] == pytest.approx(0.0, abs=0.1)
    drifting = [made_up(p, Made(ALL, drift_rad=0.1), n) for n, p in amplitudes()]
    turned = fit_cycles(drifting, tuple(ALL), stated=StatedUncertainties(alignment_rad=1e-3))
    spread = dict(zip(turned.names, turned.uncertain.standard_uncertainty, strict=True))
    # v0 = -U sin(drift): a heading wrong by d is a Y_v wrong by 2 * 3 Y_vvv v0 U d, at the least
    assert spread["Y_v"] > 0.05
    assert spread["Y_vdot"] < 1e-2 * spread["Y_v"]


def test_one_amplitude_and_one_harmonic_do_not_tell_cubic_from_linear() -> None:
    one = made_up(SetPoint(0.3, 0.1, 0.0, 1.2), Made(ALL), "sway")
    with pytest.raises(DataError, match=r"Y_v and Y_vvv cannot be told apart from sway .*amplitud"):
        fit_cycles([one], ("Y_v", "Y_vvv"), FIRST)
    with pytest.raises(DataError, match="Y_r cannot be determined from sway: nothing there moves"):
        fit_cycles([made_up(SetPoint(0.3, 0.1), Made(ALL), "sway")], ("Y_v", "Y_r"), FIRST)


def test_cycles_that_do_not_belong_together() -> None:
    one = made_up(SetPoint(0.3, 0.1, 0.0, 1.2), Made(ALL, orders=1), "sway")
    with pytest.raises(ConfigurationError, match="two runs are called 'sway'"):
        fit_cycles([one, one], ("Y_v",), FIRST)
    with pytest.raises(ConfigurationError, match="resolved up to harmonic 1, 3 is needed"):
        fit_cycles([one], ("Y_v",), HIGHER)
    other = replace(zeroed(one), name="other", half_spacing_m=0.6)
    with pytest.raises(ConfigurationError, match=r"other has half_spacing_m = 0\.6, sway 0\.5"):
        fit_cycles([one, other], ("Y_v",), FIRST)
