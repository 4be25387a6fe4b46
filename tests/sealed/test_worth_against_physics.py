"""What a further run is worth, both runs carried out: what physics says that only it can tell."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.sealed.carrying_out import carrier
from tests.sealed.generator import worth
from tests.sealed.generator.case import Case, make
from tests.sealed.generator.catalogue import BY_NAME
from tests.sealed.generator.files import case_text
from tests.sealed.generator.kinds import Content
from tests.sealed.generator.sizing import Sized

SEED, INDEX = 11, 10  # a campaign of which no run is in air


@pytest.fixture(scope="module")
def heavier() -> Case:
    """Return a campaign in water alone, whose model is 3 % heavier than believed."""
    case = make(SEED, INDEX, null=True)
    assert {run.medium for run in case.campaign.runs} == {"water"}
    there = Sized(BY_NAME["mass-error"], 0.03, {}, 0.0)
    content = Content("single", "gap", (there,), (("mass-error",),), (there.effect.stage,))
    runs = case.situation.runs[:3]  # fewer than it has: the same physics in a third of the time
    return replace(case, content=content, situation=replace(case.situation, runs=runs))


def test_only_a_run_in_air_tells_the_model_s_mass_from_the_water_s(
    heavier: Case, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folder = tmp_path / "cases" / heavier.name
    folder.mkdir(parents=True)
    (folder / "case.toml").write_text(case_text(heavier))
    monkeypatch.setattr(worth, "case_of", lambda key: heavier)
    wet = heavier.campaign.runs[0]
    again = {"kind": "oscillation", "frequency_hz": wet.frequency_hz, "medium": "water",
             "eccentricity_m": wet.eccentricity_m, "strut_phase_rad": wet.strut_phase_rad,
             "carriage_speed_m_s": wet.carriage_speed_m_s}  # fmt: skip
    dry = {**again, "medium": "air", "carriage_speed_m_s": 0.0}
    carry_out = carrier(tmp_path, 1)
    in_air, drawn = carry_out([(heavier.name, dry)])[heavier.name]
    in_water, same = carry_out([(heavier.name, again)])[heavier.name]
    at_rest, _ = carry_out([(heavier.name, {"kind": "rest"})])[heavier.name]
    nothing, _ = carry_out([(heavier.name, None)])[heavier.name]
    assert in_air > in_water + 1.0
    assert at_rest == pytest.approx(0.0, abs=0.5)
    assert nothing == 0.0
    assert drawn == same
    assert np.isfinite(drawn)


def test_what_was_carried_out_is_kept(
    heavier: Case, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    folder = tmp_path / "cases" / heavier.name
    folder.mkdir(parents=True)
    (folder / "case.toml").write_text(case_text(heavier))
    asked = []

    def values(key: Path, runs: list[object]) -> list[float]:
        asked.append(key)
        return [1.0] * len(runs)

    monkeypatch.setattr(worth, "values", values)
    carry_out = carrier(tmp_path, 1)
    wanted = [(heavier.name, {"kind": "rest"})]
    assert carry_out(wanted) == carry_out(wanted) == {heavier.name: (1.0, 1.0)}
    assert len(asked) == 1
