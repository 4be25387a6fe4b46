"""Campaigns as labs hand them over: what is missing or wrong is said, and the cause still named."""

import json
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from tests.pmm.gap.rigs import FEW, FRICTION_N, RUNS, changed, made, rewritten, run, with_friction

ADDING = Path(__file__).parents[3] / "docs" / "adding-an-effect.md"
STRUTS = "displacement_aft,displacement_fore"
FORCES = "force_aft,force_fore"


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return with_friction(tmp_path_factory.mktemp("poor"))


def found(campaign: Path, *options: str | Path) -> dict[str, Any]:
    """Return what the command finds, as a document."""
    done = run("gap", campaign, *FEW, "--json", *options)
    assert done.exit_code == 0, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    return document


def friction(document: dict[str, Any]) -> float:
    """Return the friction that the most probable answer names, and only it."""
    assert document["verdict"] == "effect"
    (effect,) = document["ranking"][0]["effects"]
    assert effect["name"] == "coulomb-friction"
    return float(effect["parameters"]["friction_n"]["value"])


@pytest.mark.slow
@pytest.mark.parametrize(
    "sensors",
    [
        f"photocell,{STRUTS},{FORCES}",
        f"photocell,shaft_angle,{FORCES}",
        f"{STRUTS},{FORCES}",
        "photocell,force_fore",
    ],
    ids=["no encoder", "no strut sensors", "no photocell", "one force"],
)
def test_fewer_sensors(rig: Path, sensors: str) -> None:
    document = found(rig, "--sensors", sensors)
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)
    seen = {one["channel"] for one in document["cells"]} - {""}
    assert seen <= set(sensors.split(","))


def test_a_sensor_that_nobody_has_is_refused(rig: Path) -> None:
    done = run("gap", rig, *FEW, "--sensors", "force_aft,force_for")
    assert done.exit_code == 2
    assert "--sensors: no channel 'force_for'; did you mean 'force_fore'?" in done.stderr


@pytest.mark.slow
def test_one_amplitude(rig: Path, tmp_path: Path) -> None:
    """The law in amplitude is hidden; friction is named by its harmonics."""
    _, *runs = (rig / "campaign.toml").read_text().split("[[runs]]")
    (small,) = [one for one in runs if "heave-0.80-10" in one]
    campaign = rewritten(rig, tmp_path, "[[runs]]" + small, "")
    assert friction(found(campaign)) == pytest.approx(FRICTION_N, rel=0.05)


@pytest.mark.slow
def test_runs_without_recording(rig: Path, tmp_path: Path) -> None:
    campaign = rewritten(rig, tmp_path, "", "")
    (campaign / "heave-1.10-20.nc").unlink()
    document = found(campaign)
    assert list(document["left_out"]) == ["heave-1.10-20"]
    assert "heave-1.10-20.nc" in document["left_out"]["heave-1.10-20"]
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)
    for name in RUNS[:2]:
        (campaign / f"{name}.nc").unlink()
    done = run("gap", campaign, *FEW)
    assert done.exit_code == 1
    assert "2 runs to fit, a diagnosis needs 3" in done.stderr


def with_angles(rig: Path, folder: Path, change: Callable[[xr.Dataset], xr.Dataset]) -> Path:
    """Copy a campaign with all its recordings changed."""
    for number, name in enumerate(RUNS):
        (folder / str(number)).mkdir()
        rig = changed(rig, folder / str(number), name, change)
    return rig


def in_kilonewtons(record: xr.Dataset) -> xr.Dataset:
    return record.assign(force_aft=record["force_aft"].copy(data=record["force_aft"].values / 1e3))


def with_the_wrong_sign(record: xr.Dataset) -> xr.Dataset:
    return record.assign(force_fore=record["force_fore"].copy(data=-record["force_fore"].values))


def in_a_smaller_range(record: xr.Dataset) -> xr.Dataset:
    values = record["force_aft"].values
    return record.assign(force_aft=record["force_aft"].copy(data=np.minimum(values, 6.0)))


def in_degrees(record: xr.Dataset) -> xr.Dataset:
    angle = record["shaft_angle"]
    return record.assign(shaft_angle=angle.copy(data=np.degrees(angle.values) % 360.0))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "said"),
    [
        (in_a_smaller_range, r"force_aft: clipped: \d+ % of its samples stand at 6 N"),
        (in_degrees, r"shaft_angle: it goes on by 360 each period, .*: deg in place of rad\?"),
        (in_kilonewtons, r"force_aft: 0\.001 times as large as the other runs let expect: .*kN"),
        (with_the_wrong_sign, "force_fore: its sign is the opposite of the other runs'"),
    ],
)
def test_one_bad_run(rig: Path, tmp_path: Path, change: Any, said: str) -> None:
    document = found(changed(rig, tmp_path, RUNS[1], change))
    assert list(document["left_out"]) == [RUNS[1]]
    assert re.search(said, document["left_out"][RUNS[1]])
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)


