"""The swing, at rest and in motion, against bodies whose answer is known."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.inertia.inclinometer import reading_factor, reading_flags, true_angle
from analysis.inertia.swing import (
    SwingState,
    forecast_swing,
    model_on_swing,
    pivot_inertia,
    swing_inertia,
)
from analysis.inertia.swing_static import LeverSeries, distance, fit_static
from analysis.inertia.two_pivots import PivotTest, check_two_pivots
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError, DataError

G = exactly(9.81, "m/s2")
MASS, DEPTH = 42.28, 0.0713


def series(
    name: str, lever: float, most: float, count: int, *, offset: float = 0.0, wrong: float = 0.0
) -> LeverSeries:
    rng = np.random.default_rng(len(name) + count)
    weight = np.linspace(0.0, most, count)
    tangent = weight * lever * (1.0 + wrong) / (MASS * DEPTH) + offset
    return LeverSeries(name, lever, weight, np.arctan(tangent + 1e-5 * rng.standard_normal(count)))


def test_two_levers_with_an_offset() -> None:
    both = [series("C1", 0.2, 1.0, 20, offset=1e-3), series("C2", 0.4, 0.5, 9, offset=1e-3)]
    found = fit_static(both)
    below = distance(found.pooled.moment, exactly(MASS, "kg"))
    assert below.value == pytest.approx(DEPTH, abs=1e-4)
    assert found.pooled.offset_rad.value == pytest.approx(1e-3, abs=2e-5)
    assert all(one.agree for one in found.redundancy)
    assert found.flags == ()
    without = fit_static(both, with_offset=False)
    assert distance(without.pooled.moment, exactly(MASS, "kg")).value < DEPTH - 1e-3


def test_a_series_that_disagrees_is_named_and_widens_the_uncertainty() -> None:
    three = [
        series("C1", 0.64, 1.0, 17),
        series("C2", 0.40, 1.0, 11, wrong=0.02),
        series("C3", 0.20, 1.1, 9),
    ]
    found = fit_static(three)
    assert found.redundancy[1].stands_out == ("C2",)
    assert "data_disagree" in {flag.code for flag in found.flags}
    clean = fit_static([three[0], three[2]])
    assert found.pooled.moment.uncertainty > 5.0 * clean.pooled.moment.uncertainty


@given(factor=st.floats(0.1, 10.0))
@settings(max_examples=20, deadline=None)
def test_a_solver_from_any_start_finds_what_the_one_solve_gives(factor: float) -> None:
    """The paper's own method, from its start times 0.1 to 10."""
    from scipy.optimize import least_squares

    both = [series("C1", 0.2, 1.0, 20, offset=1e-3), series("C2", 0.4, 0.5, 9, offset=1e-3)]
    pull = np.concatenate([one.weight_kg * one.lever_m for one in both])
    tangent = np.tan(np.concatenate([one.tilt_rad for one in both]))
    outcome = least_squares(
        lambda p: pull / (MASS * p[0]) + p[1] - tangent,
        [0.1 * factor, 0.0],
        x_scale=[0.1, 1e-3],
        bounds=([1e-3, -1.0], [10.0, 1.0]),
        xtol=1e-14,
        ftol=1e-14,
        gtol=1e-14,
    )
    ours = fit_static(both).pooled
    assert ours.moment.value / MASS == pytest.approx(float(outcome.x[0]), rel=1e-6)


def test_one_lever_is_said() -> None:
    found = fit_static([series("C1", 0.2, 1.0, 20)])
    assert [flag.code for flag in found.flags] == ["single_lever"]
    assert "second lever" in found.flags[0].message


