"""``--names`` and ``--with-mass``: the table of a simulated campaign beside the plain one."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

MASS_KG, CG_M, SPEED_M_S, LENGTH_M, DENSITY = 70.0, 0.1, 0.8, 2.5, 999.1
RUN = """\
[[runs]]
name = "{0}"
frequency_hz = 0.2
eccentricity_mm = 100.0
strut_phase_deg = {1}
carriage_speed_m_s = 0.8
periods = 4
"""
CAMPAIGN = f"""\
[oscillator]
preset = "horizontal-1963"
[model]
mass_kg = {MASS_KG}
inertia_kg_m2 = 27.5
cg_x_m = {CG_M}
[model_uncertainty]
mass_kg = 0.7
[hull]
added_mass = [[75.0, 0.0], [0.0, 22.0]]
damping = [[190.0, 0.0], [0.0, 55.0]]
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("sway-and-yaw")
    text = CAMPAIGN + RUN.format("sway", 0.0) + RUN.format("yaw", 120.0)
    (path / "campaign.toml").write_text(text)
    settings = f"nonlinear = false\n[ship]\nlength_m = {LENGTH_M}\ndensity_kg_m3 = {DENSITY}\n"
    (path / "coefficients.toml").write_text(settings)
    command = ["simulate", str(path / "campaign.toml"), "--output", str(path)]
    assert CliRunner().invoke(cli, command).exit_code == 0
    return path


def rows(folder: Path, *options: str) -> dict[str, dict[str, float]]:
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), *options, "--json"])
    assert ran.exit_code == 0, ran.output
    return {row["name"]: row for row in json.loads(ran.stdout)["recommended"]}


@pytest.mark.slow
def test_the_mass_is_in_the_rates(folder: Path) -> None:
    plain, quoted = rows(folder), rows(folder, "--with-mass")
    for name, shift in (("Y_r", MASS_KG * SPEED_M_S), ("N_r", MASS_KG * CG_M * SPEED_M_S)):
        assert quoted[name]["value"] == pytest.approx(plain[name]["value"] - shift, abs=1e-9)
    assert quoted["Y_v"] == plain["Y_v"]
    # Y_r - m U does not know the mass where the fit took m U off by the same mass: it cancels.
    assert quoted["Y_r"]["standard_uncertainty"] < plain["Y_r"]["standard_uncertainty"]


@pytest.mark.slow
def test_the_prime_table_divides_the_mass_too(folder: Path) -> None:
    unit = 0.5 * DENSITY * LENGTH_M**3
    plain, quoted = (
        rows(folder, "--system", "prime"),
        rows(folder, "--system", "prime", "--with-mass"),
    )
    off = quoted["Y_r"]["value"] - plain["Y_r"]["value"]
    assert off == pytest.approx(-MASS_KG / unit, rel=1e-9)


@pytest.mark.slow
def test_bis_is_the_seakeeping_system_of_a_floating_model(folder: Path) -> None:
    bis, other = rows(folder, "--system", "bis"), rows(folder, "--system", "seakeeping")
    assert {name: row["value"] for name, row in bis.items()} == {
        name: row["value"] for name, row in other.items()
    }


def test_the_head_says_what_the_table_is(folder: Path) -> None:
    options = ["--system", "prime", "--names", "abkowitz", "--with-mass"]
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), *options])
    assert "prime (rho/2, L = 2.5 m, U = 0.8 m/s); Abkowitz" in ran.stdout.replace("\n", " ")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--form", "seakeeping", "--names", "abkowitz"), "take --form manoeuvring"),
        (("--names", "feldmann"), "gertler-hagen"),
    ],
)
def test_what_cannot_be_quoted_is_refused(
    folder: Path, options: tuple[str, ...], said: str
) -> None:
    ran = CliRunner().invoke(cli, ["coefficients", str(folder), *options])
    assert ran.exit_code == 2
    assert said in ran.output
