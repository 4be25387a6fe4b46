"""Gains, lags, filters, cross-talk and offsets that were put on the forces are taken out again."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.corrections import (
    AmplifierFilter,
    Delay,
    response_at,
    zero_at,
    zero_reading,
)
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.recording import Recording
from hardware.description.channels import FORCE_AFT, FORCE_FORE, FORCES
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.setpoint import Medium, SetPoint
from tests.analysis.coefficients.ideal import (
    ECCENTRICITY_M,
    READ,
    SMALL,
    covariance,
    ideal_struts,
    net,
    scattered,
    with_factors,
)
from tests.analysis.coefficients.sources import scattering

HEAVE = SetPoint(0.8, ECCENTRICITY_M)
OMEGA = 2.0 * math.pi * 0.8
AIR = replace(HEAVE, medium=Medium.AIR)


def solve(cycles: list[BodyCycle]) -> CycleFit:
    return linear_fit(cycles, Form.SEAKEEPING, StatedUncertainties()).fit


@pytest.mark.parametrize(
    "response",
    [
        Delay(0.004),
        AmplifierFilter(10.0),
        AmplifierFilter(10.0, 4),
        AmplifierFilter(8.0, 4, "bessel"),
        Delay(0.0, 1.03),
    ],
    ids=str,
)
def test_a_known_response_is_taken_out(response) -> None:  # type: ignore[no-untyped-def]
    clean = ideal_struts(HEAVE)
    factor = response_at(response, OMEGA)
    measured = with_factors(clean, factor, factor)
    again = measured.without_response(dict.fromkeys(FORCES, response))
    np.testing.assert_allclose(again.phasors.values, clean.phasors.values, rtol=1e-13)
    assert abs(solve([net(measured)])["b33"] - 190.0) > 1e-3
    assert solve([net(again)])["b33"] == pytest.approx(190.0, rel=1e-12)


def test_filters_against_their_formulas() -> None:
    assert response_at(AmplifierFilter(10.0), OMEGA) == pytest.approx(
        1.0 / (1.0 + 0.08j), rel=1e-12
    )
    assert response_at(Delay(0.01), OMEGA) == pytest.approx(np.exp(-0.01j * OMEGA))
    half_power = abs(response_at(AmplifierFilter(10.0, 4, "bessel"), 20.0 * math.pi))
    assert half_power == pytest.approx(0.5**0.5, rel=1e-6)
    for kind, lag_s in (("butterworth", 0.0416), ("bessel", 0.0336)):  # effect A1's catalogue
        lag = -np.angle(response_at(AmplifierFilter(10.0, 4, kind), 0.01)) / 0.01
        assert lag == pytest.approx(lag_s, abs=5e-5)


def test_systems_of_python_control_are_responses() -> None:
    control = pytest.importorskip("control")
    cutoff = 20.0 * math.pi
    system = control.TransferFunction([cutoff], [1.0, cutoff])
    assert response_at(system, OMEGA) == pytest.approx(response_at(AmplifierFilter(10.0), OMEGA))
    sampled = control.TransferFunction([0.5, 0.5], [1.0, 0.0], 0.005)  # mean of two samples
    expected = (1.0 + np.exp(-0.005j * OMEGA)) / 2.0
    assert response_at(sampled, OMEGA) == pytest.approx(expected)


def test_a_lag_left_in_is_the_closed_form() -> None:
    """b_app = b + tau (M w^2 - c): effects A1, to first order in w tau."""
    late = with_factors(ideal_struts(HEAVE), *2 * [complex(np.exp(-1e-4j * OMEGA))])
    expected = 190.0 + 1e-4 * (145.0 * OMEGA**2 - 6900.0)
    assert solve([net(late)])["b33"] == pytest.approx(expected, abs=1e-4)


def test_a_channel_that_lets_nothing_through_is_refused() -> None:
    with pytest.raises(DataError, match=r"force_aft lets 0\.0"):
        ideal_struts(HEAVE).without_response({"force_aft": AmplifierFilter(0.05)})
    with pytest.raises(ConfigurationError, match="no phasor 'force_x 0'"):
        ideal_struts(HEAVE).without_response({"force_x": Delay(0.1)})
    with pytest.raises(ConfigurationError, match="known are butterworth"):
        AmplifierFilter(10.0, 2, "elliptic")


@given(st.lists(st.floats(0.9, 1.1), min_size=2, max_size=2),
       st.lists(st.floats(-0.05, 0.05), min_size=2, max_size=2))  # fmt: skip
def test_cross_talk_is_taken_out(gains: list[float], talk: list[float]) -> None:
    sensitivity = np.array([[gains[0], talk[0]], [talk[1], gains[1]]])
    clean = ideal_struts(HEAVE)
    whole = np.eye(len(READ))
    for order in (2, 6):  # where the gauges stand
        whole[order : order + 2, order : order + 2] = sensitivity
    measured = replace(clean, phasors=clean.phasors.mapped(whole))
    again = measured.calibrated(np.linalg.inv(sensitivity))
    np.testing.assert_allclose(again.phasors.values, clean.phasors.values, rtol=1e-12, atol=1e-12)


def test_a_singular_calibration_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="not singular"):
        ideal_struts(HEAVE).calibrated(np.ones((2, 2)))


def zero_run(name: str, aft: float, fore: float, seed: int) -> Recording:
    noise = 0.1 * np.random.default_rng(seed).standard_normal((2, 4000))
    values = np.array([[aft], [fore]]) + noise
    return Recording(name, (FORCE_AFT, FORCE_FORE), values, 200.0)


def test_zero_runs_are_interpolated_in_time() -> None:
    before = zero_reading(zero_run("before", 1.0, -2.0, 1))
    after = zero_reading(zero_run("after", 2.0, -2.0, 2))
    offsets = zero_at(before, after, 0.25)
    np.testing.assert_allclose(offsets.values.real, [1.25, -2.0], atol=0.01)
    spread = offsets.standard_uncertainty.real
    white = 0.1 / math.sqrt(4000) * math.hypot(0.75, 0.25)
    np.testing.assert_allclose(spread, white, rtol=0.6)
    means = np.where([name in ("force_aft 0", "force_fore 0") for name in READ], 7.0, 0.0)
    read = ideal_struts(HEAVE)
    read = replace(read, phasors=scattering(read.phasors, values=read.phasors.values + means))
    left = read.without_zero(offsets).phasors.values - read.phasors.values
    np.testing.assert_allclose(left[2:4], -offsets.values)
    np.testing.assert_array_equal(np.delete(left, [2, 3]), 0.0)


def test_zero_runs_that_cannot_serve() -> None:
    gap = zero_run("gap", 0.0, 0.0, 4)
    gap.samples[0:1, 0:1][0, 0] = np.nan  # type: ignore[index]
    with pytest.raises(DataError, match="1 of them missing"):
        zero_reading(gap)


def test_referred_to_its_own_motion_against_trials() -> None:
    """The covariance after a rotation by the data's own angle is that of rotated draws."""
    generator = np.random.default_rng(8)
    run = scattered(ideal_struts(HEAVE), covariance() * 25.0, 50, generator)
    first = run.phasors.select(READ[4:])
    turned = scattering(first, *first.real.contributions, values=first.values * np.exp(0.7j))
    referred = turned.referred_to("displacement_aft 1")
    assert referred["displacement_aft 1"].imag == pytest.approx(0.0, abs=SMALL * 1e-15)
    spread = referred.standard_uncertainty
    assert spread[0].imag == pytest.approx(0.0, abs=SMALL * 1e-12)
    root = np.linalg.cholesky(turned.real.covariance())
    draws = generator.standard_normal((4000, 8)) @ root.T
    values = turned.values + draws[:, 0::2] + 1j * draws[:, 1::2]
    own = values * np.exp(-1j * np.angle(values[:, :1]))
    np.testing.assert_allclose(spread[2:].real, own.real.std(axis=0)[2:], rtol=0.05)
    np.testing.assert_allclose(spread[2:].imag, own.imag.std(axis=0)[2:], rtol=0.05)


