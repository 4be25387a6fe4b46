"""Memory in time against its coefficients over frequency, and these against quadrature."""

import csv
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from tests.sealed.closed_forms import HEAVE, phasors, still
from tests.sealed.generator.mechanism import retardation
from tests.sealed.generator.parameters import P
from tests.sealed.generator.water import (
    coefficients,
    damped_wave,
    of_memory,
    remembering,
    table_of,
    table_text,
    varied,
)
from tests.sealed.generator.worlds import world

RUNS = tuple(replace(HEAVE, frequency_hz=f) for f in (0.45, 0.7, 1.1))
BAND = 2.0 * np.pi * np.geomspace(0.45, 1.1, 17)


@pytest.mark.parametrize("omega", [1.5, 4.0, 9.0])
def test_coefficients_are_the_kernel_s_transform(omega: float) -> None:
    rate, turn = 2.2, 4.5

    def kernel(t: float) -> float:
        return float(damped_wave(rate, turn, np.array(t)))

    sine = quad(kernel, 0.0, 15.0, weight="sin", wvar=omega)[0]
    cosine = quad(kernel, 0.0, 15.0, weight="cos", wvar=omega)[0]
    added, damping = of_memory(rate, turn, np.array([omega]))
    assert added[0] == pytest.approx(-sine / omega, abs=1e-6)
    assert damping[0] == pytest.approx(cosine, abs=1e-6)


@pytest.mark.slow
def test_damping_over_frequency_gives_the_kernel_back() -> None:
    """Ogilvie: K(t) = 2/pi times the integral of B cos(w t); so cause comes before effect."""
    rate, turn = 2.2, 4.5
    omega = np.linspace(1e-4, 4000.0, 4_000_001)
    damping = of_memory(rate, turn, omega)[1]
    for t in (0.2, 0.7, 1.4):
        back = 2.0 / np.pi * np.trapezoid(damping * np.cos(omega * t), omega)
        assert back == pytest.approx(damped_wave(rate, turn, np.array(t)), abs=1e-3)


@pytest.mark.slow  # the time loop takes 20 s to compile
@pytest.mark.parametrize("frequency", [0.5, 0.8, 1.1])
def test_a_run_has_the_impedance_of_its_frequency(frequency: float) -> None:
    p = remembering(still(), RUNS, world("B"), np.random.default_rng(3))
    run, omega = replace(HEAVE, frequency_hz=frequency), 2.0 * np.pi * frequency
    added, damping = (rows[0, 0] for rows in coefficients(p, np.array([omega])))
    seen = phasors(p, run).of
    load = p[P.RESTORING_00] - (p[P.MASS] + added) * omega**2 + 1j * damping * omega
    expected = load * seen["displacement_aft"][1]
    assert abs(seen["force"][1] - expected) < 1e-3 * abs(expected)


def test_water_keeps_its_level_and_its_tolerance() -> None:
    here, p = world("B"), still()
    for seed in range(20):
        q = remembering(p, RUNS, here, np.random.default_rng(seed))
        for values, place in zip(coefficients(q, BAND), (P.ADDED_00, P.DAMPING_00), strict=True):
            level = p[[place, place + 3]]
            assert values.mean(axis=0) == pytest.approx(level, rel=1e-9)
            octaves = np.log2(BAND[-1] / BAND[0])
            slope = np.ptp(values, axis=0) / level / octaves
            assert slope.max() <= here.draws["memory_per_octave"][1] * (1.0 + 1e-9)


def test_a_change_per_octave_and_with_speed_is_what_it_says() -> None:
    p = still()
    p[P.MIDDLE_HZ], p[P.MIDDLE_SPEED] = 0.5, 1.0
    p[P.ADDED_SLOPE_0], p[P.DAMPING_BEND_1], p[P.DAMPING_SPEED] = 0.05, 0.02, 0.1
    q = p.copy()
    varied(q, replace(HEAVE, frequency_hz=1.0, carriage_speed_m_s=1.3))
    assert q[P.ADDED_00] == pytest.approx(1.05 * p[P.ADDED_00])
    assert q[P.DAMPING_11] == pytest.approx((1.0 + 0.02 + 0.03) * p[P.DAMPING_11])
    assert q[P.DAMPING_00] == pytest.approx(1.03 * p[P.DAMPING_00])


def test_believed_table_is_off_by_level_and_slope_at_most() -> None:
    here = world("B")
    p = remembering(still(), RUNS, here, np.random.default_rng(5))
    p[P.MIDDLE_HZ] = 0.7
    found = table_of(p, here, np.random.default_rng(8))
    added, damping = coefficients(p, found.omega_rad_s)
    lasting = p[[P.DAMPING_00, P.DAMPING_11]]
    for said, true in ((found.added, added), (found.damping, damping - lasting)):
        assert np.abs(said / true - 1.0).max() < 0.12 + 2.0 * 0.05 + 1e-9
    rows = list(csv.DictReader(table_text(found, "vertical").splitlines()))
    assert len(rows) == 4 * len(found.omega_rad_s)
    heave = [float(r["added_mass_SI"]) for r in rows
             if r["radiating_dof"] == r["influenced_dof"] == "Heave"]  # fmt: skip
    assert heave == pytest.approx(found.added[:, 0].tolist(), rel=1e-6)


def test_slow_tail_and_standing_wave_are_where_they_belong() -> None:
    p = still()
    p[P.MEMORY_0], p[P.MEMORY_RATE], p[P.MEMORY_SHAPE] = 100.0, 5.0, 2.0
    tail = retardation(p, 0.01)[0]
    assert tail[200] == pytest.approx(100.0 / 121.0)
    q = still()
    q[P.ECHO], q[P.ECHO_DELAY], q[P.ECHO_SHAPE] = 0.2, 1.0, 1.0
    spectrum = np.abs(np.fft.rfft(retardation(q, 0.01)[0], 2048))
    assert np.argmax(spectrum) / 2048 / 0.01 == pytest.approx(1.0, abs=0.06)


def test_no_wave_is_radiated_at_frequency_0() -> None:
    damping = of_memory(2.2, 4.5, np.array([1e-4, 4.5]))[1]
    assert damping[0] < 1e-8 * damping[1]