def test_bad_static_readings_are_refused() -> None:
    good = series("C1", 0.2, 1.0, 20)
    degrees = LeverSeries("C1", 0.2, good.weight_kg, np.degrees(good.tilt_rad))
    with pytest.raises(DataError, match="degrees given as radians"):
        fit_static([degrees])
    with pytest.raises(DataError, match="turn the sign"):
        fit_static([LeverSeries("C1", 0.2, good.weight_kg, -good.tilt_rad)])
    with pytest.raises(DataError, match="at least 3 with different weights"):
        fit_static([LeverSeries("C1", 0.2, np.ones(5), good.tilt_rad[:5])])
    with pytest.raises(DataError, match="at least one"):
        fit_static([])
    with pytest.raises(ConfigurationError, match="lever_m = 0"):
        fit_static([LeverSeries("C1", 0.0, good.weight_kg, good.tilt_rad)])
    with pytest.raises(ConfigurationError, match="mass_kg = 0"):
        distance(fit_static([good]).pooled.moment, exactly(0.0, "kg"))


def state(mass: float, depth: float, inertia: float, relative: float = 1e-4) -> SwingState:
    """Inertia about the own CG; the period follows."""
    period = 2.0 * math.pi * math.sqrt((inertia + mass * depth**2) / (mass * 9.81 * depth))
    return SwingState(
        Estimate.of(period, relative * period, "s"),
        Estimate.of(mass, relative * mass, "kg"),
        Estimate.of(mass * depth, relative * mass * depth, "kg m"),
        G,
    )


def test_inertia_of_what_hangs() -> None:
    found = swing_inertia(state(MASS, DEPTH, 39.6))
    assert found.about_cg.result.value == pytest.approx(39.6, rel=1e-6)
    assert found.about_pivot.result.value == pytest.approx(39.6 + MASS * DEPTH**2, rel=1e-6)
    with pytest.raises(ConfigurationError, match="mass_kg = 0"):
        swing_inertia(SwingState(Estimate.of(7.0, 0.1), exactly(0.0), exactly(3.0), G))


def test_model_is_the_difference() -> None:
    m, d, k = 60.0, 0.9, 0.6
    total = MASS + m
    depth = (MASS * DEPTH + m * d) / total
    about_pivot = 39.6 + MASS * DEPTH**2 + m * (k**2 + d**2)
    loaded = state(total, depth, about_pivot - total * depth**2)
    found = model_on_swing(state(MASS, DEPTH, 39.6), loaded, exactly(m, "kg"))
    assert found.cg_below_pivot.result.value == pytest.approx(d, rel=1e-6)
    assert found.gyradius.result.value == pytest.approx(k, rel=1e-3)
    assert found.share == pytest.approx(m * k**2 / about_pivot, rel=1e-3)
    assert found.flags == ()


def test_small_model_is_forecast_as_not_worth_swinging() -> None:
    """The paper's model: 11.27 kg, 0.836 m below P1; its inertia is a hundredth of the total."""
    tare = SwingState(
        Estimate.of(7.2923, 0.0082, "s"),
        Estimate.of(MASS, 0.02, "kg"),
        Estimate.of(MASS * DEPTH, MASS * 1e-4, "kg m"),
        G,
    )
    model = Estimate.of(11.27, 0.005, "kg")
    forecast = forecast_swing(
        tare, model, 0.8376, 0.2, period_scatter_relative=1e-3, moment_relative=1e-3
    )
    assert not forecast.worth_swinging
    assert 0.1 < forecast.gyradius.relative < 0.5
    assert forecast.share == pytest.approx(0.45 / 48.0, rel=0.05)
    assert "bifilar" in forecast.flags[0].message
    large = forecast_swing(
        tare,
        Estimate.of(80.0, 0.01, "kg"),
        0.6,
        0.9,
        period_scatter_relative=1e-4,
        moment_relative=1e-4,
    )
    assert large.worth_swinging


