"""A run that alone is off, or of which a part was lost, is said by name."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import xarray as xr

from tests.pmm.gap.rigs import FEW, RUNS, changed, made, run, with_friction

ODD = RUNS[1]


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return made(tmp_path_factory.mktemp("clean"))


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
    assert said.startswith(f"run {ODD} alone is off: without it the others show no gap beyond u")
    assert said.endswith(f"a bad run? withhold it with --hold-out {ODD}")
    # What the note asks for is an option as it stands.
    option, name = said.split()[-2:]
    assert notes(campaign, option, name) == []


def test_nothing_is_said_of_runs_as_they_should_be(clean: Path) -> None:
    assert notes(clean) == []


def test_an_effect_in_all_runs_is_no_bad_run(tmp_path: Path) -> None:
    assert not [one for one in notes(with_friction(tmp_path)) if one.startswith("run ")]
