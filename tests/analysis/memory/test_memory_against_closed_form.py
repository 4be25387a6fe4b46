"""A memory of known poles, put into the simulated hull and found again from its harmonics.

The truth is the closed form of damped cosines; what was found is also held against scipy's own
frequency response and impulse response, and against the relations between added mass and damping
(Ogilvie 1964) by quadrature.
"""

from collections.abc import Callable
from functools import cache

import control
import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import StateSpace, impulse

from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.names import Form
from analysis.memory.fit import fit_measured
from analysis.memory.measured_matrices import measured_matrices
from analysis.memory.result import MeasuredMemory
from tests.analysis.memory import planted

IN_BAND = np.linspace(2.0 * np.pi * 0.3, 2.0 * np.pi * 1.7, 41)
FORMS = {planted.many_lines: Form.MANOEUVRING, planted.single_sines: Form.SEAKEEPING}


@cache
def found(runs: Callable[..., object], remembers: bool = True) -> MeasuredMemory:
    request = Request(FORMS[runs], nonlinear=False, zero_frequency=False)  # type: ignore[index]
    result = campaign_coefficients(runs(1, remembers=remembers), request)  # type: ignore[arg-type]
    (measured,) = measured_matrices(result)
    return fit_measured(measured)


@pytest.mark.parametrize("runs", FORMS)
def test_curves_are_the_planted_ones_within_their_intervals(runs: Callable[..., object]) -> None:
    one = found(runs)
    assert one.chosen.states == 4
    told = one.curves(IN_BAND)
    true = planted.curves(IN_BAND).ravel()
    half = told.half_width(0.95)
    assert (np.abs(told.values - true) <= 2.0 * half + 1e-4 * np.abs(true)).all()
    size = np.abs(planted.curves(IN_BAND)).max(axis=2).repeat(IN_BAND.size)
    assert (half < 0.02 * size).all(), "intervals that say something"


@pytest.mark.parametrize("runs", FORMS)
def test_poles_and_ends_are_the_planted_ones_within_their_intervals(
    runs: Callable[..., object],
) -> None:
    one = found(runs)
    true = np.sort_complex(
        [-a / 2.0 + 1j * np.sqrt(b - a * a / 4.0) for a, b in (planted.SWAY, planted.YAW)]
    )
    order = np.argsort(-one.poles.real)[::-1]
    rates = one.rates()
    both = np.stack([rates.values.reshape(2, -1), rates.half_width(0.95).reshape(2, -1)])[
        ..., order
    ]
    assert np.abs(both[0, 0] - true.real) == pytest.approx(0.0, abs=float(2.0 * both[1, 0].max()))
    assert np.abs(both[0, 1] - true.imag) == pytest.approx(0.0, abs=float(2.0 * both[1, 1].max()))
    ends = one.ends()
    expected = [x[e] for e in planted.ELEMENTS for x in (planted.INFINITE, planted.STEADY)]
    assert (np.abs(ends.values - expected) <= 2.0 * ends.half_width(0.95)).all()
    skew = one.measured.skew
    assert abs(skew.values[0] - planted.SKEW) <= 2.0 * skew.half_width(0.95)[0]
    assert not one.measured.coupling_differs
    assert one.damping_matrix()[0, 1] - one.damping_matrix()[1, 0] == pytest.approx(
        2.0 * skew.values[0]
    )


@pytest.mark.parametrize("runs", FORMS)
def test_scipy_and_control_answer_as_planted_by_the_state_space(
    runs: Callable[..., object],
) -> None:
    radiation = found(runs).radiation
    time = np.linspace(0.0, 3.0, 301)
    largest = [np.abs(planted.memory((k, k), IN_BAND)).max() for k in (0, 1)]
    for row, column in planted.ELEMENTS:
        system = StateSpace(
            radiation.state_matrix, radiation.input_matrix[:, [column]],
            radiation.output_matrix[[row]], [[0.0]],
        )  # fmt: skip
        true = planted.kernel((row, column), time)
        assert impulse(system, T=time)[1] == pytest.approx(true, abs=0.02 * np.abs(true).max())
        other = control.ss(system.A, system.B, system.C, system.D)
        response = control.frequency_response(other, IN_BAND).complex.ravel()
        exact = planted.memory((row, column), IN_BAND)
        size = np.sqrt(largest[row] * largest[column])
        assert np.abs(np.asarray(response) - exact).max() < 0.02 * size


def test_added_mass_follows_from_damping_by_quadrature() -> None:
    """Ogilvie: K(t) = 2/pi int B cos wt dw; A = A_inf - 1/w int K sin wt dt."""
    radiation = found(planted.many_lines).radiation

    def damping(omega: float) -> float:
        return float(radiation.damping(np.array([omega]))[0, 0, 0])

    time = np.linspace(0.0, 6.0, 241)
    omega = np.concatenate([np.linspace(0.0, 60.0, 6001), np.geomspace(60.5, 6e3, 2000)])
    spectrum = radiation.damping(omega)[:, 0, 0]
    waves = np.cos(np.outer(time, omega[:6001]))
    kernel = 2.0 / np.pi * np.trapezoid(waves * spectrum[:6001], omega[:6001], axis=1)
    # Beyond, B falls as c/w^2: int c/w^2 cos wt dw by parts of quad's own cosine weight.
    tail = spectrum[6000] * omega[6000] ** 2
    kernel += [2.0 / np.pi * _tail(tail, float(t)) for t in time]
    for at in (2.5, 5.0, 9.0):
        by_quadrature = 60.0 - np.trapezoid(kernel * np.sin(at * time), time) / at
        told = radiation.added_mass(np.array([at]))[0, 0, 0]
        assert by_quadrature == pytest.approx(told, rel=5e-3)
        assert damping(at) > 0.0


def _tail(strength: float, time_s: float) -> float:
    if time_s == 0.0:
        return strength / 60.0
    return float(quad(lambda w: strength / w**2, 60.0, np.inf, weight="cos", wvar=time_s)[0])


@pytest.mark.parametrize("runs", FORMS)
def test_no_motion_takes_energy_from_the_water(runs: Callable[..., object]) -> None:
    omega = np.geomspace(1e-3, 1e4, 600)
    lowest = np.linalg.eigvalsh(found(runs).radiation.damping(omega))[:, 0]
    assert lowest.min() > -1e-9 * np.abs(lowest).max()
    steady = found(runs).damping_matrix()
    assert np.linalg.eigvalsh(steady + steady.T)[0] >= 0.0


def test_a_hull_without_memory_has_none() -> None:
    one = found(planted.single_sines, remembers=False)
    assert one.chosen.states == 0
    assert one.poles.size == 0
    ends = one.ends()
    expected = [x[e] for e in planted.ELEMENTS for x in (planted.INFINITE, planted.STEADY)]
    assert (np.abs(ends.values - expected) <= 2.0 * ends.half_width(0.95)).all()
