"""Oracles: the catalogue's mode frequencies and delay, the dispersion relation, the Lorentzian."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from sim.model.water.radiation import Radiation, constant
from sim.model.water.tank import (
    Tank,
    blockage_speed_factor,
    echo_delay_s,
    group_velocity_m_s,
    wave_number,
    with_walls,
)
from tests.sim.model.water.passivity import is_passive

G = 9.81
TANK = Tank(breadth_m=4.2, depth_m=2.1, modes=3, gravity_m_s2=G)


def open_water() -> Radiation:
    """Damping of heave and pitch with coupling, that of a resonance at 4 rad/s."""
    state = np.array([[0.0, 4.0], [-4.0, -3.0]])
    inputs = np.array([[0.0, 0.0], [10.0, 2.0]])
    return Radiation(np.diag([40.0, 9.0]), state, inputs, inputs.T)


def test_mode_frequencies_of_the_catalogue() -> None:
    """W = 4.2 m: 3.82, 5.42, 6.64 rad/s for heave; 2.59, 4.69, 6.06 for sway."""
    vertical = TANK.mode_frequencies_rad_s(Plane.VERTICAL)
    horizontal = TANK.mode_frequencies_rad_s(Plane.HORIZONTAL)
    np.testing.assert_allclose(vertical, [3.82, 5.42, 6.64], atol=0.011)
    np.testing.assert_allclose(horizontal, [2.59, 4.69, 6.06], atol=0.011)


def test_clean_cycles_of_the_catalogue() -> None:
    """W = 4.2 m, w = 5 rad/s, deep water: 3.4 periods before the first echo."""
    deep = Tank(4.2, 50.0, gravity_m_s2=G)
    assert echo_delay_s(5.0, deep) * 5.0 / (2.0 * math.pi) == pytest.approx(3.4, abs=0.01)


@given(omega=st.floats(1e-3, 100.0), depth=st.floats(0.01, 1e4))
def test_dispersion_relation(omega: float, depth: float) -> None:
    k = wave_number(omega, depth, G)
    assert G * k * math.tanh(k * depth) == pytest.approx(omega**2, rel=1e-9)


@pytest.mark.parametrize("omega", [0.5, 2.0, 6.0])
def test_group_velocity_is_the_slope_of_the_dispersion(omega: float) -> None:
    step = 1e-5 * omega
    slope = 2 * step / (wave_number(omega + step, 1.3, G) - wave_number(omega - step, 1.3, G))
    assert group_velocity_m_s(omega, 1.3, G) == pytest.approx(slope, rel=1e-7)
    assert group_velocity_m_s(omega, 1e4, G) == pytest.approx(G / (2 * omega), rel=1e-9)
    assert group_velocity_m_s(omega * 1e-4, 1.3, G) == pytest.approx(math.sqrt(G * 1.3), rel=1e-6)


def test_one_mode_is_a_lorentzian() -> None:
    """Damping at w_m grows by the strength, added mass by nothing there and +-b/(2 w) beside it."""
    tank = Tank(4.2, 2.1, modes=1, strength=0.4, damping_ratio=0.01, gravity_m_s2=G)
    before, after = open_water(), with_walls(open_water(), tank, Plane.VERTICAL)
    (w_m,) = tank.mode_frequencies_rad_s(Plane.VERTICAL)
    peak = 0.4 * before.damping(w_m)
    np.testing.assert_allclose(after.damping(w_m) - before.damping(w_m), peak, rtol=1e-9)
    omega = w_m * np.array([0.5, 0.99, 1.0, 1.01, 2.0])
    u = omega / w_m
    shape = 2j * 0.01 * u / (1.0 - u**2 + 2j * 0.01 * u)
    added = after.added_mass(omega) - before.added_mass(omega)
    expected = shape.imag[:, None, None] / omega[:, None, None] * peak
    np.testing.assert_allclose(added, expected, atol=1e-12 * np.abs(expected).max())
    np.testing.assert_allclose(added[1], peak / (2.0 * omega[1]), rtol=0.03)
    np.testing.assert_allclose(added[3], -peak / (2.0 * omega[3]), rtol=0.03)


@pytest.mark.parametrize("plane", list(Plane))
def test_walls_keep_the_radiation_passive(plane: Plane) -> None:
    walled = with_walls(open_water(), TANK, plane)
    assert is_passive(walled)
    # One independent motion radiates, so each of three modes has two states.
    assert walled.states == open_water().states + 6
    np.testing.assert_array_equal(walled.added_mass_infinite, open_water().added_mass_infinite)


def test_nothing_radiates_nothing_comes_back() -> None:
    still = constant(np.diag([40.0, 9.0]))
    assert with_walls(still, TANK, Plane.VERTICAL) == still


def test_blockage_by_continuity() -> None:
    assert blockage_speed_factor(0.08, 8.0) == pytest.approx(8.0 / 7.92)
    with pytest.raises(ConfigurationError, match="below the tank's 1"):
        blockage_speed_factor(1.0, 1.0)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"breadth_m": 0.0}, "breadth_m = 0.0 must be positive"),
        ({"damping_ratio": 1.0}, "damping_ratio = 1.0 must be between"),
        ({"strength": -1.0}, "strength = -1.0"),
        ({"modes": -1}, "modes = -1"),
    ],
)
def test_tanks_that_cannot_be(change: dict[str, float], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        Tank(**{"breadth_m": 4.2, "depth_m": 2.1, **change})  # type: ignore[arg-type]
