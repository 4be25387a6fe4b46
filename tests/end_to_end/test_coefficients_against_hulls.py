"""Hulls of the shared tables put into the simulator come back through rig and campaign.

Froude-scaled hemisphere (multipole solution), Wigley hull and box (panel method): recorded with the
rig's own noise, resolved, and solved as one campaign beside its own table.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.names import Form
from analysis.coefficients.reference import compare, table_of_matrices
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.readers.dataset import from_dataset
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from sim.model.hull import HullCoefficients
from sim.model.water.table_files import read_heave_csv, read_hull_csv
from sim.model.water.tables import RadiationTable
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import simulate

TABLES = Path(__file__).parents[3] / "shared" / "reference" / "hydrodynamics"
CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")

pytestmark = pytest.mark.skipif(not TABLES.is_dir(), reason="the tables of hulls are not at hand")


def hull(name: str, plane: Plane) -> RadiationTable:
    if name == "hemisphere":
        return read_heave_csv(TABLES / "hemisphere_heave.csv").froude_scaled(0.25)
    return read_hull_csv(TABLES / "hulls.csv", plane, name)


def run(rig: SimulatedRig, point: SetPoint, name: str) -> BodyCycle:
    record = simulate(rig, point, periods=20, sample_rate_hz=100.0, seed=5, name=name)
    settings = ResolverSettings(channels=CHANNELS, harmonics=1)
    cycle = measured_cycle(analyse(from_dataset(record), settings=settings), rig.oscillator).model()
    return cycle.without(rig.body, np.array(rig.water.restoring))


def campaign(table: RadiationTable) -> list[BodyCycle]:
    """Three frequencies of the table, both motions."""
    vertical = table.plane is Plane.VERTICAL
    rig = vertical_rig() if vertical else horizontal_rig()
    restoring = ((1900.0, 0.0), (0.0, 600.0)) if vertical else ((0.0, 0.0), (0.0, 0.0))
    reach = [k for k, w in enumerate(table.omega_rad_s) if 0.35 <= w / (2.0 * math.pi) <= 1.3]
    found = []
    for k in (reach[0], reach[len(reach) // 2], reach[-1]):
        frequency = float(table.omega_rad_s[k]) / (2.0 * math.pi)
        added, damping = (
            tuple(map(tuple, matrix.tolist())) for matrix in (table.added_mass[k], table.damping[k])
        )
        own = replace(rig, water=HullCoefficients(added, damping, restoring))  # type: ignore[arg-type]
        for kind, phase in (("translation", 0.0), ("rotation", math.pi)):
            point = SetPoint(frequency, min(0.03, 0.04 / frequency**2), phase)
            found.append(run(own, point, f"{kind} {frequency:.3f} Hz"))
    return found


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("name", "plane"),
    [
        ("hemisphere", Plane.VERTICAL),
        ("wigley_L3.0_B0.3_T0.1875", Plane.VERTICAL),
        ("wigley_L3.0_B0.3_T0.1875", Plane.HORIZONTAL),
        ("box_L2.0_B0.4_T0.15", Plane.VERTICAL),
        ("box_L2.0_B0.4_T0.15", Plane.HORIZONTAL),
    ],
)
def test_a_hull_comes_back_within_half_a_percent_or_its_interval(name: str, plane: Plane) -> None:
    table = hull(name, plane)
    frequency = table.omega_rad_s / (2.0 * math.pi)
    request = Request(Form.SEAKEEPING, level=0.99, zero_frequency=False)
    found = campaign_coefficients(campaign(table), request)
    beside = compare(
        found, table_of_matrices(name, plane, frequency, table.added_mass, table.damping)
    ).references
    own = [row for row in beside if row.name[1] == row.name[2]]  # a33, b33, a55, b55 ...
    own = [row for row in own if name != "hemisphere" or "5" not in row.name]
    assert len(own) == (6 if name == "hemisphere" else 12)
    for row in own:
        allowed = max(5e-3 * abs(row.expected), row.half_width)
        assert abs(row.difference) <= allowed, (row.name, row.frequency_hz)
    tight = [row for row in own if row.half_width < 0.02 * abs(row.expected)]
    assert len(tight) >= len(own) // 2  # the intervals are no excuse
