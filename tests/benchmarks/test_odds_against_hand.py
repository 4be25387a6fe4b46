"""Oracle: Bayes' rule by hand, and a made-up diagnosis whose odds are known."""

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.inference.constants import ODDS
from benchmarks.boards.rows import jobs_of, measured
from benchmarks.boards.weighings import SPENT, reweighed
from benchmarks.boards.worlds import CASES, known_effects, made
from benchmarks.gap_odds import Said, counted, fitted, loss
from tests.sealed.answering import DIAGNOSIS, Asked, answer_case
from tests.sealed.scoring.answers import read_answer
from tests.sealed.scoring.keys import read_truth
from tests.sealed.scoring.right import by_class

BASE = {"none": 0.1, "single": 0.6, "further": 0.2, "unknown": 0.2, "mistake": 0.1}
LINE: dict[str, Any] = {
    "campaign": "A",
    "seed": 0,
    "verdict": "gap",
    "is_clear": True,
    "answers": {"none": 0.1, "a": 0.4, "b": 0.2, "a+b": 0.1, "unknown": 0.15, "odd-run": 0.05},
    "right": ["b"],
    "alike": {"a": ["a", "b"], "b": ["a", "b"]},
    "count": 10,
    "concealed": 5,
    "odds": BASE,
    "commit": "0",
}


def test_a_prior_that_is_doubled_doubles_an_answer_beside_the_others() -> None:
    before, after = LINE["answers"], reweighed(LINE, BASE | {"unknown": 0.4})
    assert after["unknown"] / after["a"] == pytest.approx(2.0 * before["unknown"] / before["a"])
    assert after["none"] / after["a"] == pytest.approx(before["none"] / before["a"])
    assert math.fsum(after.values()) == pytest.approx(1.0)


def test_effects_that_runs_do_not_show_count_as_none() -> None:
    # half of ten effects are hidden: none is 0.1 + 0.6/2 (1 + 0.2/2) = 0.43, then 0.63
    before, after = LINE["answers"], reweighed(LINE, BASE | {"none": 0.3})
    ratio = after["none"] / after["a"] / (before["none"] / before["a"])
    assert ratio == pytest.approx(0.63 / 0.43)


def test_a_further_effect_has_its_odds_once_more() -> None:
    before, after = LINE["answers"], reweighed(LINE, BASE | {"further": 0.6})
    assert after["a+b"] / after["a"] == pytest.approx(3.0 * before["a+b"] / before["a"])


def test_what_cannot_be_told_apart_is_sure_together() -> None:
    said = Said.of(LINE, BASE)
    assert said.probability == pytest.approx(0.6)
    assert not said.is_right  # by the name that is said
    assert said.loss == pytest.approx(-math.log(0.2))


@given(st.integers(0, 2**31))
def test_odds_that_cases_were_drawn_with_are_found_again(seed: int) -> None:
    """Answers that say nothing beyond their odds: the best odds are how often each is right."""
    rng = np.random.default_rng(seed)
    names = ["none", "a", "unknown", "odd-run"]
    line = {**LINE, "answers": dict.fromkeys(names, 0.25), "concealed": 0, "count": 1, "alike": {}}
    line["odds"] = dict.fromkeys(BASE, 1.0)
    counts = dict(zip(names, rng.integers(5, 60, 4).tolist(), strict=True))
    lines = [{**line, "right": [name]} for name, count in counts.items() for _ in range(count)]
    best = fitted(lines)
    for name, key in (("none", "none"), ("unknown", "unknown"), ("odd-run", "mistake")):
        assert best[key] / best["single"] == pytest.approx(counts[name] / counts["a"], rel=0.15)
    assert loss(lines, best) <= loss(lines, asdict(ODDS)) + 1e-9
    assert counted(lines).measured["cases"] == len(lines)


@pytest.mark.slow
def test_a_case_is_weighed_as_it_is_answered(tmp_path: Path) -> None:
    (job,) = jobs_of("weighings", ["A"], (5, 6))
    line = measured(job)
    name = made("A", 5, SPENT, CASES, tmp_path)
    (tmp_path / "answers").mkdir()
    answer_case(Asked(tmp_path, name, (DIAGNOSIS,), proposes=False))
    truth = read_truth(tmp_path / "keys" / name / "truth.json")
    answer = read_answer(tmp_path / "answers" / f"{name}.json", known_effects(), truth)
    assert line["is_clear"]
    kept = {name: share for name, share in answer.probabilities.items() if share > 1e-6}
    assert line["answers"] == pytest.approx(kept, rel=1e-4)
    assert set(line["right"]) == by_class(truth) & set(kept)
    assert reweighed(line, line["odds"]) == pytest.approx(kept, rel=1e-3)