def test_forecast_keeps_its_word() -> None:
    """The scatter of many simulated tests is what the forecast said."""
    rng = np.random.default_rng(11)
    m, d, k = 60.0, 0.9, 0.6
    tare = state(MASS, DEPTH, 39.6, 2e-4)
    model = exactly(m, "kg")
    forecast = forecast_swing(tare, model, d, k, period_scatter_relative=2e-4, moment_relative=2e-4)
    total_i = 39.6 + MASS * DEPTH**2 + m * (k**2 + d**2)
    moment = MASS * DEPTH + m * d
    period = 2.0 * math.pi * math.sqrt(total_i / (moment * 9.81))

    def off() -> float:
        return 1.0 + 2e-4 * float(rng.standard_normal())

    found = []
    for _ in range(4000):
        s_t, s_m, l_t, l_m = off(), off(), off(), off()
        tared = pivot_inertia(tare.period.value * s_t, 1.0, tare.moment.value * s_m, 9.81)
        total = pivot_inertia(period * l_t, 1.0, moment * l_m, 9.81)
        own = total - tared - (moment * l_m - tare.moment.value * s_m) ** 2 / m
        found.append(math.sqrt(own / m))
    assert float(np.std(found)) == pytest.approx(forecast.gyradius.uncertainty, rel=0.08)


def test_a_model_that_drowns_in_the_swing_is_refused() -> None:
    tare = state(MASS, DEPTH, 39.6, 2e-3)
    m, d, k = 2.0, 0.8, 0.1
    total = MASS + m
    depth = (MASS * DEPTH + m * d) / total
    inertia = 39.6 + MASS * DEPTH**2 + m * (k**2 + d**2) - total * depth**2
    with pytest.raises(DataError, match="cannot be told from none"):
        model_on_swing(tare, state(total, depth, inertia, 2e-3), exactly(m, "kg"))


def pivots(d1: float, d2: float) -> tuple[PivotTest, PivotTest]:
    inertia = 39.6

    def period(d: float) -> float:
        return 2.0 * math.pi * math.sqrt((inertia + MASS * d * d) / (MASS * 9.81 * d))

    return (
        PivotTest(Estimate.of(period(0.0713), 1e-3, "s"), Estimate.of(d1, 2e-4, "m")),
        PivotTest(Estimate.of(period(1.2713), 1e-3, "s"), Estimate.of(d2, 5e-4, "m")),
    )


def test_two_pivots_agree_or_point_at_what_is_wrong() -> None:
    mass, apart = Estimate.of(MASS, 0.02, "kg"), Estimate.of(1.2, 1e-4, "m")
    good = check_two_pivots(*pivots(0.0713, 1.2713), mass, apart, G)
    assert good.passes
    assert good.points_to == ()
    assert good.from_periods_m == pytest.approx(0.0713, abs=1e-6)
    bad = check_two_pivots(*pivots(0.0713, 1.2767), mass, apart, G)
    assert not bad.passes
    assert bad.distance_excess.value == pytest.approx(5.4e-3)
    assert "upper pivot" in bad.points_to[0]


def test_the_papers_own_check_fails_and_points_at_the_upper_pivot() -> None:
    first = PivotTest(Estimate.of(7.2923, 0.0082, "s"), Estimate.of(0.0713, 3e-4, "m"))
    second = PivotTest(Estimate.of(2.8460, 2e-4, "s"), Estimate.of(1.2767, 1e-3, "m"))
    found = check_two_pivots(
        first, second, Estimate.of(42.28, 0.02, "kg"), Estimate.of(1.2, 1e-4, "m"), G
    )
    assert not found.passes
    assert found.distance_excess.value == pytest.approx(5.4e-3)
    assert found.inertia_difference.value == pytest.approx(-0.123, abs=0.03)
    assert "upper pivot" in found.points_to[0]


def test_inclinometer_carried_along() -> None:
    assert reading_factor(7.2923, 0.917, 9.81) == pytest.approx(0.93, abs=0.005)
    fast = reading_factor(2.8460, 0.917 + 1.2, 9.81)
    assert fast == pytest.approx(-0.05, abs=0.005)
    assert reading_flags(0.93) == ()
    assert reading_flags(fast)[0].code == "inclinometer_misreads"
    assert true_angle(0.0093, 0.93) == pytest.approx(0.01)
    with pytest.raises(ConfigurationError, match="nearer to the pivot"):
        true_angle(0.01, fast)
