"""Withheld runs that another rig made: what a name does not foretell is not what it names."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from tests.pmm.gap.rigs import FEW, RUNS, made, run, with_friction

FAST = ("heave-1.10-20", "pitch-1.10-20")
NAMES = tuple(dict.fromkeys((*RUNS, *FAST)))


@pytest.fixture(scope="module")
def rubbing(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return with_friction(tmp_path_factory.mktemp("rubbing"), NAMES)


def said(campaign: Path, *options: str) -> dict[str, Any]:
    done = run("gap", campaign, *FEW, "--json", *options)
    assert done.exit_code == 0, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    return document


@pytest.mark.slow
def test_what_the_same_rig_made_is_foretold(rubbing: Path) -> None:
    found = said(rubbing, "--hold-out", "frequency=1.1")
    assert found["verdict"] == "effect"
    assert found["notes"] == []


@pytest.mark.slow
def test_a_single_run_that_is_not_foretold_may_itself_be_off(rubbing: Path, tmp_path: Path) -> None:
    smooth = made(tmp_path, names=NAMES)
    mixed = shutil.copytree(rubbing, tmp_path / "mixed")
    shutil.copy(smooth / f"{FAST[0]}.nc", mixed)
    found = said(mixed, "--hold-out", FAST[0])
    assert found["verdict"] == "effect"
    assert f"run {FAST[0]} is not foretold: coulomb-friction leaves" in found["notes"][0]


@pytest.mark.slow
def test_what_a_rig_without_friction_made_is_not(rubbing: Path, tmp_path: Path) -> None:
    """The fitting runs have friction, the withheld ones none."""
    smooth = made(tmp_path, names=NAMES)
    mixed = shutil.copytree(rubbing, tmp_path / "mixed")
    for name in FAST:
        shutil.copy(smooth / f"{name}.nc", mixed)
    found = said(mixed, "--hold-out", "frequency=1.1")
    told = [one for one in found["notes"] if "is not foretold: coulomb-friction leaves" in one]
    assert len(told) == len(FAST)
