"""Oracle: a panel method's added mass and damping of two hulls, where the shared tables are."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hardware.description.oscillator import Plane
from sim.model.water.memory import fit_memory
from sim.model.water.table_files import read_hull_csv
from sim.model.water.tables import RadiationTable
from tests.sim.model.water.passivity import is_passive

HULLS = Path(__file__).parents[4].parent / "shared" / "reference" / "hydrodynamics" / "hulls.csv"


def shared_hull(body: str, plane: Plane) -> RadiationTable:
    if not HULLS.exists():
        pytest.skip(f"no shared panel method's tables beside the project ({HULLS.name})")
    return read_hull_csv(HULLS, plane, body)


BODIES = ["wigley_L3.0_B0.3_T0.1875", "box_L2.0_B0.4_T0.15"]


@pytest.mark.sample(1)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("plane", list(Plane))
def test_panel_methods_hulls(body: str, plane: Plane) -> None:
    """Up to six states a motion reproduce nine frequencies within 1 %, each relative to itself."""
    hull = shared_hull(body, plane)
    assert hull.asymmetry() < 1e-5
    fit = fit_memory(hull)
    assert fit.error < 0.01
    assert is_passive(fit.radiation)
    assert fit.radiation.states <= 12


def about(hull: RadiationTable, ahead_m: float) -> RadiationTable:
    """Return a horizontal table about a point ``ahead_m`` forward: T^T X T for every matrix X."""
    arm = np.array([[1.0, -ahead_m], [0.0, 1.0]])
    infinite = hull.added_mass_infinite
    return replace(
        hull,
        added_mass=arm.T @ hull.added_mass @ arm,
        damping=arm.T @ hull.damping @ arm,
        added_mass_infinite=None if infinite is None else arm.T @ infinite @ arm,
    )


def test_coupled_hull_against_the_uncoupled_one() -> None:
    """About a point 0.2 m ahead heave and pitch couple; the fit must be the moved uncoupled one."""
    hull = shared_hull(BODIES[1], Plane.HORIZONTAL)
    fit, moved = fit_memory(hull), fit_memory(about(hull, 0.2))
    assert moved.error < 0.002
    assert is_passive(moved.radiation)
    arm = np.array([[1.0, -0.2], [0.0, 1.0]])
    omega = np.array([1.5, 3.5, 5.7])  # between the table's frequencies
    peak = moved.radiation.damping(np.linspace(0.6, 7.8, 200))[:, (0, 1), (0, 1)].max(axis=0)
    a, b = fit.radiation.added_mass(omega), fit.radiation.damping(omega)
    a_moved, b_moved = moved.radiation.added_mass(omega), moved.radiation.damping(omega)
    assert np.abs(a_moved / (arm.T @ a @ arm) - 1.0).max() < 0.008
    assert np.abs((b_moved - arm.T @ b @ arm) / np.sqrt(np.outer(peak, peak))).max() < 0.003
