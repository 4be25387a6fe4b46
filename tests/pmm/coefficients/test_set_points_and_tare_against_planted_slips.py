"""Recordings under a wrong run's name are said to be, and tared ones need no zero runs."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.readers import read_recording, write_recording
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.setpoint import SetPoint
from pmm.cli import cli
from tests.pmm.coefficients.campaigns import (
    at_rest,
    head,
    horizontal_rig,
    record,
    vertical_campaign,
)


def done(*words: object) -> dict[str, Any]:
    result = CliRunner().invoke(cli, ["coefficients", *map(str, words), "--json"])
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def flagged(found: dict[str, Any]) -> set[str]:
    return {
        run
        for one in found["runs"]
        for flag in one["flags"]
        if flag["code"] == "set_point_differs"
        for run in flag["runs"]
    }


def swapped(folder: Path, suffix: str) -> None:
    first, other = (folder / f"{kind}-0.6-20{suffix}" for kind in ("one", "two"))
    first.rename(folder / "x")
    other.rename(first)
    (folder / "x").rename(other)


@pytest.mark.slow
def test_two_recordings_of_our_own_that_changed_places(tmp_path: Path) -> None:
    vertical_campaign(tmp_path, (0.6, 0.9))
    assert flagged(done(tmp_path)) == set()
    swapped(tmp_path, ".nc")
    assert flagged(done(tmp_path)) == {"one-0.6-20", "two-0.6-20"}
    shown = CliRunner().invoke(cli, ["coefficients", str(tmp_path)]).stdout
    assert "one-0.6-20, two-0.6-20: recorded with strut phase" in shown


@pytest.mark.slow
def test_two_text_recordings_that_changed_places(tmp_path: Path) -> None:
    vertical_campaign(tmp_path, (0.6,))
    for path in sorted(tmp_path.glob("*.nc")):
        as_text(path)
    text = (tmp_path / "campaign.toml").read_text()
    for name in ("one-0.6-20", "two-0.6-20"):
        text = text.replace(f'name = "{name}"\n', f'name = "{name}"\nfile = "{name}.csv"\n')
    (tmp_path / "campaign.toml").write_text(text)
    assert flagged(done(tmp_path)) == set()
    swapped(tmp_path, ".csv")
    assert flagged(done(tmp_path)) == {"one-0.6-20", "two-0.6-20"}


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("text", "told_hz", "named"),
    [(True, 0.604, False), (True, 0.608, True), (True, 0.45, True), (False, 0.604, True)],
)
def test_a_run_at_another_frequency_than_it_was_told(
    tmp_path: Path, text: bool, told_hz: float, named: bool
) -> None:
    """The shaft turned at 0.6 Hz, and the coefficients go with that.

    A measured frequency may be 1 % off what was told; a set-point that our own recording carries
    may not be another than the campaign's at all.
    """
    vertical_campaign(tmp_path, (0.6,))
    campaign = (tmp_path / "campaign.toml").read_text()
    for name in ("one-0.6-20", "two-0.6-20"):
        if text:
            as_text(tmp_path / f"{name}.nc")
            campaign = campaign.replace(
                f'name = "{name}"\n', f'name = "{name}"\nfile = "{name}.csv"\n'
            )
    slipped = campaign.replace("frequency_hz = 0.6\n", f"frequency_hz = {told_hz}\n", 1)
    assert slipped != campaign
    (tmp_path / "campaign.toml").write_text(slipped)
    found = done(tmp_path)
    assert flagged(found) == ({"one-0.6-20"} if named else set())
    turned = [row["frequency_hz"] for row in found["coefficients"]["table"]]
    np.testing.assert_allclose(turned, 0.6, rtol=1e-4)


def as_text(path: Path) -> None:
    """Write a recording's struts and forces as other systems do, and take the NetCDF away."""
    recording = read_recording(path)
    names = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")
    time_s = np.arange(recording.samples.shape[1]) / recording.sample_rate_hz
    table = np.column_stack([time_s, *(recording.values(name) for name in names)])
    heads = "time [s],displacement_aft [m],displacement_fore [m],force_aft [N],force_fore [N]"
    np.savetxt(path.with_suffix(".csv"), table, delimiter=",", header=heads, comments="")
    path.unlink()


def tows(folder: Path) -> None:
    """Write tared static drift runs of a hull with Y_v = -120 and N_v = -40, and one sway."""
    rig, speed = horizontal_rig(), 1.2
    text = "tared = true\n" + head(rig)
    text += record(folder, rig, "sway", SetPoint(0.3, 0.05, 0.0, speed))
    for k, angle in enumerate(np.radians([-6.0, 0.0, 6.0])):
        sway = speed * math.sin(angle)
        force, moment = 120.0 * sway, 40.0 * sway  # what the struts exert, against the water
        half = rig.oscillator.half_spacing_m
        mean = (force / 2.0 - moment / (2.0 * half), force / 2.0 + moment / (2.0 * half))
        write_recording(at_rest(f"drift-{k}", mean), folder / f"drift-{k}.nc")
        text += (
            f'\n[[at_rest]]\nname = "drift-{k}"\nkind = "static-drift"\nfile = "drift-{k}.nc"\n'
            f"duration_s = 10.0\ncarriage_speed_m_s = {speed}\ndrift_rad = {angle}\n"
        )
    (folder / "campaign.toml").write_text(text)


@pytest.mark.slow
def test_tared_tows_need_no_zero_runs(tmp_path: Path) -> None:
    assert (FORCE_AFT.name, FORCE_FORE.name) == ("force_aft", "force_fore")
    tows(tmp_path)
    table = done(tmp_path)["coefficients"]["table"]
    static = {row["name"]: row for row in table if row["method"] == "static drift"}
    assert abs(static["Y_v"]["value"]) == pytest.approx(120.0, rel=2e-3)
    assert abs(static["N_v"]["value"]) == pytest.approx(40.0, rel=2e-3)
    path = tmp_path / "campaign.toml"
    path.write_text(path.read_text().replace("tared = true\n", ""))
    refused = CliRunner().invoke(cli, ["coefficients", str(tmp_path)])
    assert refused.exit_code == 1
    assert "no zero run is named" in refused.stderr
    assert "tared = true" in refused.stderr
