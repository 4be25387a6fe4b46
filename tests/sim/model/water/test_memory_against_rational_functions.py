"""Oracles: waters with poles in closed form, other integrators, and tables that none follows."""

import math

import numpy as np
import pytest
from scipy.integrate import quad_vec, simpson, solve_ivp

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.oscillator import Plane
from sim.model.water.memory import fit_memory
from sim.model.water.tables import RadiationTable
from tests.sim.model.water.ladder import Ladder
from tests.sim.model.water.passivity import is_passive
from tests.sim.model.water.retardation import retardation

OMEGA = np.geomspace(0.3, 20.0, 30)
POLES = np.array([-1.2 + 3.0j, -2.5 + 7.0j])
STRENGTH = np.array([150.0, 90.0])
INFINITE = 40.0


def rational(s: ComplexArray) -> ComplexArray:
    """K(s) = sum g s/((s - p)(s - p*)): two damped waves, passive each."""
    parts = [g * s / ((s - p) * (s - p.conjugate())) for g, p in zip(STRENGTH, POLES, strict=True)]
    return np.sum(parts, axis=0)


def heave(omega: FloatArray, memory: ComplexArray, infinite: float = INFINITE) -> RadiationTable:
    unit = np.array([[1.0, 0.0], [0.0, 0.0]])
    a = (infinite + memory.imag / omega)[:, None, None] * unit
    b = memory.real[:, None, None] * unit
    return RadiationTable(Plane.VERTICAL, omega, a, b, name="heave")


def test_the_poles_and_the_number_of_states_come_back() -> None:
    fit = fit_memory(heave(OMEGA, rational(1j * OMEGA)))
    found = np.linalg.eigvals(fit.radiation.state_matrix)
    found = np.sort_complex(found[found.imag > 0.0])
    np.testing.assert_allclose(found, np.sort_complex(POLES), rtol=1e-4)
    assert fit.radiation.states == 4
    assert fit.radiation.added_mass_infinite[0, 0] == pytest.approx(INFINITE, rel=1e-5)
    assert fit.error < 2e-5
    assert is_passive(fit.radiation)


def test_the_states_do_what_the_closed_forms_convolution_does() -> None:
    """mu = int K(t - s) v(s) ds, each damped wave integrated by itself (Runge-Kutta)."""
    fit = fit_memory(heave(OMEGA, rational(1j * OMEGA)))
    times = np.linspace(0.0, 6.0, 61)

    def velocity(t: float) -> float:
        return math.sin(2.0 * t) * math.exp(-0.2 * t) + 0.5 * math.sin(6.1 * t)

    def waves(t: float, y: FloatArray) -> FloatArray:
        # x'' + 2 d x' + |p|^2 x = v, mu = g x'
        x, rate = y[:2], y[2:]
        damped = velocity(t) + 2.0 * POLES.real * rate - np.abs(POLES) ** 2 * x
        return np.concatenate([rate, damped])

    true = solve_ivp(waves, (0.0, 6.0), np.zeros(4), t_eval=times, rtol=1e-9, atol=1e-11)
    water = fit.radiation

    def states(t: float, y: FloatArray) -> FloatArray:
        return np.asarray(water.state_matrix @ y + water.input_matrix[:, 0] * velocity(t))

    begin = np.zeros(water.states)
    found = solve_ivp(states, (0.0, 6.0), begin, t_eval=times, rtol=1e-9, atol=1e-11)
    expected = STRENGTH @ true.y[2:]
    loads = water.output_matrix[0] @ found.y
    np.testing.assert_allclose(loads, expected, atol=1e-4 * np.abs(expected).max())


def test_the_fitted_kernel_gives_added_mass_and_damping_by_ogilvie() -> None:
    """A = A_inf - int K sin / w, B = int K cos: by quadrature of the fitted kernel alone."""
    water = fit_memory(heave(OMEGA, rational(1j * OMEGA))).radiation
    time = np.linspace(0.0, 16.0, 3201)
    kernel = retardation(water, time)[:, 0, 0]
    for omega in (1.0, 3.0, 8.0):
        both = simpson(kernel * np.array([np.sin(omega * time), np.cos(omega * time)]), time)
        memory = complex(rational(np.array([1j * omega]))[0])
        assert INFINITE - both[0] / omega == pytest.approx(INFINITE + memory.imag / omega, rel=1e-4)
        assert both[1] == pytest.approx(memory.real, rel=1e-3)


