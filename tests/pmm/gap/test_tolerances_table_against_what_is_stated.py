"""``pmm gap --tolerances`` against what is stated, what was put in, and the page."""

import json
import re
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest

from analysis.gap.forward.always_on import always_on
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.components import Stack
from pmm.gap.load import load_campaign
from pmm.gap.tolerance_document import NUMBERS
from tests.pmm.gap.rigs import made, run

PAGE = Path(__file__).parents[3] / "docs" / "gap-tolerances.md"
ZERO_N = 0.2


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = made(
        tmp_path_factory.mktemp("tolerances"),
        *("--effect", f"zero-offset:aft_n={ZERO_N},fore_n=0"),
    )
    (folder / "case.toml").write_text("[tolerances]\nzero_n = 0.1\n")
    return folder


@pytest.fixture(scope="module")
def table(rig: Path) -> dict[str, dict[str, Any]]:
    done = run("gap", rig, "--tolerances", "--json")
    assert done.exit_code == 0, done.output
    return {one["key"]: one for one in json.loads(done.stdout)["tolerances"]}


def test_each_tolerance_is_there_once_with_its_source(table: dict[str, dict[str, Any]]) -> None:
    assert list(table) == [one.name for one in fields(Tolerances)]
    assert table["zero_n"]["value"] == 0.1
    assert table["zero_n"]["source"] == "stated in case.toml"
    others = [one for key, one in table.items() if key != "zero_n"]
    assert all(one["source"].startswith("default: ") for one in others)
    assert all(one["value"] == getattr(Tolerances(), one["key"]) for one in others)


def test_a_zero_that_was_put_in_moves_by_its_tolerances(table: dict[str, dict[str, Any]]) -> None:
    moved = table["zero_n"]["moved"]
    for name, put_in in (("zero aft", ZERO_N / 0.1), ("zero fore", 0.0)):
        assert abs(moved[name]["tolerances"] - put_in) < 4.0 * moved[name]["u"]


def test_what_these_runs_do_not_show_does_not_move(table: dict[str, dict[str, Any]]) -> None:
    """All runs are as fast as each other: nothing tells a change with speed."""
    assert table["added_mass_per_speed"]["moved"] == {}
    assert all(0.0 < own["u"] < 0.9 for one in table.values() for own in one["moved"].values())


@pytest.mark.slow
def test_people_read_the_same(rig: Path) -> None:
    said = run("gap", rig, "--tolerances").output
    assert f"1 of {len(fields(Tolerances))} tolerances are stated" in said
    assert "stated in" in said


@pytest.mark.slow
def test_every_number_that_has_a_name_belongs_to_a_tolerance(rig: Path) -> None:
    loaded = load_campaign(rig)
    simulator = Simulator(loaded.rig, Stack.of(pooled(loaded.runs, loaded.rig, Tolerances())))
    names = [one.name for one in free_numbers(loaded.rig, Tolerances())]
    names += dict(always_on(simulator, simulator.steady(()), Tolerances()))
    known = [name for own in NUMBERS.values() for name in own]
    assert len({*known}) == len(known)
    assert {*names} <= {*known}
    assert NUMBERS.keys() <= {one.name for one in fields(Tolerances)}


def test_the_page_has_each_default_with_its_source() -> None:
    rows = re.findall(r"^\| `(\w+)` \| (.*) \| (.*) \| (.*) \| (.*) \|$", PAGE.read_text(), re.M)
    told = [
        (key, meaning, float(value), unit, source) for key, meaning, value, unit, source in rows
    ]
    usual = Tolerances()
    assert told == [
        (one.name, one.metadata["meaning"], getattr(usual, one.name), one.metadata["unit"],
         one.metadata["source"])
        for one in fields(usual)
    ]  # fmt: skip
