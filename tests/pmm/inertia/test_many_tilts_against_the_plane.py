"""More tilted yaw tests than are needed, against the tensor they were made of."""

import math

import numpy as np
import pytest

from analysis.uncertainty.estimate import Estimate, exactly
from pmm.inertia.bifilar_axes import plane_axes

XX, ZZ, XZ = 0.04, 0.09, 0.012  # squares of gyradii, m2


def gyradius(angle: float, factor: float = 1.0) -> Estimate:
    s, c = math.sin(angle), math.cos(angle)
    square = XX * s * s + ZZ * c * c - 2.0 * XZ * s * c
    return Estimate.of(factor * math.sqrt(square), 2e-4, "m")


def tilted_by(*degrees: float, wrong: int | None = None) -> list[tuple[Estimate, Estimate]]:
    return [
        (exactly(a, "rad"), gyradius(a, 1.02 if k == wrong else 1.0))
        for k, a in enumerate(np.radians(degrees).tolist())
    ]


def test_all_tilts_give_the_principal_axes_of_the_tensor() -> None:
    found, axes, (agreement,) = plane_axes(gyradius(0.0), None, tilted_by(-35.0, 25.0, 50.0), 0)
    size, vectors = np.linalg.eigh([[XX, -XZ], [-XZ, ZZ]])
    named = {one.name: one.estimate for one in found}
    assert named["k_roll_m"].value == pytest.approx(math.sqrt(XX), rel=1e-6)
    assert (named["k_px_m"].value, named["k_pz_m"].value) == pytest.approx(np.sqrt(size), rel=1e-4)
    turned = math.atan2(vectors[1, 0], vectors[0, 0])
    assert math.tan(named["psi_rad"].value) == pytest.approx(math.tan(turned), rel=1e-3)
    assert (axes.roll_m, axes.yaw_m) == pytest.approx(np.sqrt(size), rel=1e-4)
    assert agreement.degrees_of_freedom == 1
    assert agreement.agree


def test_a_roll_measured_by_itself_checks_the_tilts() -> None:
    roll = gyradius(0.5 * math.pi)
    tilts = tilted_by(-60.0, -30.0, 30.0, 60.0, wrong=2)
    _, _, (agreement,) = plane_axes(gyradius(0.0), roll, tilts, 0)
    assert agreement.stands_out == ("axis at 30 deg",)
    without = agreement.without[3]
    assert without == pytest.approx([math.sqrt(XX), math.sqrt(ZZ)], rel=1e-4)
