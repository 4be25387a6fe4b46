"""Oracle: what dry friction, drag and cubic damping leave of the amplitude, cycle by cycle."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from hardware.description.arrays import FloatArray
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import (
    KVLCC2_ROLL,
    MODEL_HULL_2014,
    SWING_2021,
    compound_bench,
    decay_bench,
    double_pendulum_bench,
)
from sim.pendulum.effects import make_effect
from sim.pendulum.floating import Floating
from sim.pendulum.photogate import crossings
from sim.pendulum.pivot import Pendulum

ROLL = Floating(inertia=2.0, added_inertia=0.5, restoring=2.5 * (2.0 * math.pi) ** 2)  # T = 1 s


def run(bench: PendulumBench, seconds: float, rate_hz: float = 100.0) -> dict[str, FloatArray]:
    chain = bench.chain()
    _, found = chain.run(chain.start(rate_hz, 0), round(seconds * rate_hz) + 1)
    return dict(found)


def peaks(bench: PendulumBench, seconds: float) -> FloatArray:
    """Return one upper peak a cycle, the release included, of a body with T = 1 s exactly."""
    return run(bench, seconds)["roll"][::100]


@pytest.mark.parametrize("dead_zone", [0.001, 0.01, 0.013])
def test_dry_friction_takes_four_dead_zones_a_cycle_and_stops(dead_zone: float) -> None:
    effect = make_effect("bearing_friction", dead_zone=dead_zone)
    found = run(effect(decay_bench(ROLL, release=0.2)), 60.0)
    halves = math.ceil((0.2 / dead_zone - 1.0) / 2.0)  # it stops within one dead zone
    # each half swing is a cosine about its own centre, a dead zone to that side
    t = np.arange(6001) / 100.0
    half = np.minimum(np.floor(2.0 * t + 1e-9), halves)
    sense = (-1.0) ** half
    about = sense * dead_zone
    swing = (0.2 - (2.0 * half + 1.0) * dead_zone) * np.cos(2.0 * np.pi * (t - half / 2.0))
    rest = sense * (0.2 - 2.0 * halves * dead_zone)
    expected = np.where(half < halves, about + sense * swing, rest)
    np.testing.assert_allclose(found["roll"], expected, atol=2e-10)
    assert found["roll_rate"][-1] == 0.0
    assert found["roll_acceleration"][-1] == 0.0
    assert abs(found["roll"][-1]) <= dead_zone


def test_let_go_within_the_dead_zone_it_stays() -> None:
    bench = make_effect("bearing_friction", dead_zone=0.01)(decay_bench(ROLL, release=0.0099))
    assert np.all(run(bench, 5.0)["roll"] == 0.0099)


def test_viscous_and_dry_friction_together_agree_with_a_search_for_the_reversals() -> None:
    bench = decay_bench(ROLL, release=0.2).with_effects(
        [
            make_effect("bearing_friction", dead_zone=0.004),
            make_effect("viscous_damping", damping_ratio=0.01),
            make_effect("quadratic_drag", loss=0.3),
        ]
    )
    found = run(bench, 8.0)["roll"]
    body = bench.body
    assert isinstance(body, Floating)
    load, start, t0, expected = body.resistance, np.array([0.2, 0.0]), 0.0, []
    t, sign = np.arange(801) / 100.0, -1.0
    while t0 < 8.0:

        def rates(t: float, x: FloatArray, sign: float = sign) -> list[float]:
            drag = (load.viscous + load.quadratic * abs(x[1])) * x[1]
            return [x[1], -(ROLL.restoring * x[0] + drag + sign * load.coulomb) / 2.5]

        def reversed_(t: float, x: FloatArray, sign: float = sign, t0: float = t0) -> float:
            return float(x[1] * sign) + (1.0 if t == t0 else 0.0)

        reversed_.terminal = True  # type: ignore[attr-defined]
        part = solve_ivp(
            rates, (t0, 8.5), start, "DOP853", None, True, reversed_, rtol=1e-11, atol=1e-13
        )
        inside = (t >= t0) & (t <= part.t[-1])
        expected.append(part.sol(t[inside])[0])
        t0, start, sign = part.t[-1], np.array([part.y[0, -1], 0.0]), -sign
        if abs(start[0]) * ROLL.restoring <= load.coulomb:
            break
    together = np.concatenate(expected)[: found.size]
    np.testing.assert_allclose(found[: together.size], together, atol=2e-9)


def test_quadratic_drag_leaves_the_peaks_of_its_energy_integral() -> None:
    # I v v' + B v|v| + K q = 0: with s = 2 B/I, from one turning point a to the next b,
    # (1 + s a) exp(-s a) = (1 - s b) exp(s b)
    from scipy.optimize import brentq

    effect = make_effect("quadratic_drag", loss=2.0)
    bench = effect(decay_bench(ROLL, release=0.3))
    found = run(bench, 10.0)
    turns = turning_points(found)
    s = 2.0 * 0.375 * 2.0
    for a, b in pairwise(np.concatenate([[0.3], turns])):
        expected = brentq(
            lambda x, a=a: (1 - s * x) * math.exp(s * x) - (1 + s * a) * math.exp(-s * a), 0.0, a
        )
        assert b == pytest.approx(expected, rel=1e-7)


def turning_points(found: dict[str, FloatArray]) -> FloatArray:
    """Return the magnitude at each reversal, by the polynomial through both neighbours."""
    moved = np.stack([found["roll_rate"], found["roll_acceleration"], 0.0 * found["roll"]])
    moved[2] = np.gradient(found["roll_acceleration"], 0.01, edge_order=2)
    at, _ = crossings(moved[:, 1:], 0.0, 100.0)
    k = np.round(at).astype(int) + 1
    off = (at + 1 - k) / 100.0
    q, v, a = (found[key][k] for key in ("roll", "roll_rate", "roll_acceleration"))
    third = moved[2][k]
    return np.abs(q + off * (v + off * (a / 2.0 + off * third / 6.0)))


def test_small_losses_follow_the_stated_signatures() -> None:
    quadratic = make_effect("quadratic_drag", loss=0.05)(decay_bench(ROLL, release=0.1))
    inverse = 1.0 / peaks(quadratic, 20.0)
    np.testing.assert_allclose(np.diff(inverse), 0.05, rtol=5e-3)
    cubic = make_effect("cubic_damping", loss=0.5)(decay_bench(ROLL, release=0.1))
    inverse = 1.0 / peaks(cubic, 20.0) ** 2
    np.testing.assert_allclose(np.diff(inverse), 1.0, rtol=2e-2)
    power = make_effect("power_drag", beta=0.3, damping_ratio=0.002, amplitude=0.1)
    found = peaks(power(decay_bench(ROLL, release=0.1)), 20.0)
    # dA/dt = -zeta w A (A/A0)^beta
    expected = 0.1 * (1.0 + 0.3 * 0.002 * 2.0 * np.pi * np.arange(21)) ** (-1.0 / 0.3)
    np.testing.assert_allclose(found, expected, rtol=1e-3)


@pytest.mark.parametrize("slope", [-0.2, 0.05, 0.3])
def test_the_period_grows_with_the_amplitude_as_stated(slope: float) -> None:
    bench = make_effect("amplitude_period", slope=slope)(decay_bench(ROLL, release=0.1))
    found = run(bench, 40.0)
    at, up = crossings(
        np.stack([found[f"roll{key}"] for key in ("", "_rate", "_acceleration")]), 0.0, 100.0
    )
    period = np.diff(at[up]).mean() / 100.0
    assert period == pytest.approx(1.0 + slope * 0.1, abs=2.0 * (slope * 0.1) ** 2 + 1e-9)


def test_a_cubic_restoring_shifts_the_period() -> None:
    bench = make_effect("nonlinear_restoring", cubic=-0.5)(decay_bench(ROLL, release=0.1))
    found = run(bench, 40.0)
    at, up = crossings(
        np.stack([found[f"roll{key}"] for key in ("", "_rate", "_acceleration")]), 0.0, 100.0
    )
    period = np.diff(at[up]).mean() / 100.0
    assert period == pytest.approx(1.0 + 0.375 * 0.5 * 0.01, abs=1e-5)


def test_what_drag_and_friction_take_is_what_the_energy_loses() -> None:
    bench = compound_bench(Pendulum((SWING_2021,)), release_rad=0.3).with_effects(
        [
            make_effect("quadratic_drag", loss=0.2),
            make_effect("bearing_friction", dead_zone=0.002),
            make_effect("viscous_damping", damping_ratio=0.01),
        ]
    )
    body = bench.body
    assert isinstance(body, Pendulum)
    found = run(bench, 40.0, 200.0)
    q, v = found["angle"], found["angle_rate"]
    kinetic = 0.5 * body.mass[0, 0] * v**2
    energy = kinetic + body.restoring_n_m * (1.0 - np.cos(q))
    load = body.resistance
    power = load.viscous * v**2 + load.quadratic * np.abs(v) ** 3 + load.coulomb * np.abs(v)
    taken = np.concatenate([[0.0], np.cumsum(0.5 * (power[1:] + power[:-1]) / 200.0)])
    np.testing.assert_allclose(energy + taken, energy[0], rtol=2e-5)


def test_friction_in_the_pitch_bearing_holds_and_lets_go_while_the_lines_swing() -> None:
    bench = double_pendulum_bench(MODEL_HULL_2014, surge_m=0.05)
    bench = make_effect("bearing_friction", dead_zone=0.01, coordinate="pitch")(bench)
    found = run(bench, 30.0)
    resting = found["pitch_rate"] == 0.0
    resting[0] = False  # let go, and already sliding
    # sometimes held, sometimes not, and in the end for good though the surge goes on
    assert 0.1 < resting.mean() < 1.0
    assert np.all(resting[-500:])
    assert np.abs(found["surge"][-500:]).max() > 1e-3
    m, depth = MODEL_HULL_2014.mass_kg, MODEL_HULL_2014.depth_m
    pull = m * depth * found["surge_acceleration"] + m * 9.80665 * depth * found["pitch"]
    assert np.abs(pull[resting]).max() <= 0.01 * m * 9.80665 * depth * 1.01


@settings(deadline=None, max_examples=25)
@given(
    dead_zone=st.floats(1e-5, 0.02),
    loss=st.floats(0.0, 5.0),
    ratio=st.floats(0.0, 0.1),
    release=st.floats(-0.3, 0.3),
)
def test_nothing_that_resists_ever_adds_energy(
    dead_zone: float, loss: float, ratio: float, release: float
) -> None:
    bench = decay_bench(KVLCC2_ROLL, release=release).with_effects(
        [
            make_effect("bearing_friction", dead_zone=dead_zone),
            make_effect("quadratic_drag", loss=loss),
            make_effect("viscous_damping", damping_ratio=ratio),
        ]
    )
    found = run(bench, 10.0, 50.0)
    energy = 0.5 * 134.1 * found["roll_rate"] ** 2 + 0.5 * 821.0 * found["roll"] ** 2
    assert np.all(np.diff(energy) <= 1e-9 * energy[0])
