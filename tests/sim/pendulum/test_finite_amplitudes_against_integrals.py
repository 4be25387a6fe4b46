"""Oracle: the elliptic integral, quadratures, energy, another integrator."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import ellipk

from hardware.description.arrays import FloatArray
from sim.pendulum.benches import MODEL_HULL_2014, bifilar_bench, compound_bench, decay_bench
from sim.pendulum.effects import make_effect
from sim.pendulum.floating import Floating
from sim.pendulum.photogate import crossings
from sim.pendulum.pivot import HangingWeight, Pendulum, RigidPart
from sim.pendulum.resistance import Resistance
from sim.pendulum.suspension import Suspension

G = 9.80665
ROD = RigidPart(mass_kg=2.0, lever_m=0.3, inertia_kg_m2=0.06)


def motion(bench, names: tuple[str, ...], seconds: float, rate_hz: float = 200.0) -> FloatArray:  # type: ignore[no-untyped-def]
    chain = bench.chain()
    _, run = chain.run(chain.start(rate_hz, 0), round(seconds * rate_hz))
    return np.stack([run[name] for name in names])


def period(moved: FloatArray, rate_hz: float = 200.0) -> float:
    at, upwards = crossings(moved, 0.0, rate_hz)
    times = at[upwards] / rate_hz
    return float((times[-1] - times[0]) / (times.size - 1))


def of(name: str) -> tuple[str, str, str]:
    return name, f"{name}_rate", f"{name}_acceleration"


@pytest.mark.parametrize("amplitude", [0.02, 0.2, 1.0, 2.5])
def test_a_pendulums_period_is_the_elliptic_integral(amplitude: float) -> None:
    bench = compound_bench(Pendulum((ROD,)), release_rad=amplitude)
    w0 = math.sqrt(2.0 * G * 0.3 / (0.06 + 2.0 * 0.09))
    expected = 4.0 / w0 * ellipk(math.sin(amplitude / 2.0) ** 2)
    found = period(motion(bench, of("angle"), 30.0))
    assert found == pytest.approx(expected, rel=3e-8)
    if amplitude <= 0.2:
        assert found == pytest.approx(2 * math.pi / w0 * (1 + amplitude**2 / 16), rel=1e-5)


def test_sway_alone_is_a_simple_pendulum_of_the_lines_length() -> None:
    bench = bifilar_bench(MODEL_HULL_2014, yaw_rad=0.0, sway_m=0.15)
    angle = math.asin(0.15 / 0.504)
    expected = 4.0 * math.sqrt(0.504 / G) * ellipk(math.sin(angle / 2.0) ** 2)
    assert period(motion(bench, of("sway"), 20.0)) == pytest.approx(expected, rel=3e-8)


@pytest.mark.parametrize("amplitude", [0.05, 0.5])
def test_yaw_alone_has_the_period_that_its_energy_gives(amplitude: float) -> None:
    hull = MODEL_HULL_2014
    d, length, k = hull.half_spacing_m, hull.line_length_m, hull.yaw_gyradius_m

    def depth(yaw: float) -> float:
        return math.sqrt(length**2 - 2.0 * d**2 * (1.0 - math.cos(yaw)))

    def slowness(s: float) -> float:  # yaw = amplitude sin(s), so that the ends stay finite
        yaw = amplitude * math.sin(s)
        heave = d**2 * math.sin(yaw) / depth(yaw)
        fall = depth(yaw) - depth(amplitude)
        return math.sqrt((k**2 + heave**2) / (2.0 * G * fall)) * amplitude * math.cos(s)

    expected = 4.0 * quad(slowness, 0.0, math.pi / 2.0 - 1e-9, epsabs=1e-11)[0]
    found = period(motion(bifilar_bench(hull, yaw_rad=amplitude), of("yaw"), 20.0))
    assert found == pytest.approx(expected, rel=1e-7)


def energy(hull: Suspension, q: FloatArray, v: FloatArray) -> float:
    """From the positions alone: rates by central differences of the geometry."""

    def place(q: FloatArray) -> tuple[FloatArray, FloatArray]:
        (x, y, yaw, pitch), roll = q, 0.0
        d, length = hull.half_spacing_m, hull.line_length_m
        cy, sy = math.cos(yaw), math.sin(yaw)
        for _ in range(50):
            z = math.sqrt(length**2 - x * x - y * y - 2 * d * d * (1 - cy * math.cos(roll)))
            roll = math.asin((x * sy * math.cos(roll) + y * (1 - cy * math.cos(roll))) / z)
        about_z = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
        cr, sr, cp, sp = math.cos(roll), math.sin(roll), math.cos(pitch), math.sin(pitch)
        about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
        about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
        turn = about_z @ about_x @ about_y
        return np.array([x, y, z]) + turn @ np.array([0.0, 0.0, hull.depth_m]), turn

    h = 1e-5
    (ahead, turn_ahead), (behind, turn_behind) = place(q + h * v), place(q - h * v)
    here, turn = place(q)
    speed = (ahead - behind) / (2 * h)
    spin = turn.T @ (turn_ahead - turn_behind) / (2 * h)  # skew, in body axes
    wx, wy, wz = spin[2, 1], spin[0, 2], spin[1, 0]
    gyradii = (hull.roll_gyradius_m, hull.pitch_gyradius_m, hull.yaw_gyradius_m)
    rotation = sum((k * w) ** 2 for k, w in zip(gyradii, (wx, wy, wz), strict=True))
    return hull.mass_kg * (0.5 * (speed @ speed + rotation) - G * here[2])


def test_the_exact_motion_on_two_lines_keeps_its_energy() -> None:
    bench = bifilar_bench(MODEL_HULL_2014, yaw_rad=0.4, sway_m=0.1)
    bench = replace(bench, release=replace(bench.release, displacement=(0.08, 0.1, 0.4, 0.2)))
    names = ("surge", "sway", "yaw", "pitch")
    run = motion(bench, (*names, *(f"{name}_rate" for name in names)), 20.0)
    energies = [energy(MODEL_HULL_2014, run[:4, k], run[4:, k]) for k in range(0, 4000, 97)]
    exchanged = MODEL_HULL_2014.mass_kg * G * 0.02
    assert np.ptp(energies) < 1e-6 * exchanged


def test_accelerations_are_the_derivatives_of_the_rates() -> None:
    bench = bifilar_bench(MODEL_HULL_2014, yaw_rad=0.4, sway_m=0.1)
    bench = make_effect("unsteady_release", rate_rms=0.1)(bench)
    for name in ("surge", "sway", "yaw", "pitch"):
        rate, acceleration = motion(bench, of(name)[1:], 2.0, 2000.0)
        slope = (rate[:-4] - 8 * rate[1:-3] + 8 * rate[3:-1] - rate[4:]) * 2000.0 / 12.0
        np.testing.assert_allclose(acceleration[2:-2], slope, atol=1e-8)


def test_every_load_at_once_agrees_with_solve_ivp() -> None:
    loads = Resistance(0.4, 3.0, 2.0, 0.5, 1.3, 0.0, 5.0, -60.0, 30.0)
    body = Floating(2.0, 0.5, 40.0, loads)

    def rates(_: float, x: FloatArray) -> list[float]:
        q, v = x
        drag = 0.4 * v + 3.0 * abs(v) * v + 2.0 * v**3 + 0.5 * np.sign(v) * abs(v) ** 1.3
        spring = 40.0 * q + 5.0 * abs(q) * q - 60.0 * q**3 + 30.0 * q**5
        return [v, -(drag + spring) / 2.5]

    found = motion(decay_bench(body, release=0.4), ("roll", "roll_rate"), 10.0)
    exact = solve_ivp(
        rates, (0.0, 10.0), (0.4, 0.0), "DOP853", np.arange(2000) / 200.0, rtol=1e-11, atol=1e-13
    )
    # |v|^1.3 has no third derivative where v = 0: the fourth order is lost there
    np.testing.assert_allclose(found, exact.y, rtol=0.0, atol=2e-7)


def test_the_method_is_of_fourth_order() -> None:
    bench = compound_bench(Pendulum((ROD,)), release_rad=0.5)
    fine = motion(bench, ("angle",), 10.0, 1600.0)[0]
    errors = [
        np.abs(motion(bench, ("angle",), 10.0, rate)[0] - fine[:: round(1600.0 / rate)]).max()
        for rate in (50.0, 100.0, 200.0)
    ]
    for coarse, half in pairwise(errors):
        assert coarse / half > 12.0
    assert errors[0] < 4e-8  # 0.1 rad a step, 8 cycles: what the documentation states


def test_hanging_weights_turn_the_swing_to_the_angle_of_equation_2() -> None:
    body = Pendulum((ROD,), (HangingWeight(0.2, 0.4),), resistance=Resistance(viscous=2.0))
    angle = motion(compound_bench(body, release_rad=0.0), ("angle",), 20.0)[0]
    assert math.tan(angle[-1]) == pytest.approx(0.2 * 0.4 / (2.0 * 0.3), rel=1e-9)


def largest_pitch(line_length_m: float, sway_m: float) -> float:
    hull = replace(MODEL_HULL_2014, line_length_m=line_length_m)
    bench = bifilar_bench(hull, yaw_rad=0.3, sway_m=sway_m)
    bench = replace(bench, release=replace(bench.release, displacement=(0.0, sway_m, 0.3, 1e-3)))
    return float(np.abs(motion(bench, ("pitch",), 120.0, 50.0)[0]).max())


@pytest.mark.slow
def test_yaw_and_sway_turn_into_pitch_at_the_papers_line_length() -> None:
    # seen in 2014 with lines of 1560 mm, where T_y nears T_1, and with yaw and sway together only
    assert largest_pitch(1.56, 0.1) > 2.0 * largest_pitch(1.0, 0.1)
    assert largest_pitch(1.56, 0.1) > 2.0 * largest_pitch(2.2, 0.1)
    assert largest_pitch(1.56, 0.0) == pytest.approx(1e-3, rel=1e-3)


def test_the_resonance_effect_finds_that_length() -> None:
    effect = make_effect("yaw_pitch_resonance", period_ratio=0.98)
    changed = effect(bifilar_bench(MODEL_HULL_2014)).body
    assert isinstance(changed, Suspension)
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(changed.mass, changed.stiffness)).real)
    yaw = changed.stiffness[2, 2] / changed.mass[2, 2]
    assert math.sqrt(squares[0] / yaw) == pytest.approx(0.98, abs=1e-9)
    assert changed.line_length_m == pytest.approx(1.56, rel=0.15)
