"""What the oracle is told, and how records of world E are thinned, cut and counted, by hand."""

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from tests.sealed.__main__ import main
from tests.sealed.oracle import TABLE, answered_as, stating, told
from tests.sealed.recorded import EXPECTED, counted, recorded
from tests.sealed.variations import Variation


def test_true_tolerances_take_the_place_of_stated_ones() -> None:
    text = f'schema = "x"\n\n[{TABLE}]\nzero_n = 0.02\ngain_relative = 0.001\n\n[rig]\n'
    found = stating(text, {"zero_n": 0.5, "of_no_case": 1.0})
    assert found.count("zero_n") == 1
    assert f"[{TABLE}]\nzero_n = 0.5\ngain_relative = 0.001\n" in found
    assert "of_no_case" not in found


def test_oracle_answers_are_a_row_of_the_board(tmp_path: Path) -> None:
    case, key = tmp_path / "cases" / "case-0001", tmp_path / "keys" / "case-0001"
    case.mkdir(parents=True)
    key.mkdir(parents=True)
    (case / "case.toml").write_text(f"[{TABLE}]\nzero_n = 0.02\n")
    (key / "truth.json").write_text(json.dumps({"tolerances": {"zero_n": 0.3}}))
    output = told(tmp_path)
    assert "zero_n = 0.3" in (output / "cases" / "case-0001" / "case.toml").read_text()
    assert "0.02" in (case / "case.toml").read_text()
    (output / "answers").mkdir()
    (output / "answers" / "case-0001.json").write_text("{}")
    assert answered_as(tmp_path, output) == 1
    assert (tmp_path / "answers-oracle" / "case-0001.json").exists()


@pytest.mark.slow
def test_foreign_recordings_keep_their_force_when_thinned(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from analysis.readers import read_recording
    from tests.sealed import recorded as module

    sources = tuple(one for one in module.SOURCES if one.name == "foreign")
    monkeypatch.setattr(module, "SOURCES", sources)
    monkeypatch.setattr(
        module,
        "VARIATIONS",
        (Variation("whole"), Variation("cut", part=0.5), Variation("thin-2", Fraction(1, 2)),
         Variation("thin-10", Fraction(1, 10))),
    )  # fmt: skip
    made = list(recorded(tmp_path, tmp_path / "nothing"))
    assert made == ["foreign.whole", "foreign.cut", "foreign.thin-2"]
    whole, cut, thin = (
        read_recording(tmp_path / "cases" / name / "heave-0.60.nc") for name in made
    )
    assert thin.sample_rate_hz == pytest.approx(whole.sample_rate_hz / 2.0)
    assert cut.sample_count == pytest.approx(whole.sample_count / 2, abs=1)
    inner = slice(50, -50)
    assert thin.values("force_aft")[inner] == pytest.approx(
        whole.values("force_aft")[::2][inner], abs=0.5
    )
    assert np.ptp(whole.values("force_aft")) > 20.0


def test_sources_count_what_is_right(tmp_path: Path) -> None:
    rows = {f"a.{name}": {"source": "a", "right": ["none"]} for name in ("whole", "cut")}
    (tmp_path / EXPECTED).write_text(json.dumps(rows))
    (tmp_path / "answers").mkdir()
    for name, shares in (("a.whole", {"none": 0.9, "hum": 0.1}), ("a.cut", {"hum": 1.0})):
        answer = json.dumps({"probabilities": shares})
        (tmp_path / "answers" / f"{name}.json").write_text(answer)
    (one,) = counted(tmp_path)
    assert (one.source, one.right, one.count, one.wrong) == ("a", 1, 2, {"a.cut": "hum"})


@pytest.mark.parametrize("there", [False, True])
def test_sources_that_nobody_answered_are_refused(tmp_path: Path, there: bool) -> None:
    (tmp_path / "answers").mkdir()
    if there:
        rows = {"a.whole": {"source": "a", "right": ["none"]}}
        (tmp_path / EXPECTED).write_text(json.dumps(rows))
    told = CliRunner().invoke(main, ["sources", str(tmp_path)])
    assert told.exit_code == 2
    assert ("a.whole" if there else EXPECTED) in told.output
    assert "'answer " in told.output
