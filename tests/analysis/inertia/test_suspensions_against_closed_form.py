"""Bifilar, double and compound pendulums, beats, incline and principal axes, there and back."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from analysis.inertia.beats import BeatCount, beat_period, count_beats
from analysis.inertia.bifilar import (
    resonance_flags,
    sway_period,
    yaw_from_beats,
    yaw_gyradius,
    yaw_period,
)
from analysis.inertia.compound_pendulum import compound_pendulum, lamboley
from analysis.inertia.corrections import gravity_in_air, square_frame, without_entrained_air
from analysis.inertia.double_pendulum import (
    LineLengthReading,
    best_line_length,
    depth_from_periods,
    gyradius_error_per_period,
    gyradius_from_periods,
    mode_periods,
    pitch_from_periods,
)
from analysis.inertia.inclining_test import (
    incline_depth,
    incline_from_both_ends,
    incline_from_one_end,
)
from analysis.inertia.modulation import remove_modulation
from analysis.inertia.plane_inertia import plane_inertia
from analysis.inertia.principal_axes import (
    inertia_ellipse,
    principal_angle,
    principal_axes,
    principal_gyradii,
    roll_from_three_yaws,
    roll_from_tilts,
)
from analysis.inertia.spread import SuspensionGyradius, compare_geometries
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError, DataError
from tests.analysis.inertia.paper_formulas import (
    bifilar_amplitude_factor,
    gyradius_about,
    gyradius_with_end_masses,
    oscillations_per_beat,
    pendulum_period,
)
from tests.analysis.inertia.records import G, damped

lengths = st.floats(0.05, 4.0)


@given(k=lengths, d=lengths, line=lengths)
def test_yaw_there_and_back(k: float, d: float, line: float) -> None:
    assert yaw_gyradius(yaw_period(k, d, line, G), d, line, G) == pytest.approx(k, rel=1e-12)


@given(k=lengths, depth=lengths, line=lengths)
def test_double_pendulum_there_and_back(k: float, depth: float, line: float) -> None:
    slow, fast = mode_periods(k, depth, line, G)
    sway = sway_period(line, G)
    assert slow > sway > fast
    assert gyradius_from_periods(slow, fast, sway, G) == pytest.approx(k, rel=1e-6)
    assert depth_from_periods(slow, fast, sway, G) == pytest.approx(depth, rel=1e-6)


@given(k=lengths, depth=lengths, line=lengths)
def test_double_pendulum_against_its_matrices(k: float, depth: float, line: float) -> None:
    """Mass and stiffness of the two angles, solved as an eigenvalue problem."""
    mass = np.array([[line, depth], [line * depth, depth**2 + k**2]])
    mass[0] *= line
    mass[0, 1] = line * depth
    stiffness = np.diag([G * line, G * depth])
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    expected = 2.0 * np.pi / np.sqrt(squares)
    assert mode_periods(k, depth, line, G) == pytest.approx(tuple(expected), rel=1e-6)


def test_best_line_of_both_readings() -> None:
    assert best_line_length(0.352, 0.253, G) == pytest.approx(0.498, abs=1e-3)
    assert best_line_length(1.156, 1.156 / 1.5, G) == pytest.approx(1.76, abs=0.01)
    assert best_line_length(0.352, 0.253, G, LineLengthReading.JOINT) == pytest.approx(
        0.29, abs=0.005
    )
    assert best_line_length(1.156, 1.156 / 1.5, G, LineLengthReading.JOINT) == pytest.approx(
        1.16, abs=0.05
    )
    best = best_line_length(0.352, 0.253, G)
    least = gyradius_error_per_period(0.352, 0.253, best, G)
    for line in (0.8 * best, 1.25 * best):
        assert gyradius_error_per_period(0.352, 0.253, line, G) > least


def test_periods_out_of_order_are_of_the_wrong_axis() -> None:
    slow, fast = (exactly(v, "s") for v in mode_periods(0.352, 0.253, 1.0, G))
    yaw = exactly(yaw_period(0.36, 0.28, 1.5, G), "s")
    with pytest.raises(DataError, match="wrong axis"):
        pitch_from_periods(slow, fast, yaw, exactly(G))


def test_resonance_is_warned_of() -> None:
    slow, _ = mode_periods(0.352, 0.253, 1.560, G)
    assert resonance_flags(yaw_period(0.303, 0.28, 1.560, G), slow)[0].code == "yaw_pitch_resonance"
    slow, _ = mode_periods(0.352, 0.253, 0.504, G)
    assert resonance_flags(yaw_period(0.303, 0.28, 0.504, G), slow) == ()


@pytest.mark.parametrize(("yaw", "sway"), [(4.39, 3.83), (4.2, 3.9), (3.6, 3.83)])
def test_beats_are_counted_as_the_periods_say(yaw: float, sway: float) -> None:
    t = np.arange(0.0, 4.0 * abs(beat_period(yaw, sway)), 0.02)
    y = damped(t, yaw, 1e-3, 1.0, 0.3) + damped(t, sway, 1e-3, 1.0, -0.8)
    count = count_beats(t, y)
    assert count.beats >= 2
    expected = abs(oscillations_per_beat(yaw, sway))
    assert count.oscillations / count.beats == pytest.approx(expected, rel=0.02)
    k = yaw_from_beats(count, exactly(0.9, "m"), yaw_slower=yaw > sway)
    assert k.result.value == pytest.approx(0.9 * yaw / sway, rel=4e-3)


def test_no_whole_beat_is_refused() -> None:
    t = np.arange(0.0, 20.0, 0.05)
    with pytest.raises(DataError, match="two are needed for one whole beat"):
        count_beats(t, np.cos(t))
    with pytest.raises(DataError, match="one whole beat"):
        yaw_from_beats(BeatCount(4.0, 0.5), exactly(0.9, "m"))


def test_modulation_is_removed_from_gate_periods() -> None:
    t = np.arange(0.0, 220.0, 4.4)
    wave = 0.018 * np.exp(-t / 124.0) * np.sin(2.0 * np.pi * t / 28.3 + 0.4)
    period = 4.391 * (1.0 - 2e-5 * (t - t.mean()) + wave)
    period = period + 5e-4 * np.random.default_rng(0).standard_normal(t.size)
    found = remove_modulation(t, period)
    assert found.period_s == pytest.approx(4.391, abs=5e-4)
    assert found.trend_1_s == pytest.approx(-2e-5, abs=3e-6)
    assert found.modulation_period_s == pytest.approx(28.3, rel=5e-3)
    assert found.modulation_depth == pytest.approx(0.018, rel=0.05)
    assert found.uncertainty_s < 5e-4
    with pytest.raises(DataError, match="at least 16"):
        remove_modulation(t[:10], period[:10])


@pytest.mark.slow
@given(k=lengths, a=lengths, h=st.floats(0.1, 1.0))
@settings(max_examples=25, deadline=None)
def test_compound_and_lamboley(k: float, a: float, h: float) -> None:
    first, second = pendulum_period(k, a, G), pendulum_period(k, a + h, G)
    one = compound_pendulum(exactly(first), exactly(a), exactly(G))
    assert one.result.value == pytest.approx(k, rel=1e-6)
    scale = G / (4.0 * math.pi**2)
    if abs(2.0 * h - (second**2 - first**2) * scale) > 1e-2 * h:
        depth, both = lamboley(exactly(first), exactly(second), exactly(h), exactly(G))
        assert depth.result.value == pytest.approx(a, rel=1e-4)
        assert both.result.value == pytest.approx(k, rel=1e-4)


def test_depth_drops_out_where_it_equals_the_gyradius() -> None:
    period = Estimate.of(pendulum_period(0.5, 0.5, G), 0.0, "s")
    found = compound_pendulum(period, Estimate.of(0.5, 1e-3, "m"), exactly(G))
    assert found.budget.result.uncertainty < 1e-6


def test_incline_from_one_end_and_from_both() -> None:
    mass, md, depth, ls, lb, bs, bb = 13.18, 0.2, 0.25, 0.9, 0.85, -0.05, 0.02
    stern = math.atan2(md * ls, mass * depth + md * bs)
    bow = math.atan2(md * lb, mass * depth + md * bb)
    weight, whole = exactly(md, "kg"), exactly(mass, "kg")
    one = incline_from_one_end(weight, whole, exactly(ls), exactly(bs), exactly(stern))
    assert one.result.value == pytest.approx(depth, rel=1e-9)
    both = incline_from_both_ends(
        weight, whole, exactly(ls + lb), (exactly(bs), exactly(bb)), (exactly(stern), exactly(bow))
    )
    assert both.result.value == pytest.approx(depth, rel=1e-9)
    assert incline_depth(md, mass, ls, bs, stern) == pytest.approx(depth)
    with pytest.raises(ConfigurationError, match="mass_kg = 0"):
        incline_from_one_end(weight, exactly(0.0), exactly(ls), exactly(bs), exactly(stern))


@given(px=st.floats(0.2, 0.6), more=st.floats(0.2, 1.0), psi=st.floats(-0.3, 0.3))
def test_principal_axes_there_and_back(px: float, more: float, psi: float) -> None:
    pz = px + more
    kx, kz = gyradius_about(px, pz, psi + math.pi / 2.0), gyradius_about(px, pz, psi)
    for phi in (0.5, -0.4):
        tilted = gyradius_about(px, pz, psi + phi)
        assert principal_angle(kx, kz, tilted, phi) == pytest.approx(psi, abs=1e-9)
    assert principal_gyradii(kx, kz, psi) == pytest.approx((px, pz), rel=1e-9)
    a, b = gyradius_about(px, pz, psi + 0.5), gyradius_about(px, pz, psi - 0.4)
    assert roll_from_tilts(kz, a, b, 0.5, -0.4) == pytest.approx(kx, rel=1e-6)
    squares = [exactly(v**2, "kg m2") for v in (kz, a, b)]
    plane = plane_inertia(squares, [exactly(phi) for phi in (0.0, 0.5, -0.4)])
    assert plane.uncertain.values[:2] == pytest.approx([kx**2, kz**2], rel=1e-6)
    assert plane.principal_angle.value == pytest.approx(psi, abs=1e-6)


def test_axes_a_right_angle_apart_need_no_angle() -> None:
    a, b, z = 0.9, 0.8, 1.0
    found = roll_from_tilts(z, a, b, 0.4 + math.pi / 2.0, 0.4)
    assert found == pytest.approx(math.sqrt(a**2 + b**2 - z**2))


def test_tilts_that_tell_nothing_are_refused() -> None:
    k = exactly(0.3, "m")
    with pytest.raises(DataError, match="tells nothing"):
        principal_axes(exactly(0.2), k, k, exactly(0.001))
    with pytest.raises(DataError, match="too near to each other"):
        roll_from_three_yaws(k, k, k, exactly(0.3), exactly(0.31))
    with pytest.raises(DataError, match="too near to each other"):
        plane_inertia([k, k, k], [exactly(phi) for phi in (0.0, 0.01, 0.02)])


def test_roll_from_tilts_is_as_sensitive_as_the_paper_says() -> None:
    px, pz = 0.625, 1.057
    u = 1e-3
    kz, a, b = (
        Estimate.of(gyradius_about(px, pz, angle), u, "m")
        for angle in (0.0, math.radians(30), math.radians(-30))
    )
    found = roll_from_three_yaws(
        kz, a, b, exactly(math.radians(30), "rad"), exactly(math.radians(-30), "rad")
    )
    assert found.budget.result.uncertainty == pytest.approx(7e-3, abs=0.7e-3)


def test_ellipse() -> None:
    ellipse = inertia_ellipse(0.5, 1.0, 0.0)
    assert np.hypot(*ellipse.T).max() == pytest.approx(2.0)
    assert np.hypot(*ellipse.T).min() == pytest.approx(1.0)


def test_bifilar_period_at_an_amplitude_against_the_exact_motion() -> None:
    """Quarter period by energy: exact height of the lines, heave's kinetic energy included."""
    k, d, line, top = 0.34, 0.546, 1.2, 0.15

    def height(angle: np.ndarray) -> np.ndarray:
        return line - np.sqrt(line**2 - 4.0 * d**2 * np.sin(angle / 2.0) ** 2)

    s = (np.arange(20000) + 0.5) / 20000 * math.pi / 2.0
    angle = top * np.sin(s)
    rise = d**2 * np.sin(angle) / np.sqrt(line**2 - 4.0 * d**2 * np.sin(angle / 2.0) ** 2)
    speed = np.sqrt(2.0 * G * (height(np.array(top)) - height(angle)) / (k**2 + rise**2))
    quarter = float((top * np.cos(s) / speed).mean() * math.pi / 2.0)
    factor = 4.0 * quarter / yaw_period(k, d, line, G)
    assert bifilar_amplitude_factor(top, k, d, line) - 1.0 == pytest.approx(factor - 1.0, rel=0.03)


