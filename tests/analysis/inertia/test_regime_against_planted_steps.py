"""A decay that is stopped from outside, against the moment and the damping that were put in."""

import numpy as np
import pytest
from numpy.random import Generator

from analysis.inertia.record import analyse_record
from analysis.inertia.regime import of_one_regime
from analysis.inertia.series import Series, usable_part
from hardware.description.arrays import FloatArray

RATE_HZ = 50.0


def decay(
    rates: tuple[float, float, float], swings: float, period_s: float, stop: tuple[float, float]
) -> FloatArray:
    """Integrate ``dA/dt = -(c0 + c1 A + c2 A^2)`` by Euler; at ``stop`` the amplitude is cut down.

    ``rates`` are of one period and an amplitude of one; ``stop`` is the time and the factor.
    """
    count = int(swings * period_s * RATE_HZ)
    amplitude, at = np.empty(count), round(stop[0] * RATE_HZ)
    amplitude[0] = 1.0
    friction, linear, quadratic = (rate / period_s / RATE_HZ for rate in rates)
    for k in range(1, count):
        a = amplitude[k - 1]
        a -= friction + linear * a + quadratic * a * a
        amplitude[k] = max(a, 0.0) * (stop[1] if k == at else 1.0)
    return amplitude


def recorded(amplitude: FloatArray, period_s: float, noise: float, generator: Generator) -> Series:
    time = np.arange(amplitude.size) / RATE_HZ
    swing = amplitude * np.cos(2.0 * np.pi * time / period_s + generator.uniform(0.0, 6.0))
    values = 0.1 * (swing + 0.02 + noise * generator.standard_normal(time.size))
    return Series("decay", "roll", "rad", RATE_HZ, 0.0, values)


def drawn(generator: Generator, *, stopped: bool) -> tuple[Series, float, float]:
    """Return a decay of linear and quadratic damping and friction, its stop and its period."""
    period, swings = generator.uniform(1.0, 3.0), generator.uniform(30.0, 80.0)
    rates = (
        generator.uniform(0.0, 0.6) / swings,
        generator.uniform(0.002, 0.02),
        generator.uniform(0.0, 0.08),
    )
    at = generator.uniform(0.3, 0.7) * swings * period
    factor = generator.uniform(0.1, 0.7) if stopped else 1.0
    amplitude = decay(rates, swings, period, (at, factor))
    return recorded(amplitude, period, 10.0 ** generator.uniform(-3.5, -2.3), generator), at, period


@pytest.mark.slow
def test_the_moment_is_found_within_a_period_and_no_smooth_decay_has_one() -> None:
    generator, near, false = np.random.default_rng(1), 0, 0
    for _ in range(100):
        series, at, period = drawn(generator, stopped=True)
        part, flags = of_one_regime(series, usable_part(series))
        if flags:
            assert flags[0].code == "regime_change"
            found = float(flags[0].message.split(" at ")[1].split(" s ")[0])
            near += abs(found - at) <= period
            assert part.series.time_s[-1] <= at + 0.5 * period or part.series.start_s >= at
        clean, _, _ = drawn(generator, stopped=False)
        false += bool(of_one_regime(clean, usable_part(clean))[1])
    assert near >= 95
    assert false <= 1


def stopped_at(at: float, swings: float) -> Series:
    generator = np.random.default_rng(2)
    linear = 2.0 * np.pi * 0.01  # a damping ratio of one per cent
    amplitude = decay((0.0, linear, 0.0), swings, 2.0, (at, 0.16))
    return recorded(amplitude, 2.0, 2e-3, generator)


def test_damping_is_that_before_the_stop() -> None:
    """From 1.9 to 0.3 degrees at one moment: seven per cent and more too much without looking."""
    run = analyse_record(stopped_at(40.0, 40.0))
    assert run.fit.modes[0].damping_ratio == pytest.approx(0.01, rel=0.01)
    assert "before the change of regime at 4" in run.part.reason
    assert [flag.code for flag in run.flags] == ["regime_change"]


def test_what_follows_is_used_where_too_little_goes_before() -> None:
    """Five swings, then the hand that had touched the body is gone."""
    run = analyse_record(stopped_at(10.0, 60.0))
    assert run.part.series.start_s > 10.0
    assert "used from there on" in run.flags[0].message
    assert run.fit.modes[0].damping_ratio == pytest.approx(0.01, rel=0.02)


def test_a_gap_is_no_stop() -> None:
    series = stopped_at(1e6, 60.0)
    series.values[1500:3500] = np.nan
    assert of_one_regime(series, usable_part(series))[1] == ()
