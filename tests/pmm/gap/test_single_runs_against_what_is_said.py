"""A run that alone is off, or of which a part was lost, is said by name."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from pmm.gap.load import load_campaign
from tests.pmm.gap.rigs import FEW, RUNS, changed, run, short, with_friction

ODD = RUNS[1]
PERIODS = 10
FREQUENCY_HZ = 0.8


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return _simulated(tmp_path_factory.mktemp("clean"), RUNS)


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The campaign without any other run."""
    return _simulated(tmp_path_factory.mktemp("alone"), (ODD,))


def _simulated(folder: Path, names: Sequence[str]) -> Path:
    text = short(names).replace("periods = 6", f"periods = {PERIODS}")
    (folder / "short.toml").write_text(text)
    done = run("simulate", folder / "short.toml", "--output", folder / "rig")
    assert done.exit_code == 0, done.output
    return folder / "rig"


def notes(campaign: Path, *options: str) -> list[str]:
    """Return what the command notes."""
    done = run("gap", campaign, *FEW, "--json", *options)
    assert done.exit_code == 0, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    assert document["left_out"] == {}
    return list(document["notes"])


def with_gain(record: xr.Dataset) -> xr.Dataset:
    return record.assign(force_aft=record["force_aft"] * 1.15)


def with_zero(record: xr.Dataset) -> xr.Dataset:
    return record.assign(force_aft=record["force_aft"] + 5.0)


@pytest.mark.slow
@pytest.mark.parametrize("change", [with_gain, with_zero])
def test_a_gain_or_zero_off_in_one_run(
    clean: Path, tmp_path: Path, change: Callable[[xr.Dataset], xr.Dataset]
) -> None:
    def kept(record: xr.Dataset) -> xr.Dataset:
        off = change(record)
        off["force_aft"].attrs = record["force_aft"].attrs
        return off

    campaign = changed(clean, tmp_path, ODD, kept)
    (said,) = [one for one in notes(campaign) if one.startswith("run ")]
    assert said.startswith(f"run {ODD} alone has a gain or a zero of its own (probability ")
    assert said.endswith(f"a bad run? withhold it with --hold-out {ODD}")
    # What the note asks for is an option as it stands.
    option, name = said.split()[-2:]
    assert notes(campaign, option, name) == []


@pytest.mark.slow
@pytest.mark.parametrize("change", [with_gain, with_zero])
def test_a_gain_or_zero_off_in_one_run_beside_friction_in_all(
    tmp_path: Path, change: Callable[[xr.Dataset], xr.Dataset]
) -> None:
    def kept(record: xr.Dataset) -> xr.Dataset:
        off = change(record)
        off["force_aft"].attrs = record["force_aft"].attrs
        return off

    campaign = changed(with_friction(tmp_path), tmp_path, ODD, kept)
    (odd,) = [one for one in notes(campaign) if one.startswith("run ")]
    assert odd.startswith(f"run {ODD} alone has a gain or a zero of its own (probability ")
    option, name = odd.split()[-2:]
    document = json.loads(run("gap", campaign, *FEW, "--json", option, name).stdout)
    assert document["ranking"][0]["answer"] == "coulomb-friction"
    (note,) = document["notes"]
    assert note.startswith(f"run {ODD} is not foretold: ")


@pytest.mark.slow
def test_nothing_is_said_of_runs_as_they_should_be(clean: Path) -> None:
    assert notes(clean) == []


@pytest.mark.slow
def test_an_effect_in_all_runs_is_no_bad_run(tmp_path: Path) -> None:
    assert not [one for one in notes(with_friction(tmp_path)) if one.startswith("run ")]


def damaged(record: xr.Dataset, value: float, *periods: int, samples: int, names: Any) -> Any:
    """Put a value on samples in the middle of some whole periods, counted from 0."""
    edges_s = np.sort(record["photocell_edge_time"].values)
    time_s = record["time"].values
    changes = {}
    for name in names:
        values = record[name].values.copy()
        for period in periods:
            at = int(np.searchsorted(time_s, edges_s[0] + (period + 0.4) / FREQUENCY_HZ))
            values[at : at + samples] = value
        changes[name] = record[name].copy(data=values)
    return record.assign(changes)


def cut_short(rig: Path, folder: Path, value: float, *periods: int, **how: Any) -> str:
    """Return what is said of the run of a campaign that is damaged."""
    campaign = changed(rig, folder, ODD, lambda one: damaged(one, value, *periods, **how))
    found = load_campaign(campaign)
    assert set(found.cut_short) <= {ODD}
    assert not found.left_out
    return found.cut_short.get(ODD, "")


@pytest.mark.sample(1)
@pytest.mark.parametrize(("period", "left"), [(1, 8), (4, 5), (6, 6), (9, 9)])
def test_one_missing_sample(alone: Path, tmp_path: Path, period: int, left: int) -> None:
    """The longer part before or after the period that has it is used."""
    said = cut_short(alone, tmp_path, np.nan, period, samples=1, names=["force_aft"])
    assert said.startswith(f"{left} of its {PERIODS} whole periods used: one sample is missing in ")
    assert "in force_aft, at " in said


def test_samples_missing_in_all_channels(alone: Path, tmp_path: Path) -> None:
    names = ["shaft_angle", "displacement_aft", "displacement_fore", "force_aft", "force_fore"]
    said = cut_short(alone, tmp_path, np.nan, 4, samples=20, names=names)
    assert said.startswith("5 of its 10 whole periods used: 20 samples are missing in all channels")


def test_a_spike(alone: Path, tmp_path: Path) -> None:
    said = cut_short(alone, tmp_path, 1e4, 4, samples=1, names=["force_fore"])
    assert said == ""  # it is taken out, and no period is lost


def test_no_three_periods_in_a_row(alone: Path, tmp_path: Path) -> None:
    """Those that are whole are used, though they do not follow each other."""
    said = cut_short(alone, tmp_path, np.nan, 2, 5, 8, samples=20, names=["force_aft"])
    assert said.startswith("7 of its 10 whole periods used: 60 samples are missing in ")


def test_a_period_that_settles_is_nothing_to_say(alone: Path, tmp_path: Path) -> None:
    assert cut_short(alone, tmp_path, 1e4, 0, samples=1, names=["force_aft"]) == ""


@pytest.mark.slow
def test_a_run_that_is_cut_short_is_noted(clean: Path, tmp_path: Path) -> None:
    def change(record: xr.Dataset) -> Any:
        return damaged(record, np.nan, 4, samples=1, names=["force_aft"])

    (said,) = notes(changed(clean, tmp_path, ODD, change))
    assert said.startswith(f"run {ODD}: 5 of its 10 whole periods used: one sample is missing")
