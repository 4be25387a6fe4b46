"""Oracle: added mass and damping of a heaving hemisphere by multipoles (after Hulme 1982).

R = 1 m, rho = 1000 kg/m3, g = 9.81 m/s2, deep water. The values below are those of the shared table
of which the whole is used where it is present.
"""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from hardware.description.oscillator import Plane
from sim.model.water.memory import FittedMemory, fit_memory
from sim.model.water.table_files import read_heave_csv
from sim.model.water.tables import RadiationTable
from tests.sim.model.water.passivity import is_passive

SHARED = Path(__file__).parents[4].parent / "shared" / "reference" / "hydrodynamics"

# omega (rad/s), added mass (kg), damping (kg/s): the columns a33_analytic_kg, b33_analytic_kg_s.
VALUES = np.array(
    [
        [0.700357, 1835.451, 152.035],
        [0.990454, 1806.897, 376.741],
        [1.400714, 1662.593, 819.369],
        [1.715517, 1498.912, 1168.994],
        [1.980909, 1351.291, 1414.780],
        [2.426108, 1127.005, 1662.165],
        [2.801428, 983.936, 1700.871],
        [3.132092, 897.317, 1629.436],
        [3.705941, 821.745, 1363.125],
        [4.429447, 813.419, 956.067],
        [5.424942, 860.979, 513.032],
        [6.264184, 905.212, 287.188],
    ]
)
UNIT = np.array([[1.0, 0.0], [0.0, 0.0]])
SPHERE_MASS = 2.0 / 3.0 * math.pi * 1000.0


def hemisphere(rows: slice | list[int] = slice(None)) -> RadiationTable:
    omega, a, b = VALUES[rows].T
    return RadiationTable(
        Plane.VERTICAL, omega, a[:, None, None] * UNIT, b[:, None, None] * UNIT, name="hemisphere"
    )


@cache
def fitted(states: int = 6) -> FittedMemory:
    return fit_memory(hemisphere(), states)


@pytest.mark.parametrize(("states", "reached"), [(5, 0.0015), (6, 1e-4)])
def test_five_and_six_states_reach_the_multipole_solution(states: int, reached: float) -> None:
    """0.2 % was asked for; each value relative to itself, not to the peak."""
    table = hemisphere()
    fit = fitted(states)
    for found, true in (
        (fit.radiation.added_mass(table.omega_rad_s), table.added_mass),
        (fit.radiation.damping(table.omega_rad_s), table.damping),
    ):
        relative = found[:, 0, 0] / true[:, 0, 0] - 1.0
        assert np.abs(relative).max() < reached
        assert np.abs(relative).max() <= fit.error * (1 + 1e-9)
    assert fit.error < reached < 0.002
    assert is_passive(fit.radiation)
    assert fit.radiation.states == states


def test_shared_table_reads_the_same_and_fits_as_well() -> None:
    path = SHARED / "hemisphere_heave.csv"
    if not path.exists():
        pytest.skip(f"no shared table of the hemisphere beside the project ({path.name})")
    table = read_heave_csv(path)
    np.testing.assert_array_equal(table.omega_rad_s, VALUES[:, 0])
    np.testing.assert_array_equal(table.added_mass[:, 0, 0], VALUES[:, 1])
    np.testing.assert_array_equal(table.damping[:, 0, 0], VALUES[:, 2])
    assert fit_memory(table, 6).error < 1e-4


def test_infinite_frequency_is_half_the_displaced_mass() -> None:
    """At infinite frequency the hemisphere and its image are a sphere in unbounded fluid: m/2."""
    added = fitted().radiation.added_mass_infinite
    assert added[0, 0] == pytest.approx(SPHERE_MASS / 2.0, rel=1e-3)


def test_zero_frequency_is_the_double_body_limit() -> None:
    """Hulme's limit for long waves, 0.8310 of the displaced mass, far below the table's range."""
    added = fitted().radiation.added_mass(0.0)
    assert added[0, 0] == pytest.approx(0.8310 * SPHERE_MASS, rel=0.02)


@pytest.mark.parametrize("left_out", [1, 4, 8])
def test_predicts_a_frequency_that_it_has_not_seen(left_out: int) -> None:
    """The memory does not bend between the points: a tenth of a percent of the peak, or so."""
    others = [i for i in range(len(VALUES)) if i != left_out]
    radiation = fit_memory(hemisphere(others)).radiation
    omega, a, b = VALUES[left_out]
    assert radiation.added_mass(omega)[0, 0] == pytest.approx(a, rel=2e-3)
    assert radiation.damping(omega)[0, 0] == pytest.approx(b, abs=2e-3 * VALUES[:, 2].max())


def test_known_infinite_frequency_is_kept() -> None:
    known = replace(hemisphere(), added_mass_infinite=SPHERE_MASS / 2.0 * UNIT)
    fit = fit_memory(known, 6)
    assert fit.radiation.added_mass_infinite[0, 0] == pytest.approx(SPHERE_MASS / 2.0, rel=1e-12)
    assert fit.error < 0.001
