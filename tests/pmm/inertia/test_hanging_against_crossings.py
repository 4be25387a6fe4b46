"""The centre of gravity by plumb lines, against where it was put and against published bicycles."""

import math
from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.hanging import PlumbLine, centre_of_lines
from analysis.uncertainty.estimate import Estimate
from hardware.description.errors import ConfigurationError, DataError
from pmm.inertia import pendulum
from pmm.inertia.hanging import HangingLine
from pmm.inertia.parts import run_combine
from tests.analysis.inertia.test_measured_records import SHARED, table

X, Z = 0.12, -0.33  # the centre of gravity, m


def job(tmp_path: Path, lines: str, more: str = "") -> str:
    path = tmp_path / "job.toml"
    path.write_text(f"gravity_m_s2 = 9.81\n[hanging]\n{more}\nlines = [{lines}]\n")
    return str(path)


def drop(x: float, z: float) -> float:
    """Return the angle of the plumb line from a point, from body z (down) towards body x, deg."""
    return math.degrees(math.atan2(X - x, Z - z))


def found(path: str) -> dict[str, Estimate]:
    return {one.name: one.estimate for one in pendulum.run(path).findings}


def test_three_ways_to_a_line(tmp_path: Path) -> None:
    angle = drop(0.5, -0.8)
    a = math.radians(70.0)
    lines = (
        f"{{ x_m = 0.5, z_m = -0.8, angle_deg = {angle} }}, "
        f"{{ x_m = -0.6, z_m = -0.7, to_x_m = {2.0 * X + 0.6}, to_z_m = {2.0 * Z + 0.7} }}, "
        f"{{ distance_m = {X * math.cos(a) - Z * math.sin(a)}, angle_rad = {a} }}"
    )
    own = found(job(tmp_path, lines))
    assert own["cg_x_m"].value == pytest.approx(X, abs=1e-9)
    assert own["cg_z_m"].value == pytest.approx(Z, abs=1e-9)


def test_a_common_error_of_all_angles_turns_body_about_nothing_else(tmp_path: Path) -> None:
    """Two lines from (x, z): turned together by d they cross elsewhere by what finite turns say."""
    points = ((0.5, -0.8), (-0.6, -0.7))

    def crossing(turn: float) -> np.ndarray:
        a = np.radians([drop(*point) for point in points]) + turn
        matrix = np.column_stack([np.cos(a), -np.sin(a)])
        x, z = np.array(points).T
        return np.asarray(np.linalg.solve(matrix, x * np.cos(a) - z * np.sin(a)))

    lines = ", ".join(f"{{ x_m = {x}, z_m = {z}, angle_deg = {drop(x, z)} }}" for x, z in points)
    own = found(job(tmp_path, lines, "u_common_angle_deg = 0.5"))
    step = math.radians(0.5)
    moved = (crossing(step) - crossing(-step)) / 2.0
    assert own["cg_x_m"].uncertainty == pytest.approx(abs(moved[0]), rel=1e-3)
    assert own["cg_z_m"].uncertainty == pytest.approx(abs(moved[1]), rel=1e-3)


@pytest.mark.slow
def test_uncertainties_against_trials() -> None:
    generator = np.random.default_rng(1)
    points, u_point, u_angle = ((0.5, -0.8), (-0.6, -0.7), (0.0, -1.1), (0.9, 0.1)), 1e-3, 3e-3
    angles = np.radians([drop(*point) for point in points])

    def centre(moved: np.ndarray, turned: np.ndarray) -> tuple[Estimate, Estimate, float]:
        lines = [
            PlumbLine(f"{k}", *(Estimate.of(v, u_point, "m") for v in at), Estimate.of(a, u_angle))
            for k, (at, a) in enumerate(zip(moved, turned, strict=True))
        ]
        own = centre_of_lines(lines)
        return own.x, own.z, own.redundancy.chi_squared

    trials = [
        centre(
            np.array(points) + u_point * generator.standard_normal((4, 2)),
            angles + u_angle * generator.standard_normal(4),
        )
        for _ in range(600)
    ]
    x, z, chi_squared = (np.array([getattr(one, "value", one) for one in k])
                         for k in zip(*trials, strict=True))  # fmt: skip
    assert x.std() == pytest.approx(trials[0][0].uncertainty, rel=0.1)
    assert z.std() == pytest.approx(trials[0][1].uncertainty, rel=0.1)
    assert x.mean() == pytest.approx(X, abs=3e-4)
    assert chi_squared.mean() == pytest.approx(2.0, abs=0.25)


