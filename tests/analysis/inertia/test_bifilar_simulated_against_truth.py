"""Bifilar records from closed forms with friction, drag, sway, offset and noise."""

import math

import numpy as np
import pytest

from analysis.inertia.amplitude import fit_power_decay, zero_amplitude_period
from analysis.inertia.bifilar import sway_period, yaw_from_period, yaw_from_ratio, yaw_period
from analysis.inertia.damped_fit import DampedMode, fit_damped
from analysis.inertia.double_pendulum import mode_periods, pitch_from_periods
from analysis.inertia.local_periods import local_periods
from analysis.inertia.repeats import combine_runs, single_run
from analysis.inertia.series import Series, usable_part
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate
from tests.analysis.inertia.paper_formulas import bifilar_amplitude_factor
from tests.analysis.inertia.records import FloatArray, G, amplitude, damped, swinging

K, D, LINE = 1.056, 0.900, 3.477
KP, DEPTH = 1.156, 0.770


def yaw_record(seed: int, first_rad: float = 0.12, duration_s: float = 300.0) -> Series:
    """Displacement of the stern: yaw with friction and drag, sway, offset, noise, a rest before."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, duration_s, 0.05)
    size = amplitude(t, first_rad, friction=2e-5, viscous=1e-3, quadratic=1.5e-2)
    soft = bifilar_amplitude_factor(1.0, K, D, LINE) - 1.0
    yaw = swinging(t, yaw_period(K, D, LINE, G), size, softening=soft)
    sway = damped(t, sway_period(LINE, G), 1.0 / 124.0, 0.06, 0.7)
    values = 3.0 * yaw + sway + 0.41 + 1e-3 * rng.standard_normal(t.size)
    rest = 0.41 + 3.0 * first_rad + 1e-3 * rng.standard_normal(200)
    everything = np.concatenate([rest, values])
    return Series("stern", "y", "m", 20.0, 0.0, everything)


def yaw_of(series: Series) -> Estimate:
    part = usable_part(series).series
    fit = fit_damped(part.time_s, part.values, modes=2)
    assert fit.converged
    local = local_periods(part.time_s, part.values, fit, mode=0)
    return single_run(local, zero_amplitude_period(local).period).estimate


@pytest.mark.sample(2)
@pytest.mark.parametrize("seed", range(5))
def test_gyradius_within_a_thousandth(seed: int) -> None:
    period = yaw_of(yaw_record(seed))
    found = yaw_from_period(
        period, Estimate.of(D, 0.0, "m"), Estimate.of(LINE, 0.0, "m"), Estimate.of(G, 0.0, "m/s2")
    )
    assert found.result.value == pytest.approx(K, rel=1e-3)
    assert abs(period.value / yaw_period(K, D, LINE, G) - 1.0) < 5e-4


def test_usable_part_leaves_out_what_was_before_the_release() -> None:
    part = usable_part(yaw_record(3))
    assert 9.0 < part.series.start_s < 20.0
    assert part.noise_rms == pytest.approx(1e-3, rel=0.15)
    assert "largest swing" in part.reason


def test_quadratic_drag_shows_as_a_power_between_linear_and_quadratic() -> None:
    t = np.arange(0.0, 400.0, 0.05)
    size = amplitude(t, 0.12, friction=1e-9, viscous=5e-4, quadratic=5e-2)
    fit = fit_power_decay(t[::200], size[::200])
    assert fit.converged
    assert 0.6 < fit.beta < 1.0


def pitch_record(rng: np.random.Generator, scatter: float) -> tuple[FloatArray, FloatArray]:
    t = np.arange(0.0, 90.0, 0.05)
    slow, fast = (
        p * (1.0 + scatter * rng.standard_normal()) for p in mode_periods(KP, DEPTH, LINE, G)
    )
    y = damped(t, slow, 0.004, 0.05, 0.3) + damped(t, fast, 0.006, 0.04, -1.0)
    return t, y + 0.01 + 5e-4 * rng.standard_normal(t.size)


def _undamped_period_s(mode: DampedMode) -> float:
    return mode.period_s * math.sqrt(1.0 - mode.damping_ratio**2)


def test_centre_of_gravity_within_a_millimetre() -> None:
    rng = np.random.default_rng(5)
    runs: list[list[Estimate]] = [[], []]
    for _ in range(4):
        fit = fit_damped(*pitch_record(rng, 2e-5), modes=2)
        for k in (0, 1):
            runs[k].append(
                Estimate.of(_undamped_period_s(fit.modes[k]), fit.period_uncertainty_s(k), "s")
            )
    slow, fast = (combine_runs(own).estimate for own in runs)
    sway = Estimate.of(sway_period(LINE, G), 1e-5, "s")
    found = pitch_from_periods(slow, fast, sway, Estimate.of(G, 0.0, "m/s2"))
    assert found.depth.result.value == pytest.approx(DEPTH, abs=1e-3)
    assert found.gyradius.result.value == pytest.approx(KP, rel=2e-3)


@pytest.mark.slow
def test_intervals_cover_as_promised_and_are_no_wider_than_they_must() -> None:
    """A campaign: four runs whose periods scatter, a spacing known to 0.5 mm.

    Of 100 intervals of 95 % fewer than 91 hold the truth in 3 draws of 100, all in 6 of 1000.
    """
    rng = np.random.default_rng(2014)
    spacing_u, scatter = 5e-4, 3e-4
    t = np.arange(0.0, 40.0, 0.25)
    covered, widths = 0, []
    campaigns = 100
    for _ in range(campaigns):
        ratios = []
        for _ in range(4):
            yaw = yaw_period(K, D, LINE, G) * (1.0 + scatter * rng.standard_normal())
            y = damped(t, yaw, 1.6e-3, 0.2, rng.uniform(-3.0, 3.0))
            y += damped(t, sway_period(LINE, G), 8e-3, 0.15, rng.uniform(-3.0, 3.0))
            fit = fit_damped(t, y + 0.3 + 1e-3 * rng.standard_normal(t.size), modes=2)
            a, b = fit.modes
            u = math.hypot(
                fit.period_uncertainty_s(0) / a.period_s, fit.period_uncertainty_s(1) / b.period_s
            )
            ratio = a.period_s / b.period_s
            ratios.append(Estimate.of(ratio, ratio * u))
        ratio = combine_runs(ratios, subject="ratio").estimate
        spacing = Estimate.of(D + spacing_u * rng.standard_normal(), spacing_u, "m")
        budget = linear_budget(
            "k", lambda ratio, d: ratio * d, {"ratio": ratio, "d": spacing}, unit="m"
        )
        low, high = budget.result.interval()
        covered += low <= K <= high
        widths.append(high - low)
    assert 91 <= covered <= 99
    ideal = K * math.hypot(spacing_u / D, scatter / 2.0)  # all known: the GUM's own
    assert np.median(widths) <= 1.2 * 2.0 * 1.96 * ideal


def test_ratio_agrees_with_period_and_needs_no_length() -> None:
    yaw = Estimate.of(yaw_period(K, D, LINE, G), 1e-3, "s")
    sway = Estimate.of(sway_period(LINE, G), 1e-3, "s")
    found = yaw_from_ratio(yaw, sway, Estimate.of(D, 0.0, "m"))
    assert found.result.value == pytest.approx(K, rel=1e-9)
