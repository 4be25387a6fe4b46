"""The campaign of another system: read with ten lines, and wrong units and signs are caught."""

import json
import math
import tomllib
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from analysis.readers import ColumnMap, read_recording
from analysis.resolver.analysis import analyse
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli

FOLDER = Path(__file__).parents[2] / "examples" / "foreign"


def _flags(campaign: Path) -> tuple[dict[str, Any], dict[str | None, set[str]]]:
    result = CliRunner().invoke(cli, ["analyse", str(campaign), "--json"])
    document = json.loads(result.stdout)
    found: dict[str | None, set[str]] = {}
    for one in document["campaigns"]:
        for flag in one["flags"]:
            found.setdefault(flag["channel"], set()).add(flag["code"])
    return document, found


def _copied(folder: Path, **changed: str) -> Path:
    """Return a copy of the example whose mapping lines are others."""
    lines = (FOLDER / "campaign.toml").read_text(encoding="utf-8").splitlines()
    for name, line in changed.items():
        (at,) = (k for k, text in enumerate(lines) if text.startswith(f"{name} = "))
        lines[at] = f"{name} = {line}"
    for recording in FOLDER.glob("*.csv.gz"):
        (folder / recording.name).symlink_to(recording)
    path = folder / "campaign.toml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def test_the_mapping_has_ten_lines() -> None:
    text = (FOLDER / "campaign.toml").read_text(encoding="utf-8")
    block = text[text.index("[columns]") :].split("\n\n", 1)[0]
    assert len(block.splitlines()) == 10


def test_nothing_is_said_of_the_right_mapping() -> None:
    document, flags = _flags(FOLDER)
    assert flags == {}
    assert len(document["runs"]) == 6
    assert document["failed"] == []


def test_gaps_are_said() -> None:
    document, _ = _flags(FOLDER)
    codes = {Path(run["file"]).name: {flag["code"] for flag in run["flags"]}
             for run in document["runs"]}  # fmt: skip
    assert {"gap", "missing"} <= codes["nicken_120.csv.gz"]
    assert all("repaired" in one for one in codes.values())


def test_a_first_try_is_told_unit_and_sign() -> None:
    _, flags = _flags(FOLDER / "first-try.toml")
    assert flags == {
        "force_aft": {"units_implausible"},
        "force_fore": {"units_implausible", "sign_opposite"},
    }


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("channel", "line", "code"),
    [
        ("force_aft", '"-Kraft A:kN"', "sign_opposite"),
        ("force_aft", '"Kraft A:N"', "units_implausible"),
        ("displacement_fore", '"Weg B [mm]:m"', "units_implausible"),
        ("displacement_fore", '"-Weg B [mm]"', "sign_opposite"),
    ],
)
def test_each_fault_of_a_mapping_is_named(
    tmp_path: Path, channel: str, line: str, code: str
) -> None:
    _, flags = _flags(_copied(tmp_path, **{channel: line}))
    assert code in flags[channel]


def test_degrees_that_are_not_said_are_caught(tmp_path: Path) -> None:
    document, _ = _flags(_copied(tmp_path, shaft_angle='"Kurbel"'))
    assert document["runs"] == []
    assert all("a turn in degrees" in one["message"] for one in document["failed"])


def test_the_forces_are_those_of_the_recipe() -> None:
    """In phase and quadrature of pure heave follow from the put-in mass, damping and stiffness."""
    truth = tomllib.loads((FOLDER / "truth.toml").read_text(encoding="utf-8"))
    campaign = read_campaign(FOLDER / "campaign.toml")
    assert isinstance(campaign.columns, ColumnMap)
    for run in campaign.runs[:3]:
        recording = read_recording(FOLDER / str(run.file), campaign.columns)
        (reading,) = analyse(recording).readings
        rows = [reading.channel_names.index(name) for name in ("force_aft", "force_fore")]
        total = sum(complex(*reading.coefficients[row, 1:3]) for row in rows)
        omega, e = 2.0 * math.pi * run.frequency_hz, run.eccentricity_m
        mass = truth["model"]["mass_kg"] + truth["hull"]["added_mass"][0][0]
        stiffness = truth["hull"]["restoring"][0][0]
        expected = e * complex(stiffness - omega**2 * mass, omega * truth["hull"]["damping"][0][0])
        assert total == pytest.approx(expected, abs=0.02)  # noise and the last printed digit
