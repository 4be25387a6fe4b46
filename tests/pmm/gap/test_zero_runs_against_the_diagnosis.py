"""Zero runs in a campaign's folder: picked up, compared, and left out with a reason."""

import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from hardware.description.kinds import RunKind
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import AtRest, Run
from pmm.gap.at_rest import records_at_rest
from pmm.gap.load import load_campaign
from tests.pmm.gap.rigs import changed, run, short
from tests.pmm.run.harness import at_rest, bench, oscillation

EFFECTS = tuple(
    text
    for name in ("zero-offset", "surface-suction", "gain-error")
    for text in ("--effects", name)
)
OFFSET_N = 0.4
ZEROS = ("zero-1", "zero-5", "zero-8")


def zero(number: int) -> str:
    name = f"zero-{number}"
    keys = f'name = "{name}"\nkind = "zero"\nfile = "{name}/run.nc"\nduration_s = 20.0\n'
    return f"[[at_rest]]\n{keys}number = {number}\n\n"


def with_zeros() -> str:
    """Return the short campaign with a zero run before, one amid and one after its runs."""
    head, *runs = short().split("[[runs]]")
    numbered = [
        f"[[runs]]{one.rstrip()}\nnumber = {number}\n\n"
        for one, number in zip(runs, (2, 3, 4, 6, 7), strict=True)
    ]
    return "".join([head, *numbered, *(zero(number) for number in (1, 5, 8))])


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulate it with a zero that is off."""
    folder = tmp_path_factory.mktemp("zeros")
    (folder / "zeros.toml").write_text(with_zeros())
    effect = ("--effect", f"zero-offset:aft_n={OFFSET_N}")
    done = run("simulate", folder / "zeros.toml", "--output", folder / "rig", *effect, "--json")
    assert done.exit_code == 0, done.output
    files = [Path(one).name for one in json.loads(done.stdout)["at_rest"]]
    assert files == [f"{name}.nc" for name in ZEROS]
    return folder / "rig"


def found(campaign: Path, *options: str) -> dict[str, Any]:
    done = run("gap", campaign, *EFFECTS, "--json", *options)
    assert done.exit_code == 0, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    return document


def offset(document: dict[str, Any]) -> dict[str, float]:
    """Return the zero offset that is named, and only it."""
    assert document["ranking"][0]["answer"] == "zero-offset"
    (effect,) = document["ranking"][0]["effects"]
    size: dict[str, float] = effect["parameters"]["aft_n"]
    return size


@pytest.mark.slow
def test_they_are_runs_among_the_others(rig: Path) -> None:
    document = found(rig)
    assert offset(document)["value"] == pytest.approx(OFFSET_N, abs=3e-3)
    assert {*ZEROS} <= {*document["runs"]}
    assert document["left_out"] == {}
    withheld = {one["regime"] for one in document["regimes"]}
    assert "medium rest" in withheld
    assert not {one for one in withheld if one.endswith(" 0 mm")}


@pytest.mark.slow
def test_runs_are_withheld_as_ever(rig: Path) -> None:
    document = found(rig, "--hold-out", "frequency=1.1")
    assert offset(document)["value"] == pytest.approx(OFFSET_N, abs=3e-3)
    assert [one["regime"] for one in document["regimes"]] == ["run heave-1.10-20"]


def loaded(record: xr.Dataset, force_n: float) -> xr.Dataset:
    more = record["force_aft"].values + force_n
    return record.assign(force_aft=record["force_aft"].copy(data=more))


def loaded_with_a_newton(record: xr.Dataset) -> xr.Dataset:
    return loaded(record, 1.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("said", "names"), [("zero-8", ["zero-8"]), ("medium=rest", [*ZEROS])], ids=["name", "all"]
)
def test_they_are_withheld_and_predicted(
    rig: Path, tmp_path: Path, said: str, names: list[str]
) -> None:
    """A record that carries a newton stands out, and changes nothing of what is fitted."""
    document = found(changed(rig, tmp_path, "zero-8", loaded_with_a_newton), "--hold-out", said)
    assert offset(document)["value"] == pytest.approx(OFFSET_N, abs=0.01)
    assert document["held_out"] == names
    assert not {*names} & {*document["runs"]}
    after = {one["regime"].removeprefix("run "): one["after"] for one in document["regimes"]}
    assert [*after] == names
    assert after.pop("zero-8") > 10.0
    assert all(one < 2.0 for one in after.values())
    told = [one for one in document["notes"] if one.startswith("run zero-8 is not foretold: ")]
    assert len(told) == 1


@pytest.mark.slow
def test_one_that_is_off_is_named_and_takes_no_name_away(tmp_path: Path) -> None:
    """Friction does not show at rest: what a zero record has besides says nothing of it."""
    (tmp_path / "zeros.toml").write_text(with_zeros())
    effect = ("--effect", "coulomb-friction:friction_n=0.3")
    done = run("simulate", tmp_path / "zeros.toml", "--output", tmp_path / "rig", *effect)
    assert done.exit_code == 0, done.output
    off = changed(tmp_path / "rig", tmp_path, "zero-5", lambda one: loaded(one, 0.3))
    document = found(off, "--effects", "coulomb-friction")
    assert document["ranking"][0]["answer"] == "coulomb-friction"
    assert any(one.startswith("run zero-5 alone has a gain or a zero") for one in document["notes"])


def test_a_record_at_rest_that_nobody_compares_cannot_be_withheld(
    rig: Path, tmp_path: Path
) -> None:
    copy = shutil.copytree(rig, tmp_path / "copy")
    path = copy / "campaign.toml"
    head, *records = path.read_text().split("[[at_rest]]")
    records[1] = records[1].replace('"zero"', '"pluck"')
    path.write_text("[[at_rest]]".join([head, *records]))
    done = run("gap", copy, "--hold-out", "zero-5")
    assert done.exit_code == 2
    assert "zero runs alone are compared, and this is of kind 'pluck'" in done.stderr


@pytest.mark.slow
def test_without_struts_nothing_tells_where_they_stand(rig: Path) -> None:
    loaded = load_campaign(rig, sensors=("photocell", "force_aft", "force_fore"))
    assert {*loaded.left_out} == {*ZEROS}
    assert "tells where its struts stand" in loaded.left_out["zero-1"]
    assert not loaded.at_rest


@pytest.mark.slow
def test_what_cannot_be_used_is_said(rig: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(rig, tmp_path / "copy")
    (copy / "zero-5.nc").unlink()
    path = copy / "campaign.toml"
    path.write_text(path.read_text() + 'outcome = "stopped"\n')  # of the last table, zero-8
    loaded = load_campaign(copy)
    assert {*loaded.left_out} == {"zero-5", "zero-8"}
    assert "run.nc" in loaded.left_out["zero-5"]
    assert loaded.left_out["zero-8"] == "its outcome is 'stopped'"
    assert [one.name for one in loaded.at_rest] == ["zero-1"]


@pytest.mark.slow
def test_what_run_control_has_put_in_folders_is_used(rig: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(rig, tmp_path / "copy")
    for name in ZEROS:
        (copy / name).mkdir()
        (copy / f"{name}.nc").rename(copy / name / "run.nc")
    assert [one.name for one in load_campaign(copy).at_rest] == list(ZEROS)


@pytest.mark.slow
def test_one_that_nobody_numbers_is_left_out(rig: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(rig, tmp_path / "copy")
    path = copy / "campaign.toml"
    path.write_text(path.read_text().replace("number = 8\n", ""))
    assert "nothing says when 'zero-8' was made" in load_campaign(copy).left_out["zero-8"]


@pytest.mark.slow
def test_run_controls_own_are_read_within_their_gate(tmp_path: Path) -> None:
    """The simulated gauges' zero is none, and the gate is open for a second: ten blocks."""
    runs = [at_rest("zero-1", RunKind.ZERO), oscillation(), at_rest("zero-2", RunKind.ZERO)]
    with bench(tmp_path, runs) as one:
        one.finish(40000)
    first, last = (
        AtRest(f"zero-{at}", RunKind.ZERO, f"zero-{at}/run.nc", 1.0, number=number)
        for at, number in ((1, 1), (2, 3))
    )
    campaign = Campaign(runs=(Run("heave", 1.0, 0.02, number=2),), at_rest=(first, last))
    used, left_out, damaged = records_at_rest(campaign, tmp_path)
    assert (left_out, damaged) == ({}, {})
    for record in used:
        assert record.observed.values == pytest.approx(np.zeros(2), abs=0.05)
        assert record.set_point.frequency_hz == pytest.approx(10.0, rel=0.02)
