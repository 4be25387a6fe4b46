"""Effects of the second reality: sign, order and scaling as closed forms have them.

The formulas are those of the catalogue's table; the reality's own forms differ from them a little,
which is what the tolerances allow.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from tests.sealed.closed_forms import (
    AMPLITUDE,
    DAMPING,
    HEAVE,
    MASS,
    OMEGA,
    change,
    impedance,
    phasors,
    still,
)
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.parameters import P

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile

PI = np.pi
W, A = OMEGA, AMPLITUDE


def _coulomb(w: float, a: float, f: float) -> dict[int, complex]:
    return {1: 2j * 4.0 * f / PI, 3: -2j * 4.0 * f / (3.0 * PI)}


def _quadratic(w: float, a: float, s: float) -> dict[int, complex]:
    level = 100.0 * s * w**2 * a**2 / PI
    return {1: 8j / 3.0 * level, 3: 8j / 15.0 * level}


def _cubic(w: float, a: float, s: float) -> dict[int, complex]:
    return {1: 0.75j * 300.0 * s * (w * a) ** 3, 3: 0.25j * 300.0 * s * (w * a) ** 3}


def _flare(w: float, a: float, s: float) -> dict[int, complex]:
    return {
        0: 500.0 * s * a**2,
        1: 0.75e4 * s * a**3,
        2: -500j * s * a**2,
        3: -0.25e4 * s * a**3,
    }


def _compliance(w: float, a: float, flexibility: float) -> dict[int, complex]:
    return {1: -(impedance(1, w) ** 2) * flexibility / 2.0 * a}


def _lag(w: float, a: float, tau: float) -> dict[int, complex]:
    return {1: impedance(1, w) * a / (1.0 + 0.5j * w * tau) ** 2 - impedance(1, w) * a}


def _curvature(w: float, a: float, q: float) -> dict[int, complex]:
    # Each strut carries half; y = q F² has its second harmonic at twice the force's phase.
    half = impedance(1, w) * a / 2.0
    return {0: q * abs(half) ** 2, 2: -1j * q * abs(half) ** 2 * (half / abs(half)) ** 2}


def _hysteresis(w: float, a: float, beta: float) -> dict[int, complex]:
    half = impedance(1, w) * a / 2.0
    turn = half / abs(half)
    return {3: -2j * 4.0 / (15.0 * PI) * beta * abs(half) ** 2 * turn**3}


FORMS: dict[str, tuple[float, Callable[[float, float, float], dict[int, complex]], float]] = {
    # Bristles give 0.1 mm before they slip, and turn the friction by so much of the stroke.
    "coulomb-friction": (0.5, _coulomb, 0.12),
    "quadratic-damping": (1.0, _quadratic, 0.03),
    "cubic-damping": (3.0, _cubic, 0.02),
    "viscous-guides": (2.0, lambda w, a, b: {1: 2j * b * w * a}, 0.03),
    "nonlinear-restoring": (1.0, _flare, 0.02),
    "mass-error": (0.01, lambda w, a, r: {1: -r * MASS * w**2 * a}, 0.001),
    "damping-error": (0.2, lambda w, a, r: {1: 1j * r * DAMPING * w * a}, 0.001),
    "gauge-compliance": (2e-6, _compliance, 0.03),
    "amplifier-lag": (5e-3, _lag, 0.01),
    "quadratic-gauge": (2e-6, _curvature, 0.10),
    "gauge-hysteresis": (2e-6, _hysteresis, 0.05),
    "cross-talk": (0.01, lambda w, a, c: {1: c * impedance(1, w) * a}, 0.001),
    "gain-error": (0.01, lambda w, a, g: {1: g * impedance(1, w) * a / 2.0}, 0.001),
}
SETTINGS = [(HEAVE.frequency_hz, A), (0.6, A), (HEAVE.frequency_hz, 1.7 * A)]


@pytest.mark.parametrize("name", FORMS)
def test_force_law_has_sign_order_and_scaling(name: str) -> None:
    size, form, tolerance = FORMS[name]
    for frequency, amplitude in SETTINGS:
        run = replace(HEAVE, frequency_hz=frequency, eccentricity_m=amplitude)
        found = change(BY_NAME[name], size, run)
        expected = form(2.0 * PI * frequency, amplitude, size)
        largest = max(abs(value) for value in expected.values())
        for order, value in expected.items():
            got = found.mean["force"] if order == 0 else found.of["force"][order]
            assert abs(got - value) < tolerance * largest, (name, frequency, amplitude, order)


def test_hysteresis_dissipates_in_the_force_s_own_phase() -> None:
    beta = 2e-6
    found = change(BY_NAME["gauge-hysteresis"], beta).of["force"][1]
    half = impedance(1) * A / 2.0
    across = found / (half / abs(half))
    assert across.imag == pytest.approx(-2.0 * 4.0 / (3.0 * PI) * beta * abs(half) ** 2, rel=0.05)


def test_rod_adds_a_second_harmonic_at_dead_centre_and_its_load() -> None:
    found = change(BY_NAME["connecting-rod"], 0.5)
    lam = A * 0.5
    y2 = -1j * A * lam / 4.0
    assert found.mean["displacement_aft"] == pytest.approx(-A * lam / 4.0, rel=1e-3)
    assert abs(found.of["displacement_aft"][2] - y2) < 1e-3 * abs(y2)
    assert abs(found.of["displacement_aft"][3]) < 1e-3 * abs(y2)
    assert abs(found.of["force"][2] - impedance(2) * y2) < 2e-3 * abs(impedance(2) * y2)


def test_ripple_once_a_revolution_gives_half_of_it_twice() -> None:
    found = change(BY_NAME["speed-ripple"], 0.01, TEETH_ORDER=1.0, TEETH_PHASE=0.0)
    y2 = A * 0.01 / 2.0
    # The teeth's own double at a tenth adds to the third harmonic, not to the second.
    assert abs(found.of["displacement_aft"][2]) == pytest.approx(y2, rel=0.02)
    assert abs(found.of["force"][2]) == pytest.approx(abs(impedance(2)) * y2, rel=0.02)


def test_light_shaft_under_load_gives_a_third_harmonic() -> None:
    inertia, run = 5.0, replace(HEAVE, periods=12)
    p = BY_NAME["load-ripple"].put(still(), 1.0 / inertia)
    y3 = phasors(p, run, settling=12.0).of["displacement_aft"][3]
    expected = A**3 * abs(impedance(1)) / (16.0 * inertia * W**2)
    assert abs(y3) == pytest.approx(expected, rel=0.05)


def test_tilted_slot_turns_one_strut() -> None:
    found = change(BY_NAME["slot-tilt"], 0.01)
    assert found.of["displacement_aft"][1] == pytest.approx(1j * A * np.tan(0.01), rel=1e-3)
    assert abs(found.of["displacement_fore"][1]) < 1e-9


def test_play_held_by_friction_lags() -> None:
    half = 1e-4
    found = change(BY_NAME["joint-play"], half)
    assert found.of["displacement_aft"][1].imag == pytest.approx(-4.0 * half / PI, rel=0.06)


def test_exponential_memory_obeys_kramers_and_kronig() -> None:
    p, rate, strength = still(), 5.0, 300.0
    p[P.MEMORY_0], p[P.MEMORY_RATE], p[P.MEMORY_SHAPE] = strength, rate, 0.0
    found = (phasors(p, settling=6.0) - phasors(still())).of["force"][1]
    added, damping = -strength / (rate**2 + W**2), strength * rate / (rate**2 + W**2)
    expected = complex(-added * W**2 * A, damping * W * A)
    assert abs(found - expected) < 0.01 * abs(expected)


def test_warming_zero_reads_as_an_in_phase_force_that_falls_with_the_order() -> None:
    slope = 0.01
    found = change(BY_NAME["zero-drift"], slope).of["force_aft"]
    per_period = slope / HEAVE.frequency_hz
    for order in (1, 2, 3):
        assert found[order].real == pytest.approx(-per_period / (PI * order), rel=0.08)


def test_late_mark_turns_every_channel_alike() -> None:
    late, clean = 0.02, phasors(still())
    turned = phasors(BY_NAME["photocell-angle"].put(still(), late))
    for name in ("displacement_aft", "force_fore"):
        assert turned.of[name][1] == pytest.approx(clean.of[name][1] * np.exp(1j * late), rel=1e-3)


def test_late_pulse_turns_in_proportion_to_frequency() -> None:
    for frequency in (0.5, 1.0):
        run = replace(HEAVE, frequency_hz=frequency)
        turned = phasors(BY_NAME["photocell-delay"].put(still(), 2e-3), run)
        angle = np.angle(turned.of["displacement_aft"][1])
        assert angle == pytest.approx(2.0 * PI * frequency * 2e-3, rel=0.02)


def test_friction_above_the_dynamometers_shows_in_no_force() -> None:
    p = still()
    p[P.GUIDE_COULOMB] = 5.0
    found = (phasors(p) - phasors(still())).of["force"]
    assert np.abs(found).max() < 2e-4 * abs(impedance(1) * A)


def test_dead_weight_takes_up_a_joint_that_the_load_throws_about() -> None:
    def third(preload: float) -> float:
        p = still()
        p[P.GAUGE_STIFFNESS], p[P.GAUGE_DAMPING] = 2e7, 2e4
        run = replace(HEAVE, preload_n=preload)
        clean = phasors(p, run)
        p[P.KNOCK] = 1e-4
        return float(abs((phasors(p, run) - clean).of["force"][3]))

    square_wave = 4.0 * 1e-4 / (3.0 * PI)
    # Flight and impact can only add to what a square wave of the clearance would load.
    assert third(0.0) > abs(impedance(3)) * square_wave
    assert third(400.0) < 0.01 * third(0.0)