@pytest.mark.skipif(not SHARED.exists(), reason=f"no measured records at {SHARED}")
@pytest.mark.parametrize(("part", "axle"), [("B", 0.0), ("H", 1.0)])
def test_published_centres_of_a_bicycle(part: str, axle: float) -> None:
    """Three lines each, by their angle to the steering axis and distance from the wheel's axle."""
    rows, published = table("BrowserMeasured.txt"), table("BrowserBenchmark.txt")
    lines = []
    for k in (1, 2, 3):
        angle, apart = rows[f"alpha{part}{k}"], rows[f"a{part}{k}"]
        line = HangingLine(
            angle_deg=math.degrees(published["lam"].value) - angle.value - 90.0,
            u_angle_deg=angle.uncertainty,
            distance_m=-apart.value,
            u_distance_m=apart.uncertainty,
        )
        lines.append(line.line(f"{part}{k}", 0.0))
    own = centre_of_lines(lines)
    radius = published["rR" if part == "B" else "rF"].value
    x = own.x.value + axle * published["w"].value
    assert abs(x - published[f"x{part}"].value) < published[f"x{part}"].uncertainty
    assert abs(own.z.value - radius - published[f"z{part}"].value) < (
        published[f"z{part}"].uncertainty
    )
    assert own.redundancy.degrees_of_freedom == 1


def test_it_is_the_models_and_a_parts(tmp_path: Path) -> None:
    line = "{{ x_m = {0}, z_m = {1}, u_x_m = 0.001, angle_deg = {2} }}"
    lines = ", ".join(line.format(x, z, drop(x, z)) for x, z in ((0.5, -0.8), (-0.6, -0.7)))
    path = tmp_path / "swing.toml"
    period = "period = { period_s = 2.0, u_period_s = 0.001 }"
    path.write_text(
        f"gravity_m_s2 = 9.81\ndepth_m = 0.5\n{period}\nmodel = {{ mass_kg = 10.0 }}\n"
        f"hanging = {{ lines = [{lines}] }}\n"
    )
    body = pendulum.run(str(path)).body
    assert body is not None
    assert (body.cg_x.value, body.cg_z.value) == pytest.approx((X, Z))
    parts = tmp_path / "parts.toml"
    parts.write_text(
        f'[[parts]]\nname = "hull"\nmass_kg = 3.0\nhanging = {{ lines = [{lines}] }}\n'
        '[[parts]]\nname = "keel"\nmass_kg = 1.0\n'
    )
    whole = {one.name: one for one in run_combine(str(parts)).findings}
    assert whole["cg_x_m"].estimate.value == pytest.approx(0.75 * X)
    assert whole["cg_x_m"].assessment is not None


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        ("{ x_m = 0.1, z_m = 0.1, angle_deg = 3.0 }", "lines are 1"),
        ("{ x_m = 0.1, z_m = 0.1 }, { x_m = 0.1, z_m = 0.2 }", "needs one of to_x_m"),
        ("{ angle_deg = 3.0 }, { angle_deg = 9.0 }", "needs x_m and z_m of a point, or dist"),
        ("{ x_m = 1.0, to_x_m = 1.0, to_z_m = 0.0 }, { x_m = 1.0, angle_deg = 9.0 }", "again"),
    ],
)
def test_what_lines_need_is_said(lines: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=message):
        pendulum.run(job(tmp_path, lines))


def test_parallel_lines_are_refused(tmp_path: Path) -> None:
    lines = "{ x_m = 0.1, angle_deg = 3.0 }, { x_m = 0.3, angle_deg = 183.5 }"
    with pytest.raises(DataError, match="hang the body from another point"):
        pendulum.run(job(tmp_path, lines))
