"""Torsion axes that contradict each other are seen; axes that agree are left alone."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.random import Generator

from pmm.cli import cli
from pmm.inertia import pendulum
from pmm.inertia.outcome import Outcome

STIFFNESS, U_PERIOD, U_ANGLE = 5.0, 1e-3, math.radians(0.2)


def axes_of(angle: np.ndarray) -> np.ndarray:
    s, c = np.sin(angle), np.cos(angle)
    return np.column_stack([s * s, c * c, -2.0 * s * c])


def written(path: Path, angle: np.ndarray, period: np.ndarray, common: str = "") -> Path:
    rows = [
        f"[[torsion.axes]]\nangle_rad = {a!r}\nu_angle_rad = {U_ANGLE!r}\n"
        f"period_s = {t!r}\nu_period_s = {U_PERIOD!r}\n"
        for a, t in zip(angle.tolist(), period.tolist(), strict=True)
    ]
    head = f"gravity_m_s2 = 9.81\n[torsion]\nstiffness_n_m_rad = {STIFFNESS}\n{common}\n"
    path.write_text(head + "".join(rows))
    return path


def drawn(generator: Generator, shifted: float) -> tuple[np.ndarray, np.ndarray]:
    """Return angles as read and periods, one off by so much of what the others predict it to."""
    count = int(generator.integers(4, 7))
    step = math.pi / count
    angle = step * (np.arange(count) + generator.uniform(-0.3, 0.3, count))
    true = np.array([generator.uniform(1.5, 3.0), generator.uniform(1.5, 3.0), 0.2])
    about = axes_of(angle) @ true
    # of an inertia: by its period, and by its angle
    slope = np.sin(2.0 * angle) * (true[0] - true[1]) - 2.0 * true[2] * np.cos(2.0 * angle)
    by_period = 2.0 * U_PERIOD * np.sqrt(about * STIFFNESS) / (2.0 * math.pi)
    sigma = np.hypot(by_period, slope * U_ANGLE)
    k = int(generator.integers(count))
    rest = np.arange(count) != k
    rows = axes_of(angle)
    normal = rows[rest].T @ np.diag(sigma[rest] ** -2.0) @ rows[rest]
    predicted = math.sqrt(sigma[k] ** 2 + rows[k] @ np.linalg.inv(normal) @ rows[k])
    seen = angle + U_ANGLE * generator.standard_normal(count)
    moved = about + shifted * predicted * (np.arange(count) == k) * generator.choice([-1.0, 1.0])
    period = 2.0 * math.pi * np.sqrt(moved / STIFFNESS)
    return seen, period + U_PERIOD * generator.standard_normal(count)


def flagged(path: Path, shifted: float, seed: int) -> int:
    generator, count = np.random.default_rng(seed), 0
    for k in range(100):
        outcome = pendulum.run(str(written(path / f"{k}.toml", *drawn(generator, shifted))))
        count += "data_disagree" in {flag.code for flag in outcome.flags}
    return count


@pytest.mark.slow
def test_contradictory_axes_are_flagged_and_clean_ones_are_not(tmp_path: Path) -> None:
    assert flagged(tmp_path, 5.0, seed=1) >= 97
    assert flagged(tmp_path, 0.0, seed=2) <= 2


def five(tmp_path: Path) -> Path:
    """Return five axes, two of them within 1.2 degrees and yet 1.23 times apart."""
    angle = np.radians([0.0, 30.0, 31.2, 70.0, 120.0])
    about = axes_of(angle) @ [1.83, 1.2, 0.2] * np.array([1.0, 1.0, 1.23, 1.0, 1.0])
    return written(tmp_path / "five.toml", angle, 2.0 * math.pi * np.sqrt(about / STIFFNESS))


def test_the_axis_that_is_wrong_is_named_with_the_answer_without_it(tmp_path: Path) -> None:
    outcome = pendulum.run(str(five(tmp_path)))
    (found,) = outcome.redundancy
    assert found.stands_out == ("axis at 31.2 deg",)
    assert found.degrees_of_freedom == 2
    assert found.chi_squared > 1e3
    assert found.without[2] == pytest.approx([1.83, 1.2, 0.2], abs=1e-6)
    ixx = next(one.estimate for one in outcome.findings if one.name == "ixx_kg_m2")
    low, high = ixx.interval()
    assert low < 1.83 < high
    assert ixx.degrees_of_freedom == pytest.approx(2.0, rel=0.01)


def test_the_command_says_it_in_table_and_json(tmp_path: Path) -> None:
    path = str(five(tmp_path))
    shown = CliRunner().invoke(cli, ["inertia", "pendulum", path]).output
    assert "Agreement" in shown
    assert "data_disagree" in shown
    told = json.loads(CliRunner().invoke(cli, ["inertia", "pendulum", path, "--json"]).output)
    (row,) = told["redundancy"]
    assert row["stands_out"] == ["axis at 31.2 deg"]
    assert row["data"][2]["without"]["ixx_kg_m2"] == pytest.approx(1.83, abs=1e-6)
    assert row["widening"] > 10.0
    assert row["widened_by"] == "the scatter of the data (Birge)"


def test_a_common_error_of_all_angles_turns_the_frame_and_contradicts_nothing(
    tmp_path: Path,
) -> None:
    """About axes turned by d, Ixx changes by -2 Ixz d, Ixz by (Ixx - Izz) d."""
    angle, u = np.radians([0.0, 40.0, 80.0, 120.0]), math.radians(0.5)
    xx, zz, xz = 1.83, 1.2, 0.2
    period = 2.0 * math.pi * np.sqrt(axes_of(angle) @ [xx, zz, xz] / STIFFNESS)

    def spread(common: str) -> tuple[np.ndarray, Outcome]:
        outcome = pendulum.run(str(written(tmp_path / "job.toml", angle, period, common)))
        own = {one.name: one.estimate.uncertainty for one in outcome.findings}
        names = ("ixx_kg_m2", "izz_kg_m2", "ixz_kg_m2", "psi_rad")
        return np.array([own[name] for name in names]), outcome

    alone, before = spread("")
    shared, after = spread("u_common_angle_deg = 0.5")
    turned = u * np.array([2.0 * xz, 2.0 * xz, xx - zz, 1.0])
    assert np.sqrt(shared**2 - alone**2) == pytest.approx(turned, rel=1e-6)
    chi_squared = [one.redundancy[0].chi_squared for one in (before, after)]
    assert chi_squared[1] == pytest.approx(chi_squared[0], abs=1e-6)
