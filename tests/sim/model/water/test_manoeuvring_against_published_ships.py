"""Oracles: published time constants of the Mariner, and the units of KVLCC2's derivatives."""

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from tests.sim.manoeuvring import (
    Derivatives,
    PrimeSystem,
    added_mass_and_damping,
    from_added_mass_and_damping,
)

# Chislett and Stroem-Tejsen, prime system: Y_r and N_r are Y_r - m' and N_r - m' x_G'.
MARINER = Derivatives(
    ((-748e-5, -9.354e-5), (4.646e-5, -43.8e-5)), ((-1160e-5, -499e-5), (-264e-5, -166e-5))
)
MASS, INERTIA, CG = 798e-5, 39.2e-5, -0.023
LENGTH, SPEED, DENSITY = 160.93, 15.0 * 0.514444, 1025.0


def test_mariner_time_constants() -> None:
    """Nomoto's T_1 = 118 s and T_2 = 7.8 s at 15 knots, from M v' + (B + C) v = 0."""
    prime = PrimeSystem.prime(LENGTH, DENSITY)
    added, damping = map(
        np.array, added_mass_and_damping(prime.to_si(MARINER.without_mass(MASS, CG), SPEED))
    )
    m, inertia, x = prime.mass_si(MASS), prime.inertia_si(INERTIA), CG * LENGTH
    mass = np.array([[m, m * x], [m * x, inertia]])
    turning = SPEED * np.array([[0.0, m], [0.0, m * x]])  # y'' = v' + U r
    rates = np.linalg.eigvals(np.linalg.solve(mass + added, -(damping + turning))).real
    slow, fast = sorted(-1.0 / rates, reverse=True)
    assert slow == pytest.approx(118.0, abs=0.5)
    assert fast == pytest.approx(7.8, abs=0.05)


def test_mass_left_in_the_derivatives_is_added_back() -> None:
    velocity = MARINER.without_mass(MASS, CG).velocity
    assert velocity[0][1] == pytest.approx(299e-5)
    assert velocity[1][1] == pytest.approx(-(166 + 798 * 0.023) * 1e-5)


def test_kvlcc2_in_the_units_of_the_mmg() -> None:
    """(rho/2) L^2 d, L^4 d for inertias; (rho/2) L d U, L^2 d U, L^3 d U for the velocities."""
    length, draught, rho, speed = 7.0, 0.46, 1000.0, 1.179
    given = Derivatives(((-0.223, 0.0), (0.0, -0.011)), ((-0.315, 0.0), (-0.137, -0.049)))
    added, damping = added_mass_and_damping(
        PrimeSystem.mmg(length, draught, rho).to_si(given, speed)
    )
    half = rho / 2.0
    assert added[0][0] == pytest.approx(0.223 * half * length**2 * draught)
    assert added[1][1] == pytest.approx(0.011 * half * length**4 * draught)
    assert damping[0][0] == pytest.approx(0.315 * half * length * draught * speed)
    assert damping[1][0] == pytest.approx(0.137 * half * length**2 * draught * speed)
    assert damping[1][1] == pytest.approx(0.049 * half * length**3 * draught * speed)
    # The displaced mass of KVLCC2, C_B = 0.81 and B/L = 0.18125: m_y is of its size.
    block = 0.81 * 0.18125 * length * draught * length * rho
    assert added[0][0] / block == pytest.approx(0.76, abs=0.01)


def test_both_systems_differ_by_draught_over_length() -> None:
    prime = PrimeSystem.prime(7.0, 1000.0).to_si(MARINER, 1.0)
    mmg = PrimeSystem.mmg(7.0, 0.46, 1000.0).to_si(MARINER, 1.0)
    ratio = np.array(mmg.velocity) / np.array(prime.velocity)
    np.testing.assert_allclose(ratio, 0.46 / 7.0)


def test_round_trip_and_refusals() -> None:
    si = PrimeSystem.prime(7.0, 1000.0).to_si(MARINER, 1.5)
    assert from_added_mass_and_damping(*added_mass_and_damping(si)) == si
    with pytest.raises(ConfigurationError, match=r"speed_m_s = 0\.0 must be a positive"):
        PrimeSystem.prime(7.0, 1000.0).to_si(MARINER, 0.0)
    with pytest.raises(ConfigurationError, match="length_m = -1"):
        PrimeSystem.prime(-1.0, 1000.0)
