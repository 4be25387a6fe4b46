"""Oracle: both calibrations of answers beside keys, marks by hand, and a board's own answers."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.boards.learned import ROWS, answered, calibrations, figures_by_row
from benchmarks.boards.rows import jobs_of
from benchmarks.boards.seen import seen
from benchmarks.boards.worlds import marked
from benchmarks.gap_worlds import counted
from tests.sealed.learning.calibration import Conformal, Isotonic
from tests.sealed.learning.campaigns import LOOKS
from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.columns import COLUMNS
from tests.sealed.scoring.keys import Truth

_COMMIT = "2b"  # a development seed


def test_kept_lines_calibrate_as_answers_beside_keys_do() -> None:
    rng = np.random.default_rng(3)
    lines, shares, pairs = [], [], []
    for number in range(60):
        said = dict(zip(("none", "hum", "cable"), rng.dirichlet((2.0, 1.0, 1.0)), strict=True))
        verdict, right = ("none", "none") if number % 2 else ("gap", "hum")
        named = ((right,),) if verdict == "gap" else ()
        truth = Truth("case", verdict, False, verdict, 20.0, named, (), {}, {})  # type: ignore[arg-type]
        pairs.append((Answer("sealed-answer-1", "case", said, {}), truth))
        lines.append({"verdict": verdict, "right": [right]})
        shares.append(said)
    isotonic, conformal = calibrations(lines, shares)
    assert isotonic.said == pytest.approx(Isotonic.of(pairs).said)
    assert isotonic.right == pytest.approx(Isotonic.of(pairs).right)
    wanted = Conformal.of(pairs).strange
    assert conformal.strange.keys() == wanted.keys() == {"any", "none", "effect"}
    assert all(conformal.strange[name] == pytest.approx(wanted[name]) for name in wanted)


def _line(right: float, *, boosted: float) -> dict[str, Any]:
    def mark(value: float) -> dict[str, Any]:
        values: dict[str, list[float]] = {one.key: [] for one in COLUMNS}
        values |= {"top_1_by_class": [value], "stage": [1.0]}
        return {"is_clear": True, "values": values, "stated": [0.95, value], "unknown": 0.0}

    rows = {name: mark(boosted if name.startswith("boosted") else right) for name in ROWS}
    line = {"campaign": "A", "seed": 0, "rows": rows, "verdict": "gap"}
    return {**line, "counts": True, "trained_on": 7}


def test_figures_of_each_row_are_those_by_hand() -> None:
    lines = [_line(1.0, boosted=0.0), _line(1.0, boosted=1.0), _line(0.0, boosted=0.0)]
    found = {name: (figures, mean) for name, figures, mean in figures_by_row(lines)}
    figures, mean = found["diagnosis"]
    assert figures["class"][0] == pytest.approx(2 / 3)
    assert figures["sure_and_wrong"][0] == pytest.approx(1 / 3)
    assert found["boosted-components"][0]["class"][0] == pytest.approx(1 / 3)
    assert mean == pytest.approx((2 / 3 + 1.0) / 2.0)


def test_the_note_counts_whose_marks_are_those_of_the_worlds() -> None:
    learned = [_line(1.0, boosted=0.0) | {"seed": seed} for seed in range(3)]
    own = learned[0]["rows"]["diagnosis"]
    stated = own["stated"][0]
    other = own | {"values": own["values"] | {"unknown": [0.25]}}
    near = own | {"stated": [stated - 0.125, own["stated"][1]]}
    worlds = [
        {"campaign": "A", "seed": seed, "frozen": "2b", **mark}
        for seed, mark in enumerate((own, near, other))
    ]
    found = counted(worlds, (), learned)
    assert "trained on 7 campaigns" in found.notes[-1]
    assert "in 2 of 3 cases, its probabilities within 0.1." in found.notes[-1]
    assert [row["row"] for row in found.tables["Rows that learn"]] == list(ROWS)


def test_the_first_hundred_cases_of_each_world_are_asked() -> None:
    assert len(jobs_of("seen", [], None)) == len(jobs_of("learned", [], None)) == 400


@pytest.mark.slow
def test_a_case_has_the_marks_of_its_world_and_those_of_every_row(tmp_path: Path) -> None:
    pytest.importorskip("sklearn", reason="optional dependency peers")
    rng = np.random.default_rng(8)
    for index in range(24):
        name, stage = ("zero-offset", ["dynamometers"]) if index % 2 else ("none", [])
        off = {"cell": ["force_aft|mean|0"], "run": [0], "settings": [[0.0, -3.0, 1.0, 1.0, 1.0]]}
        off["off"] = [20.0 * (index % 2) + float(rng.standard_normal())]
        numbers = {"components": off, "hypotheses": {"zero-offset|share": float(index % 2)}}
        kept = {"index": index, "right": [name], "stages": stage, "numbers": numbers}
        (tmp_path / f"{index:05d}.json").write_text(json.dumps(kept))
    assert set(numbers) == set(LOOKS)
    line = answered(json.loads(json.dumps(seen("A", 2, _COMMIT, 3))), tmp_path)
    assert line["rows"].keys() == set(ROWS)
    assert line["trained_on"] == 24
    worlds = json.loads(json.dumps(marked("A", 2, _COMMIT, 3)))
    assert "in 1 of 1 cases" in counted([worlds], (), [json.loads(json.dumps(line))]).notes[-1]