def slow_tail() -> RadiationTable:
    """K(t) = 100 exp(-t) cos 4t + 5 (1 + t)^-1.5: integrated over its phase, no finite states."""
    wave = 100.0 * (1.0 + 1j * OMEGA) / ((1.0 + 1j * OMEGA) ** 2 + 16.0)

    def rotated(x: float) -> ComplexArray:
        # t = -i x: exp(-i w t) becomes exp(-w x)
        return np.asarray(-1j * 5.0 * (1.0 - 1j * x) ** -1.5 * np.exp(-OMEGA * x))

    tail, _ = quad_vec(rotated, 0.0, np.inf, epsrel=1e-9)
    return heave(OMEGA, wave + tail)


@pytest.mark.sample(5)
@pytest.mark.parametrize("states", [None, *range(2, 13)])
def test_a_slow_tail_is_never_refused(states: int | None) -> None:
    fit = fit_memory(slow_tail(), states)
    assert is_passive(fit.radiation)
    assert fit.radiation.states == (states or fit.radiation.states)
    if states is None or states >= 8:
        assert fit.misfit < 0.01


@pytest.mark.parametrize("noise", [0.002, 0.01, 0.03])
def test_states_follow_the_tables_uncertainty(noise: float) -> None:
    """The truth comes out better than the noisy table has it, with no state for the noise."""
    true, generator = rational(1j * OMEGA), np.random.default_rng(7)
    off = 1.0 + noise * generator.normal(size=(2, OMEGA.size))
    a, b = (INFINITE + true.imag / OMEGA) * off[0], true.real * off[1]
    table = heave(OMEGA, b + 1j * OMEGA * (a - INFINITE))
    fit = fit_memory(table, uncertainty=1.2 * noise)
    assert fit.radiation.states <= 6
    assert is_passive(fit.radiation)
    found = fit.radiation.damping(OMEGA)[:, 0, 0]
    off = np.sqrt(np.mean((found / true.real - 1.0) ** 2))
    assert off < noise
    assert fit.misfit < 2.0 * noise


def test_a_table_that_is_not_passive_is_followed_as_far_as_water_can_and_said() -> None:
    true = rational(1j * OMEGA)
    dip = 0.04 * true.real.max() * np.exp(-((np.log(OMEGA / 15.0) / 0.2) ** 2))
    table = heave(OMEGA, true - 3.0 * dip * (OMEGA > 12.0) * (true.real < 3.0 * dip))
    assert table.damping[:, 0, 0].min() < 0.0
    fit = fit_memory(table)
    assert is_passive(fit.radiation)
    assert "is not passive: its damping is negative by 0.0" in str(fit)
    assert fit.misfit > fit.uncertainty
    assert "coefficients carry the misfit" in str(fit)


@pytest.mark.sample(3)
@pytest.mark.parametrize("seed", range(8))
def test_coupled_waters_come_back_with_their_coupling(seed: int) -> None:
    """Two coupled degrees of freedom of a water that is passive by its form."""
    ladder, generator = Ladder(2, 2), np.random.default_rng(seed)
    found = ladder.matrices(generator.normal(size=sum(map(len, ladder.bases))))
    resolvent = 1j * OMEGA[:, None, None] * np.eye(4) - found.state
    memory = found.input.T @ np.linalg.solve(
        resolvent, np.broadcast_to(found.input, (OMEGA.size, 4, 2))
    )
    a = np.diag([3.0, 2.0]) + memory.imag / OMEGA[:, None, None]
    a, b = ((one + one.swapaxes(1, 2)) / 2.0 for one in (a, memory.real))
    fit = fit_memory(RadiationTable(Plane.VERTICAL, OMEGA, a, b))
    assert is_passive(fit.radiation)
    assert fit.misfit < 0.02


def test_the_misfit_is_what_the_coefficients_carry() -> None:
    fit = fit_memory(slow_tail(), 3)
    k = 12
    added, damping = fit.standard_uncertainties(float(OMEGA[k]))
    off_a, off_b = np.sqrt(np.mean(fit.deviations()[:, :, 0, 0] ** 2, axis=1))
    assert added[0, 0] == pytest.approx(off_a * fit.table.added_mass[k, 0, 0])
    assert damping[0, 0] == pytest.approx(off_b * fit.table.damping[k, 0, 0], rel=0.05)
    assert added[1, 1] == damping[0, 1] == 0.0