def test_corrections() -> None:
    assert gravity_in_air(G, 1.2, 800.0) == pytest.approx(G * 0.9985)
    assert without_entrained_air(700.0, 2.0, 0.5, 1.0) == pytest.approx(699.0)
    level, upright = square_frame(0.9, 0.7)
    # four rods of a quarter of the mass each
    side = 0.9
    rod = (2.0 * side) ** 2 / 12.0
    assert upright**2 == pytest.approx(rod + side**2)
    assert level**2 == pytest.approx(0.5 * rod + 0.5 * side**2 + 0.7**2)
    even = gyradius_with_end_masses(600.0, 1.0, 1.2, 3.0, 3.0)
    assert even == pytest.approx(math.sqrt((600.0 + 2.4 * 9.0) / 602.4))


def test_lines_shorter_than_measured_are_said_to_be_shorter() -> None:
    """The gyradius follows the root of 1/line: lines that are 20 mm too short, on four lengths."""
    k, short, rows = 0.34, 0.02, []
    for d, line in ((0.2, 0.6), (0.3, 0.8), (0.5, 1.2), (0.5, 0.45)):
        seen = k * math.sqrt((line - short) / line)
        rows.append(SuspensionGyradius(f"{line}", Estimate.of(seen, 1e-5, "m"), d, line))
    cause = compare_geometries(rows).causes[0]
    assert str(cause).startswith("the lines are shorter than measured, 0.02")