@pytest.mark.slow
@pytest.mark.parametrize(("torn_periods", "left_out"), [((1, 4), False), ((0, 1, 3, 4), True)])
def test_samples_that_are_missing_in_some_periods(
    rig: Path, tmp_path: Path, torn_periods: tuple[int, ...], left_out: bool
) -> None:
    """No stretch of whole periods is left; those that are torn count for nothing."""

    def torn(record: xr.Dataset) -> xr.Dataset:
        values = record["force_aft"].values.copy()
        for period in torn_periods:
            begins = int((period + 0.5) / 6.0 * len(values))
            values[begins : begins + 30] = np.nan
        return record.assign(force_aft=record["force_aft"].copy(data=values))

    document = found(changed(rig, tmp_path, "heave-0.80-20", torn))
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)
    assert document["class_probability"] > 0.9
    assert ("heave-0.80-20" in document["left_out"]) is left_out
    if left_out:
        assert "whole periods have no missing samples" in document["left_out"]["heave-0.80-20"]


@pytest.mark.slow
def test_shaft_angles_in_degrees_in_all_runs(rig: Path, tmp_path: Path) -> None:
    campaign = with_angles(rig, tmp_path, in_degrees)
    done = run("gap", campaign, *FEW)
    assert done.exit_code == 1
    assert "shaft_angle: in all runs it goes on by 360 each period" in done.stderr
    assert "deg in place of rad? Then say the column's unit in the campaign" in done.stderr


@pytest.mark.slow
def test_shaft_angles_that_begin_anew_at_each_turn(rig: Path, tmp_path: Path) -> None:
    def wrapped(record: xr.Dataset) -> xr.Dataset:
        angle = record["shaft_angle"]
        return record.assign(shaft_angle=angle.copy(data=angle.values % (2.0 * np.pi)))

    document = found(with_angles(rig, tmp_path, wrapped))
    assert document["left_out"] == {}
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)


@pytest.mark.slow
def test_nominal_model_far_off(rig: Path, tmp_path: Path) -> None:
    """45 kg of added mass stated where there are 75, in a tolerance of 20 %."""
    campaign = rewritten(rig, tmp_path, "[[75.0, 3.0]", "[[45.0, 3.0]")
    document = found(campaign)
    assert friction(document) == pytest.approx(FRICTION_N, rel=0.05)
    (added,) = [one for one in document["coefficients"] if one["name"] == "Z_wdot"]
    assert added["stated"] == pytest.approx(-45.0)
    assert added["with_effect"] == pytest.approx(-75.0, rel=0.01)


def example() -> str:
    found = re.findall(r"^```python\n(.*?)^```", ADDING.read_text(), flags=re.MULTILINE | re.DOTALL)
    return str(found[0])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("broken", "said"),
    [
        ("def change(self, rig, set_point):\n    raise ValueError('oops')", "ValueError: oops"),
        ("def force(self, motion):\n    return motion.position * float('nan')", "not a number"),
    ],
)
def test_an_effect_of_the_users_own_that_is_broken(
    rig: Path, tmp_path: Path, broken: str, said: str
) -> None:
    own, name = tmp_path / "rubber_boot.py", broken[4:].split("(")[0]
    of = {"change": "RubberBoot", "force": "Stiffening"}[name]
    own.write_text(f"{example()}\n\n{broken}\n\n\n{of}.{name} = {name}\n")
    done = run("gap", rig, *FEW, "--effects", own)
    assert done.exit_code == 2
    assert "effect rubber-boot, of your own" in done.stderr
    assert said in done.stderr


@pytest.mark.slow
def test_an_effect_of_the_users_own(tmp_path: Path) -> None:
    own = tmp_path / "rubber_boot.py"
    own.write_text(example())
    effect = ("--effect", "rubber-boot:stiffening_n_m2=6000", "--effects-file", own)
    rig = made(tmp_path, *effect)
    document = found(rig, "--effects", own)
    assert document["ranking"][0]["answer"] == "rubber-boot"
    size = document["ranking"][0]["effects"][0]["parameters"]["stiffening_n_m2"]
    assert size["low"] < 6000.0 < size["high"]
    added = run("gap", "add", rig, "--effect", "rubber-boot", "--effects", own)
    assert added.exit_code == 0, added.output
    again = run("gap", rig, *FEW, "--effects", own)
    assert again.stdout.startswith("gap: No gap: ")


@pytest.mark.slow
def test_a_zero_that_drifts_over_the_campaign(tmp_path: Path) -> None:
    """Not within the runs alone, and not a zero that is off by one amount."""
    rig = made(tmp_path, "--effect", "campaign-drift:aft_n_s=2e-4")
    rivals = ("--effects", "zero-drift", "--effects", "zero-offset")
    document = found(rig, "--effects", "campaign-drift", *rivals)
    first = document["ranking"][0]
    assert first["answer"] == "campaign-drift"
    drift = first["effects"][0]["parameters"]["aft_n_s"]
    assert drift["low"] < 2e-4 < drift["high"]
    assert drift["value"] == pytest.approx(2e-4, rel=0.05)
