"""Bad input of inertia jobs: each kind gets its own message and exit status."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli

G = 9.81
LINE_M, HALF_SPACING_M = 2.0, 0.5
SWAY_S = 2.0 * np.pi * np.sqrt(LINE_M / G)

SWING = """
gravity_m_s2 = 9.81
u_gravity_m_s2 = 0.0005
[tare]
mass_kg = {mass}
u_mass_kg = 0.01
period = {{ records = ["run.csv"] }}
[[tare.levers]]
name = "C1"
lever_m = 0.2
weight_kg = [0.0, 0.5, 1.0]
tilt_{unit} = {tilts}
"""
TILTS = "[0.0, 1.9, 3.8]"

BIFILAR = """
gravity_m_s2 = 9.81
u_gravity_m_s2 = 0.0005
[[suspensions]]
half_spacing_m = 0.5
line_m = 2.0
{motion} = {{ records = ["run.csv"] }}
{more}
"""


def record(
    folder: Path,
    period_s: float,
    *,
    length_s: float = 160.0,
    rate_hz: float = 20.0,
    amplitude: float = 2.0,
    unit: str = "deg",
) -> None:
    generator = np.random.default_rng(7)
    t = np.arange(0.0, length_s, 1.0 / rate_hz)
    y = amplitude * np.exp(-0.004 * t) * np.cos(2.0 * np.pi * t / period_s)
    y += 1e-4 * amplitude * generator.standard_normal(t.size)
    rows = [f"{a:.4f},{b:.7f}" for a, b in zip(t, y, strict=True)]
    (folder / "run.csv").write_text("\n".join([f"Time [s],Tilt [{unit}]", *rows]) + "\n")


def inertia(folder: Path, job: str, text: str, *options: str) -> Result:
    path = folder / "job.toml"
    path.write_text(text)
    arguments = ["inertia", job, str(path), *options]
    return CliRunner().invoke(cli, arguments, catch_exceptions=False)


def swing(mass: str = "42.28", unit: str = "deg", tilts: str = TILTS) -> str:
    return SWING.format(mass=mass, unit=unit, tilts=tilts)


Making = Callable[[Path], None]
CASES: dict[str, tuple[Making, str, str, int, tuple[str, ...]]] = {
    "too few swings": (
        lambda folder: record(folder, 7.3, length_s=19.0),
        "swing",
        swing(),
        1,
        ("too few swings", "record longer"),
    ),
    "aliasing": (
        lambda folder: record(folder, 7.3, rate_hz=0.4),
        "swing",
        swing(),
        1,
        ("alias",),
    ),
    "mass of zero": (
        lambda folder: record(folder, 7.3),
        "swing",
        swing(mass="0.0"),
        2,
        ("tare.mass_kg = 0 should be above 0",),
    ),
    "yaw given for sway": (
        lambda folder: record(folder, 1.3 * SWAY_S, unit="mm"),
        "bifilar",
        BIFILAR.format(motion="sway", more="beats = { oscillations = 30, beats = 4 }"),
        1,
        ("wrong axis (yaw for sway?)", "+30.0 %"),
    ),
    "a record in degrees called radians": (
        lambda folder: record(folder, 7.3, unit="rad"),
        "swing",
        swing(),
        1,
        ("degrees given as radians", "1.97 rad"),
    ),
    "tilts in degrees called radians": (
        lambda folder: record(folder, 7.3),
        "swing",
        swing(unit="rad"),
        1,
        ("series 'C1'", "degrees given as radians"),
    ),
    "a record that is not there": (
        lambda folder: None,
        "swing",
        swing(),
        1,
        ("run.csv", "no such file"),
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_each_has_its_message_and_status(case: str, tmp_path: Path) -> None:
    make, job, text, status, words = CASES[case]
    make(tmp_path)
    result = inertia(tmp_path, job, text)
    assert result.exit_code == status, result.stderr
    assert result.stdout == ""
    for word in words:
        assert word in result.stderr


def test_only_one_lever_is_flagged(tmp_path: Path) -> None:
    record(tmp_path, 7.3)
    result = inertia(tmp_path, "swing", swing())
    assert result.exit_code == 0
    assert "only one lever (0.2 m)" in result.stdout
    assert "[single_lever]" in result.stdout


def test_sway_given_for_yaw_is_flagged(tmp_path: Path) -> None:
    record(tmp_path, SWAY_S, unit="mm")
    result = inertia(tmp_path, "bifilar", BIFILAR.format(motion="yaw", more=""))
    assert result.exit_code == 0
    assert "wrong axis (sway for yaw)" in result.stdout


def test_a_single_run_never_rests_on_its_fit_alone(tmp_path: Path) -> None:
    record(tmp_path, 7.3)
    result = inertia(tmp_path, "swing", swing())
    assert "[single_run]" in result.stdout
    assert "repeat the release" in result.stdout


def test_all_errors_of_a_file_come_at_once(tmp_path: Path) -> None:
    text = """
