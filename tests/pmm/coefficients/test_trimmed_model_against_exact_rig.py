"""A trimmed model in heave and pitch, recorded by the exact rig: what it has put in comes back."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.oscillator import Plane
from pmm.cli import cli
from tests.analysis.coefficients.exact_campaigns import HULLS, afloat, under_water
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig
from tests.exact.run import record

RUNS = ((0.0, 0.12, 0.0), (14.0, 0.0, 0.0), (7.0, 0.0, 0.0), (12.0, 0.1, 5.0), (9.0, 0.05, -8.0),
        (0.0, 0.06, 0.0), (10.0, 0.03, 3.0))  # fmt: skip
"""Pitch in degrees, heave in m, trim in degrees."""
ARRANGEMENTS = (
    Arrangement(Joint.SLIDES_ON_MODEL, Pivot.AFT, Gauges.RIG, DriftBy.STRUTS_OFFSET),
    Arrangement(Joint.SLIDES_ON_RIG, Pivot.FORE, Gauges.MODEL, DriftBy.MODEL_TURNED),
)
CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore", "force_x")
HERTZ, RATE_HZ = 0.3, 40.0


def campaign(folder: Path, arrangement: Arrangement, *, floats: bool) -> Path:
    """Write a campaign as somebody else's, of tared recordings in text."""
    rigs = [
        (afloat if floats else under_water)(
            exact_rig(
                Plane.VERTICAL, arrangement, rotation_rad=math.radians(pitch), sway_m=heave,
                drift_rad=math.radians(trim), frequency_hz=HERTZ,
            )
        )
        for pitch, heave, trim in RUNS
    ]  # fmt: skip
    text = [*_head(rigs[0], arrangement), "[model]", *_mass(rigs[0])]
    if not floats:
        body = rigs[0].body
        text += [
            f"displaced_kg = {body.displaced_kg}",
            f"buoyancy_x_m = {body.buoyancy_x_m}",
            f"buoyancy_z_m = {body.buoyancy_across_m}",
        ]
    text += ["[hull]", f"restoring = {rigs[0].restoring.tolist()}"]
    for k, rig in enumerate(rigs):
        made = record(rig, RATE_HZ, 11.0, noise=0.03, displacement_noise_m=1e-5, seed=k, tared=True)
        time = np.arange(len(made.channels["force_x"])) / RATE_HZ
        shaft = 2.0 * np.pi * HERTZ * time
        table = np.column_stack([time, shaft, *(made.channels[name] for name in CHANNELS)])
        names = ",".join(["time [s]", "shaft_angle [rad]", *(f"{name} []" for name in CHANNELS)])
        np.savetxt(folder / f"run-{k}.csv", table, delimiter=",", header=names, comments="")
        text += ["[[runs]]", f'name = "run-{k}"', f'file = "run-{k}.csv"']
        text += [f"frequency_hz = {HERTZ}", "eccentricity_m = 0.1", "carriage_speed_m_s = 1.2"]
        text += [f"drift_rad = {rig.drift_rad}"]
    (folder / "campaign.toml").write_text("\n".join(text).replace(" []", ""))
    return folder


def _head(rig: ExactRig, arrangement: Arrangement) -> list[str]:
    return [
        'name = "trimmed"', "tared = true", "photocell = false", "[oscillator]",
        'plane = "vertical"', f"half_spacing_m = {rig.half_spacing_m}",
        "frequency_hz = { low = 0.01, high = 2.0 }", "eccentricity_m = { low = 0.0, high = 1.0 }",
        "force_per_strut_n = 1e5", *(f'{key} = "{way}"' for key, way in vars(arrangement).items()),
    ]  # fmt: skip


def _mass(rig: ExactRig) -> list[str]:
    body = rig.body
    return [
        f"mass_kg = {body.mass_kg}", f"inertia_kg_m2 = {body.inertia_kg_m2}",
        f"cg_x_m = {body.cg_x_m}", f"cg_z_m = {body.cg_across_m}",
    ]  # fmt: skip


def found(folder: Path, *options: str) -> dict[str, Any]:
    run = CliRunner().invoke(cli, ["coefficients", str(folder), "--json", *options])
    assert run.exit_code == 0, run.stderr
    return {row["name"]: row for row in json.loads(run.stdout)["recommended"]}


@pytest.mark.slow
@pytest.mark.parametrize("floats", [True, False])
@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=lambda one: "-".join(vars(one).values()))
def test_coefficients_lie_in_their_intervals(
    arrangement: Arrangement, floats: bool, tmp_path: Path
) -> None:
    rows = found(campaign(tmp_path, arrangement, floats=floats))
    truth = HULLS[Plane.VERTICAL]
    assert set(truth) <= set(rows)
    apart = {
        name: (rows[name]["value"] - value) / rows[name]["half_width"]
        for name, value in truth.items()
    }
    assert max(map(abs, apart.values())) < 2.0, apart


@pytest.mark.slow
def test_what_the_water_bears_stays_with_another_inertia(tmp_path: Path) -> None:
    """A swing tells nothing of it: the campaign's own holds."""
    folder = campaign(tmp_path, ARRANGEMENTS[0], floats=False)
    rig = under_water(exact_rig(Plane.VERTICAL, ARRANGEMENTS[0], rotation_rad=0.1))
    path = tmp_path / "swing.toml"
    path.write_text("\n".join(["[model]", *_mass(rig)]))
    own, swung = found(folder), found(folder, "--inertia", str(path))
    assert {name: row["value"] for name, row in swung.items()} == {
        name: row["value"] for name, row in own.items()
    }


def test_a_centre_of_buoyancy_needs_a_displacement(tmp_path: Path) -> None:
    folder = campaign(tmp_path, ARRANGEMENTS[0], floats=False)
    path = folder / "campaign.toml"
    text = path.read_text()
    path.write_text("\n".join(one for one in text.splitlines() if "displaced_kg" not in one))
    run = CliRunner().invoke(cli, ["coefficients", str(folder)])
    assert run.exit_code == 2
    assert "give displaced_kg as well" in run.stderr


@pytest.mark.slow
def test_a_zero_run_at_another_trim_is_told(tmp_path: Path) -> None:
    folder = campaign(tmp_path, ARRANGEMENTS[0], floats=True)
    head, *runs = (folder / "campaign.toml").read_text().split("[[runs]]")
    named = "\n".join(['zero_before = "zero"', 'zero_after = "zero"', ""])
    rest = '[[at_rest]]\nname = "zero"\nfile = "zero.csv"\nkind = "zero"\nduration_s = 10.0\n'
    text = head + "".join(f"[[runs]]{one.rstrip()}\n{named}" for one in runs) + rest
    (folder / "campaign.toml").write_text(text)
    time = np.arange(400) / RATE_HZ
    noise = 1e-3 * np.random.default_rng(5).standard_normal((6, len(time)))
    names = ",".join(["time [s]", "shaft_angle [rad]", *CHANNELS])
    table = np.column_stack([time, *noise])
    np.savetxt(folder / "zero.csv", table, delimiter=",", header=names, comments="")
    run = CliRunner().invoke(cli, ["coefficients", str(folder), "--json"])
    assert run.exit_code == 0, run.stderr
    told = [
        one["name"]
        for one in json.loads(run.stdout)["runs"]
        if any(flag["code"] == "zero_elsewhere" for flag in one["flags"])
    ]
    assert told == [f"run-{k}" for k, (_, _, trim) in enumerate(RUNS) if trim]
