"""Whole tensors of inertia put together, against sums over point masses and against trials."""

from pathlib import Path

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from pmm.document.data import as_data
from pmm.inertia.outcome import Outcome
from pmm.inertia.parts import run_combine
from pmm.report.inertia_document import document

KEYS = ("ixx_kg_m2", "iyy_kg_m2", "izz_kg_m2", "ixy_kg_m2", "ixz_kg_m2", "iyz_kg_m2")
U = (0.03, 0.02, 0.04, 0.01, 0.02, 0.015)
HULL = np.array([2.0, 3.0, 3.5, 0.2, -0.3, 0.1])
PLACE = np.array([0.1, -0.2, 0.3])


def combined(tmp_path: Path, more: str = "") -> Outcome:
    path = tmp_path / "parts.toml"
    rows = [f"{key} = {v}\nu_{key} = {u}" for key, v, u in zip(KEYS, HULL, U, strict=True)]
    place = "\n".join(f"{axis}_m = {v}" for axis, v in zip("xyz", PLACE, strict=True))
    text = "\n".join(rows)
    path.write_text(
        f'[[parts]]\nname = "hull"\nmass_kg = 10.0\n{place}\n{text}\n{more}\n'
        '[[parts]]\nname = "weight"\nmass_kg = 2.0\nx_m = -0.5\ny_m = 0.4\nz_m = 0.1\n'
    )
    return run_combine(str(path))


def points() -> tuple[np.ndarray, np.ndarray]:
    """Return masses and places of points that have the hull's mass, centre and tensor.

    Six points of a sixth of the mass along the axes of the second moments' ellipsoid.
    """
    xx, yy, zz, xy, xz, yz = HULL
    half = 0.5 * (xx + yy + zz)
    moments = np.array([[half - xx, xy, xz], [xy, half - yy, yz], [xz, yz, half - zz]])
    size, axes = np.linalg.eigh(moments / 10.0)
    arms = axes * np.sqrt(3.0 * size)
    return np.full(6, 10.0 / 6.0), PLACE + np.vstack([arms.T, -arms.T])


def test_whole_tensor_against_point_masses(tmp_path: Path) -> None:
    mass, place = points()
    mass, place = np.append(mass, 2.0), np.vstack([place, [-0.5, 0.4, 0.1]])
    centre = mass @ place / mass.sum()
    x, y, z = (place - centre).T
    expected = {
        "i_roll_kg_m2": mass @ (y * y + z * z),
        "i_pitch_kg_m2": mass @ (x * x + z * z),
        "i_yaw_kg_m2": mass @ (x * x + y * y),
        "ixy_kg_m2": mass @ (x * y),
        "ixz_kg_m2": mass @ (x * z),
        "iyz_kg_m2": mass @ (y * z),
    }
    found = {one.name: one.estimate for one in combined(tmp_path).findings}
    for key, value in expected.items():
        assert found[key].value == pytest.approx(value, rel=1e-9), key
    # about one's own centre, what is added moves nothing of a product's uncertainty
    for key, u in zip(KEYS[3:], U[3:], strict=True):
        assert found[key].uncertainty == pytest.approx(u, rel=1e-9)


def test_correlated_moments_stay_correlated(tmp_path: Path) -> None:
    """Roll and yaw of one torsion rod: the rod's stiffness moves both."""
    pair = 'correlations = [{ between = ["ixx_kg_m2", "ixz_kg_m2"], coefficient = 0.8 }]'
    told = as_data(document(combined(tmp_path, pair)))["tensor"]
    covariance = np.array(told["covariance"])
    names = told["names"]
    assert names[4:] == list(KEYS)
    expected = np.diag(np.square(U))
    expected[0, 4] = expected[4, 0] = 0.8 * 0.03 * 0.02
    assert covariance[4:, 4:] == pytest.approx(expected, rel=1e-6, abs=1e-15)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ("k_roll_m = 0.3", "ixx_kg_m2 and k_roll_m are both given"),
        (
            'correlations = [{ between = ["ixx_kg_m2", "x_m"], coefficient = 0.8 }]',
            "name x_m, which has no u_x_m here",
        ),
        (
            'correlations = [{ between = ["ixx_kg_m2", "ixz_kg_m2"], coefficient = 1.8 }]',
            "no values are correlated like that",
        ),
    ],
)
def test_what_cannot_be_is_refused(more: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=message):
        combined(tmp_path, more)