gravity_m_s2 = -9.81
[tare]
mass_kg = "heavy"
u_mas_kg = 0.01
period = { records = ["a.csv"], period_s = 7.3 }
[loaded]
mass_kg = 50.0
u_moment_kg_m = 0.1
period = { period_s = 4.0 }
"""
    result = inertia(tmp_path, "swing", text)
    assert result.exit_code == 2
    for words in (
        "gravity_m_s2 = -9.81 should be above 0",
        "tare.mass_kg",
        "did you mean u_mass_kg?",
        "tare.period.period_s and records are both given",
        "u_period_s is missing",
        "tare needs one of levers, cg_below_pivot_m, moment_kg_m",
        "u_moment_kg_m is given without moment_kg_m",
        "model needs mass_kg",
    ):
        assert words in result.stderr, words


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("inertia", "swig", "x.toml"), "did you mean 'swing'?"),
        (("inertia", "swing", "absent.toml"), "absent.toml: no such file"),
        (("inertia", "swing"), "Missing argument 'FILE'"),
    ],
)
def test_a_wrong_command_has_status_2(arguments: tuple[str, ...], message: str) -> None:
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 2
    assert message in result.stderr


PENDULUM = """
gravity_m_s2 = 9.81
depth_m = 0.3
period = { period_s = 1.52, u_period_s = 0.001 }
[[targets]]
quantity = "k_pitch_m"
value = VALUE
tolerance = 0.01
"""


@pytest.mark.parametrize(
    ("value", "verdict", "status"), [("0.285", "pass", 0), ("0.33", "fail", 1)]
)
def test_a_missed_target_has_status_1(
    value: str, verdict: str, status: int, tmp_path: Path
) -> None:
    result = inertia(tmp_path, "pendulum", PENDULUM.replace("VALUE", value))
    assert verdict in result.stdout
    assert result.exit_code == status


def test_a_target_of_no_result_names_the_nearest(tmp_path: Path) -> None:
    text = PENDULUM.replace("VALUE", "0.3").replace("k_pitch_m", "k_pich_m")
    result = inertia(tmp_path, "pendulum", text)
    assert result.exit_code == 2
    assert "did you mean k_pitch_m?" in result.stderr


def test_a_section_is_never_overwritten_unasked(tmp_path: Path) -> None:
    target = tmp_path / "model.toml"
    target.write_text("mine\n")
    model = "[model]\nmass_kg = 10.0\ncg_x_m = 0.0\ncg_z_m = 0.1\n"
    text = PENDULUM.replace("VALUE", "0.285") + model
    refused = inertia(tmp_path, "pendulum", text, "--output", str(target))
    assert refused.exit_code == 2
    assert "--overwrite" in refused.stderr
    assert target.read_text() == "mine\n"
    done = inertia(tmp_path, "pendulum", text, "--output", str(target), "--overwrite")
    assert done.exit_code == 0, done.stderr
    assert "[model_uncertainty]" in target.read_text()


def test_a_section_that_lacks_something_says_what(tmp_path: Path) -> None:
    text = PENDULUM.replace("VALUE", "0.285")
    result = inertia(tmp_path, "pendulum", text, "--output", str(tmp_path / "model.toml"))
    assert result.exit_code == 2
    assert "model.mass_kg, model.cg_x_m, model.cg_z_m" in result.stderr
    assert not (tmp_path / "model.toml").exists()


BALLAST = """
[base]
name = "hull"
mass_kg = 60.0
k_yaw_m = 0.8
[[weights]]
name = "only"
mass_kg = 1.0
low_m = [-0.1, 0.0, 0.0]
high_m = [0.1, 0.0, 0.0]
[wanted]
cg_x_m = 0.5
"""


def test_ballast_that_cannot_do_it_says_how_near_it_gets(tmp_path: Path) -> None:
    result = inertia(tmp_path, "ballast", BALLAST, "--output", str(tmp_path / "m.toml"))
    assert result.exit_code == 1
    assert "not feasible" in result.stdout
    assert "x off by" in result.stdout
    assert not (tmp_path / "m.toml").exists()