def test_a_phasor_at_rest_has_no_phase() -> None:
    still = Phasors.of(("a", "b"), ("m", "N"), np.array([0.0, 1.0 + 1j]))
    with pytest.raises(ConfigurationError, match="a does not move"):
        still.referred_to("a")
    with pytest.raises(ConfigurationError, match="cannot be taken off"):
        still.minus(still.select(["b"]))


def test_runs_of_any_kind_know_that_they_share_a_zero_run() -> None:
    """What a zero run adds has one sign and one set of deviates, in a tow and in a heave."""
    samples = np.random.default_rng(6).standard_normal((2, 400))
    rest = Recording("zero", (FORCE_AFT, FORCE_FORE), samples, 100.0)
    offsets = zero_reading(rest)
    few = Phasors.of(FORCES, ("N", "N"), np.array([5.0, 6.0]))
    more = Phasors.of(("a", *FORCES), ("m", "N", "N"), np.array([1.0, 5.0, 6.0]))
    first = few.minus(offsets).real.contributions[-1].dense(4)
    place = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    taken = offsets.mapped(place, more.names, more.units)
    other = more.minus(taken).select(FORCES).real.contributions[-1].dense(4)
    np.testing.assert_allclose(first, other, atol=1e-15)
    np.testing.assert_allclose(first @ other.T, offsets.real.covariance(), atol=1e-15)
    np.testing.assert_allclose(first, -offsets.real.contributions[0].dense(4), atol=1e-15)


@pytest.mark.parametrize("angle", [0.7, -2.0])
def test_coefficients_do_not_depend_on_the_phase_reference(angle: float) -> None:
    generator = np.random.default_rng(9)
    run = scattered(
        ideal_struts(replace(HEAVE, strut_phase_rad=math.pi)), covariance(), 12, generator
    )
    order = np.array([int(name.split()[1]) for name in READ])
    turned = replace(run, phasors=run.phasors.mapped(np.diag(np.exp(1j * angle * order))))
    plain, referred = solve([net(run)]), solve([net(turned)])
    np.testing.assert_allclose(referred.values, plain.values, rtol=1e-8)
    np.testing.assert_allclose(
        referred.uncertain.covariance(), plain.uncertain.covariance(), rtol=1e-5, atol=1e-10
    )
