"""Oracle: closed forms of damped oscillations, beats and the double pendulum's two modes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from sim.pendulum.benches import (
    KEELBOAT_2014,
    KVLCC2_ROLL,
    MODEL_HULL_2014,
    SWING_2021,
    decay_bench,
    double_pendulum_bench,
)
from sim.pendulum.body import natural_frequencies_rad_s
from sim.pendulum.coordinates import HEAVE, SURGE
from sim.pendulum.effects import make_effect
from sim.pendulum.floating import Floating
from sim.pendulum.pivot import Pendulum
from sim.pendulum.resistance import Resistance
from sim.pendulum.sensors import motion_capture
from sim.pendulum.simulation import (
    simulate_bifilar,
    simulate_compound_pendulum,
    simulate_decay,
    simulate_double_pendulum,
)

G = 9.80665


@pytest.mark.parametrize("damping_ratio", [0.0, 0.003, 0.2])
def test_small_swings_decay_as_the_closed_form(damping_ratio: float) -> None:
    body = Pendulum((SWING_2021,), linear=True)
    record = simulate_compound_pendulum(
        body,
        effects=[make_effect("viscous_damping", damping_ratio=damping_ratio)],
        seed=0,
        release_rad=0.03,
        duration_s=160.0,
        sample_rate_hz=256.0,
    )
    w0 = math.sqrt(42.28 * G * 0.0719 / (39.526 + 42.28 * 0.0719**2))
    w, rate = w0 * math.sqrt(1.0 - damping_ratio**2), damping_ratio * w0
    t = record.dataset.time.values
    expected = 0.03 * np.exp(-rate * t) * (np.cos(w * t) + rate / w * np.sin(w * t))
    np.testing.assert_allclose(record.dataset.angle.values, expected, atol=0.03e-9)


def test_the_papers_swing_has_the_papers_period() -> None:
    (frequency,) = natural_frequencies_rad_s(Pendulum((SWING_2021,)))
    assert 2.0 * math.pi / frequency == pytest.approx(7.2923, abs=0.05)  # d_S is 0.8 % larger
    upper = replace(SWING_2021, lever_m=SWING_2021.lever_m + 1.2)
    (frequency,) = natural_frequencies_rad_s(Pendulum((upper,)))
    assert 2.0 * math.pi / frequency == pytest.approx(2.8460, abs=0.01)


def test_yaw_and_sway_have_the_periods_of_the_bifilar_and_beat() -> None:
    body = replace(KEELBOAT_2014, linear=True)
    record = simulate_bifilar(body, seed=0, yaw_rad=-0.1, sway_m=0.1, stern_lever_m=1.0)
    t = record.dataset.time.values
    sway_period = 2.0 * math.pi * math.sqrt(body.line_length_m / G)
    yaw_period = sway_period * body.yaw_gyradius_m / body.half_spacing_m
    mean = 2.0 * yaw_period * sway_period / (yaw_period + sway_period)
    beat = yaw_period * sway_period / (yaw_period - sway_period)
    # equations 9 to 13: equal amplitudes, so the envelope has a node every beat period
    stern = 0.2 * np.cos(2.0 * np.pi * t / mean) * np.cos(np.pi * t / beat)
    np.testing.assert_allclose(record.dataset.stern_displacement.values, stern, atol=2e-10)


@pytest.mark.parametrize("body", [KEELBOAT_2014, MODEL_HULL_2014])
def test_the_double_pendulum_has_the_two_modes_of_the_frequency_equation(body) -> None:  # type: ignore[no-untyped-def]
    l1, l2, k = body.line_length_m, body.depth_m, body.pitch_gyradius_m
    # equation 16: l1 k^2 w^4 - g (l2^2 + k^2 + l1 l2) w^2 + g^2 l2 = 0
    squares = np.sort(np.roots([l1 * k**2, -G * (l2**2 + k**2 + l1 * l2), G**2 * l2]))
    found = natural_frequencies_rad_s(body)
    for expected in np.sqrt(squares):
        assert np.min(np.abs(found / expected - 1.0)) < 1e-12
    # equation 18: what three periods give back
    ts = 2.0 * math.pi * math.sqrt(l1 / G)
    r1, r2 = 2.0 * math.pi / np.sqrt(squares) / ts
    assert l1 * (r1**2 - 1.0) * (1.0 - r2**2) == pytest.approx(l2, rel=1e-9)
    # let go in the shape of one mode it stays there
    w2 = squares[0]
    shape = (G - w2 * l1) / (w2 * l2 * l1)  # pitch over surge, from the first equation
    record = simulate_double_pendulum(
        replace(body, linear=True), surge_m=0.02, pitch_rad=0.02 * shape, seed=0
    )
    t = record.dataset.time.values
    expected = 0.02 * np.cos(math.sqrt(w2) * t)
    np.testing.assert_allclose(record.dataset.surge.values, expected, atol=0.02e-9)
    np.testing.assert_allclose(record.dataset.pitch.values, shape * expected, atol=1e-10)


def test_heave_decays_as_the_closed_form() -> None:
    body = Floating(40.0, 30.0, 7000.0, Resistance(viscous=50.0), HEAVE)
    record = simulate_decay(body, release=0.02, seed=0, duration_s=20.0)
    t = record.dataset.time.values
    rate = 50.0 / 140.0
    w = math.sqrt(100.0 - rate**2)
    expected = 0.02 * np.exp(-rate * t) * (np.cos(w * t) + rate / w * np.sin(w * t))
    np.testing.assert_allclose(record.dataset.heave.values, expected, atol=1e-12)


def test_the_roll_of_kvlcc2_has_the_measured_period() -> None:
    (frequency,) = natural_frequencies_rad_s(KVLCC2_ROLL)
    assert 2.0 * math.pi / frequency == pytest.approx(2.540, abs=0.005)


def test_it_is_held_and_then_let_go_with_a_rate() -> None:
    bench = decay_bench(KVLCC2_ROLL, release=0.1)
    release = replace(bench.release, after_s=0.5, rate=(0.3,))
    chain = replace(bench, release=release).chain()
    _, run = chain.run(chain.start(100.0, 0), 101)
    assert np.all(run["roll"][:51] == 0.1)
    assert np.all(run["roll_rate"][:50] == 0.0)
    w = math.sqrt(821.0 / 134.1)
    t = np.arange(51) / 100.0
    expected = 0.1 * np.cos(w * t) + 0.3 / w * np.sin(w * t)
    np.testing.assert_allclose(run["roll"][50:], expected, atol=1e-12)


def test_stretched_lines_and_air_change_the_periods_as_they_should() -> None:
    nominal = natural_frequencies_rad_s(MODEL_HULL_2014)
    longer = replace(MODEL_HULL_2014, stretch_ratio=0.01)
    assert longer.stiffness[1, 1] == pytest.approx(MODEL_HULL_2014.stiffness[1, 1] / 1.01)
    assert longer.truth == MODEL_HULL_2014.truth
    bench = decay_bench(KVLCC2_ROLL, release=0.1)
    air = make_effect(
        "air", buoyancy_ratio=0.0015, added_mass_ratio=0.002, added_inertia_ratio=0.002
    )
    assert air(bench) is bench
    hull = air(double_pendulum_bench(MODEL_HULL_2014)).body
    ratio = natural_frequencies_rad_s(hull) / nominal
    np.testing.assert_allclose(ratio, math.sqrt((1.0 - 0.0015) / 1.002), rtol=1e-9)


def test_off_level_the_lines_see_the_inertia_about_another_axis() -> None:
    tilted = replace(MODEL_HULL_2014, off_level_rad=0.2)
    s, c = math.sin(0.2), math.cos(0.2)
    expected = 13.18 * (0.204**2 * s * s + 0.303**2 * c * c)
    assert tilted.mass[2, 2] == pytest.approx(expected, rel=1e-12)
    assert motion_capture(SURGE).channel.unit == "m"
