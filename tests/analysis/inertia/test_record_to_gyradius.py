"""The short way from records to a period, and plans before a test."""

import math

import numpy as np
import pytest

from analysis.inertia.lengthening import pendulum_lengthening
from analysis.inertia.record import analyse_record, from_runs
from analysis.inertia.repeats import combine_runs
from analysis.inertia.series import Series
from analysis.inertia.suspension_plan import SUSPENSION_OPTIONS, forecast_suspension
from analysis.inertia.swing import inertia_at_cg
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError, DataError
from tests.analysis.inertia.records import damped, swinging

T = np.arange(0.0, 160.0, 0.05)


def swing(seed: int, period: float) -> Series:
    rng = np.random.default_rng(seed)
    size = 0.08 * np.exp(-0.005 * T)
    y = swinging(T, period, size, softening=1.0 / 16.0) + 2e-4 + 1e-5 * rng.standard_normal(T.size)
    return Series(f"run {seed}", "angle", "rad", 20.0, 0.0, y)


def test_three_releases() -> None:
    true = 7.2923
    runs = [
        analyse_record(swing(k, true * (1.0 + s)), lengthens=pendulum_lengthening)
        for k, s in ((1, 1e-3), (2, 0.0), (3, -1e-3))
    ]
    assert runs[0].period().value == pytest.approx(true * 1.001, abs=2e-4)
    assert "angle_scale" not in {flag.code for flag in runs[0].flags}
    found = from_runs(runs)
    assert found.estimate.value == pytest.approx(true, rel=1e-4)
    assert found.estimate.uncertainty == pytest.approx(true * 1e-3 / math.sqrt(3.0), rel=0.05)
    single = from_runs(runs[:1])
    assert single.flags[0].code == "single_run"
    with pytest.raises(DataError, match="0 run"):
        from_runs([])


def test_wrongly_scaled_angles_are_told() -> None:
    y = damped(T, 3.0, 0.01, 0.5) + 1e-4 * np.random.default_rng(0).standard_normal(T.size)
    found = analyse_record(
        Series("run", "angle", "rad", 20.0, 0.0, y), lengthens=pendulum_lengthening
    )
    assert "angle_scale" in {flag.code for flag in found.flags}


def test_both_modes_of_a_record() -> None:
    y = damped(T, 4.394, 1.6e-3, 0.2) + damped(T, 3.802, 8e-3, 0.15, 1.0)
    y = y + 1e-3 * np.random.default_rng(0).standard_normal(T.size)
    found = analyse_record(Series("stern", "y", "m", 20.0, 0.0, y), modes=2)
    for mode, true in ((0, 4.394), (1, 3.802)):
        assert found.fit.modes[mode].period_s == pytest.approx(true, rel=2e-5)
        # to no amplitude it is a long way from a record that hardly decays, and that is said
        period = found.period(mode)
        assert abs(period.value - true) < 3.0 * period.uncertainty < 0.006
    assert found.modes[0].decay.time_constant_s == pytest.approx(625.0, rel=0.05)


@pytest.mark.slow
def test_interval_of_the_swings_inertia_covers() -> None:
    """Five releases that scatter by 0.2 %, a first moment known to 0.4 %: 400 tests."""
    rng = np.random.default_rng(2021)
    mass, depth, inertia = 42.28, 0.0713, 39.6
    period = 2.0 * math.pi * math.sqrt((inertia + mass * depth**2) / (mass * 9.81 * depth))
    inside = 0
    for _ in range(400):
        runs = [
            Estimate.of(period * (1.0 + 2e-3 * rng.standard_normal()), 1e-4, "s") for _ in range(5)
        ]
        below = depth * (1.0 + 4e-3 * rng.standard_normal())
        inputs = {
            "period_s": combine_runs(runs).estimate,
            "mass_kg": exactly(mass, "kg"),
            "cg_m": Estimate.of(below, 4e-3 * depth, "m"),
            "gravity_m_s2": exactly(9.81),
        }
        low, high = linear_budget("I", inertia_at_cg, inputs).result.interval()
        inside += low <= inertia <= high
    assert 0.93 <= inside / 400 <= 0.98


def test_suspension_forecast() -> None:
    found = forecast_suspension(
        0.303,
        0.352,
        0.253,
        Estimate.of(0.28, 5e-4, "m"),
        Estimate.of(0.504, 1e-3, "m"),
        exactly(9.81),
        period_scatter_relative=1e-3,
    )
    assert found.yaw_gyradius.value == pytest.approx(0.303)
    assert found.pitch_gyradius.value == pytest.approx(0.352)
    assert found.pitch_gyradius.relative > 1e-3
    assert found.best_line_m["fixed"] == pytest.approx(0.498, abs=2e-3)
    assert found.flags == ()
    near = forecast_suspension(
        0.303,
        0.352,
        0.253,
        exactly(0.28),
        exactly(1.56),
        exactly(9.81),
        period_scatter_relative=1e-3,
    )
    assert near.flags[0].code == "yaw_pitch_resonance"
    with pytest.raises(ConfigurationError, match="line_m = 0"):
        forecast_suspension(
            0.3, 0.3, 0.2, exactly(0.28), exactly(0.0), exactly(9.81), period_scatter_relative=1e-3
        )
    assert "l_2" in SUSPENSION_OPTIONS["B-F"]
