"""Where a simulated rig is another one than ``rig.toml`` says, against files that say so."""

from pathlib import Path

import pytest

from hardware.description.flags import Severity
from pmm.plan.checks import check_plan
from pmm.plan.findings import PlanVerdict
from pmm.plan.plan import read_plan_and_rig
from pmm.plan.rig_file import read_rig_file
from pmm.plan.simulated_rig import (
    Departure,
    departure_flag,
    departures,
    provenance_of_departures,
)
from tests.pmm.plan.plans import EXAMPLES, HEAVE, RIG_TEXT, write_plan


def found(folder: Path, own: str = "", rig: str = RIG_TEXT) -> tuple[Departure, ...]:
    (folder / "rig.toml").write_text(rig, encoding="utf-8")
    (folder / "simulated.toml").write_text(f'rig = "rig.toml"\n{own}', encoding="utf-8")
    return departures(read_rig_file(folder / "rig.toml"))


@pytest.mark.parametrize("name", ["vertical", "manual", "horizontal"])
def test_the_examples_simulate_what_they_state(name: str) -> None:
    assert departures(read_rig_file(EXAMPLES / name / "rig.toml")) == ()


def test_a_rig_on_another_bus_is_not_simulated(tmp_path: Path) -> None:
    text = RIG_TEXT.replace('"pmm-simulated"', '"virtual"')
    (tmp_path / "rig.toml").write_text(text, encoding="utf-8")
    assert departures(read_rig_file(tmp_path / "rig.toml")) == ()


def test_a_changed_rig_file_changes_the_simulated_rig_and_differs_in_nothing(
    tmp_path: Path,
) -> None:
    text = RIG_TEXT.replace("mass_kg = 70.0", "mass_kg = 35.0")
    text = text.replace("[oscillator]", "[oscillator]\nhalf_spacing_m = 0.175\nrod_length_m = 0.9")
    assert found(tmp_path, rig=text) == ()


@pytest.mark.parametrize(
    ("own", "key", "stated", "simulated"),
    [
        ("[model]\nmass_kg = 35.0\n", "model.mass_kg", 70.0, 35.0),
        ("[oscillator]\nhalf_spacing_m = 0.6\n", "oscillator.half_spacing_m", 0.5, 0.6),
        ("[oscillator]\nrod_length_m = 0.9\n", "oscillator.rod_length_m", None, 0.9),
        ("[drive]\nspeed_error = 0.01\n", "drive.speed_error", None, 0.01),
        (
            "[dynamometers.fore]\nfull_scale_n = 300.0\n",
            "dynamometers.fore.full_scale_n",
            500.0,
            300.0,
        ),
    ],
)
def test_what_the_simulated_rig_states_itself_is_said(
    tmp_path: Path, own: str, key: str, stated: float | None, simulated: float
) -> None:
    (one,) = found(tmp_path, own)
    assert (one.key, one.stated, one.simulated) == (key, stated, simulated)
    assert f"{key} = {simulated:g} is simulated" in one.message
    if stated is not None:
        assert f"rig.toml states {stated:g}" in one.message


def test_the_same_value_is_no_difference(tmp_path: Path) -> None:
    assert found(tmp_path, "[model]\nmass_kg = 70.0\n") == ()


def test_another_rig_s_simulation_is_found_out(tmp_path: Path) -> None:
    """A rig's file whose bus is the simulation of another one's."""
    found(tmp_path)
    other = RIG_TEXT.replace("inertia_kg_m2 = 27.5", "inertia_kg_m2 = 30.0")
    (tmp_path / "other.toml").write_text(other, encoding="utf-8")
    (one,) = departures(read_rig_file(tmp_path / "other.toml"))
    assert (one.key, one.stated, one.simulated) == ("model.inertia_kg_m2", 30.0, 27.5)


def test_what_nobody_states_is_nominal_and_said(tmp_path: Path) -> None:
    text = RIG_TEXT[: RIG_TEXT.index("[hull]")] + RIG_TEXT[RIG_TEXT.index("[tank]") :]
    (one,) = found(tmp_path, rig=text)
    assert one.key == "hull"
    assert "has no [hull]" in one.message


def test_a_check_of_a_plan_warns_and_a_recording_keeps_it(tmp_path: Path) -> None:
    path = write_plan(tmp_path, HEAVE)
    differs = found(tmp_path, "[model]\nmass_kg = 35.0\n[carriage]\nspeed_error = 0.01\n")
    plan, rig = read_plan_and_rig(path)
    said = {one.verdict: one for one in check_plan(plan, rig) if one.quantity == "simulated rig"}
    assert set(said) == {PlanVerdict.WARN, PlanVerdict.NOTE}
    assert (said[PlanVerdict.WARN].value, said[PlanVerdict.WARN].limit) == (35.0, 70.0)
    (flag,) = departure_flag(differs)
    assert (flag.code, flag.severity) == ("simulated_differs", Severity.WARNING)
    assert "model.mass_kg" in provenance_of_departures(differs)["simulated_differs"]


def test_a_simulated_rig_that_cannot_be_made_refuses_the_plan(tmp_path: Path) -> None:
    path = write_plan(tmp_path, HEAVE)
    (tmp_path / "simulated.toml").write_text('rig = "rig.toml"\nsead = 3\n', encoding="utf-8")
    plan, rig = read_plan_and_rig(path)
    (said,) = (one for one in check_plan(plan, rig) if one.verdict is PlanVerdict.REFUSE)
    assert "sead is not a known key; did you mean seed?" in said.message
