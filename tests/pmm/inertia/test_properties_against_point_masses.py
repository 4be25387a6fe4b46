"""The files for other programs, read back, against sums over point masses in their axes."""

import csv
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

MASS = np.array([1.0, 2.0, 0.5, 1.5])
PLACE = np.array([[0.3, 0.1, -0.2], [-0.4, 0.2, 0.1], [0.1, -0.5, 0.4], [0.0, 0.3, 0.2]])


def written(tmp_path: Path, name: str) -> Path:
    job, path = tmp_path / "job.toml", tmp_path / name
    job.write_text(
        "".join(
            f'[[parts]]\nname = "{k}"\nmass_kg = {m}\nu_mass_kg = 0.01\n'
            f"x_m = {x}\ny_m = {y}\nz_m = {z}\n"
            for k, (m, (x, y, z)) in enumerate(zip(MASS.tolist(), PLACE.tolist(), strict=True))
        )
    )
    arguments = ["inertia", "combine", str(job), "--properties", str(path)]
    outcome = CliRunner().invoke(cli, arguments)
    assert outcome.exit_code == 0, outcome.output
    return path


def tensor(turn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return centre of gravity and tensor of the points in turned axes."""
    place = PLACE @ turn.T
    centre = MASS @ place / MASS.sum()
    arms = place - centre
    whole = sum(m * (a @ a * np.eye(3) - np.outer(a, a)) for m, a in zip(MASS, arms, strict=True))
    return centre, np.asarray(whole)


def test_urdf_in_its_own_axes(tmp_path: Path) -> None:
    whole_file = ET.parse(written(tmp_path, "body.urdf"))  # noqa: S314 - our own
    inertial = whole_file.getroot().find("link/inertial")
    assert inertial is not None
    parts = {one.tag: one.attrib for one in inertial}
    centre, whole = tensor(np.diag([1.0, -1.0, -1.0]))
    assert float(parts["mass"]["value"]) == pytest.approx(5.0)
    found = [float(one) for one in parts["origin"]["xyz"].split()]
    assert found == pytest.approx(centre.tolist())
    for i, first in enumerate("xyz"):
        for k, second in enumerate("xyz"[i:], i):
            assert float(parts["inertia"][f"i{first}{second}"]) == pytest.approx(whole[i, k])


def test_csv_in_ours_with_the_covariance(tmp_path: Path) -> None:
    lines = written(tmp_path, "body.csv").read_text().splitlines()
    assert lines[0].startswith("# ")
    rows = {row["name"]: row for row in csv.DictReader(lines[1:])}
    centre, whole = tensor(np.eye(3))
    assert float(rows["y_m"]["value"]) == pytest.approx(centre[1])
    assert float(rows["ixz_kg_m2"]["value"]) == pytest.approx(-whole[0, 2])
    assert float(rows["mass_kg"]["u"]) == pytest.approx(0.02)
    own = float(rows["x_m"]["covariance with mass_kg"])
    slope = (PLACE[:, 0] - centre[0]) / MASS.sum()
    assert own == pytest.approx(float(np.sum(slope)) * 0.01**2)


def test_another_ending_is_refused(tmp_path: Path) -> None:
    arguments = ["inertia", "combine", "job.toml", "--properties", str(tmp_path / "body.step")]
    outcome = CliRunner().invoke(cli, arguments)
    assert outcome.exit_code != 0
