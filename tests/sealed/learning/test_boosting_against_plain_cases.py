"""Gradient boosting where the right answer is plain, and importance where one cell tells it."""

from dataclasses import replace

import numpy as np
import pytest

from sim.effects.catalogue import catalogue
from tests.sealed.learning.boosted import Classifier, importance
from tests.sealed.learning.features import of_components
from tests.sealed.learning.training import Example
from tests.sealed.learning.validation import by_effect, scored

pytest.importorskip("sklearn", reason="optional dependency peers")

SETTINGS = [[-0.3, -3.0, 1.0, 1.0, 1.0], [0.3, -3.5, 1.0, 0.5, 1.0]]
CELLS = ("force_aft|mean|0", "force_fore|mean|0")


def _example(rng: np.random.Generator, index: int) -> Example:
    """Return two runs: a zero offset is 20 sigma in the aft mean, all else is noise."""
    off = rng.standard_normal(4)
    off[::2] += 20.0 * (index % 2)
    numbers = {"cell": CELLS * 2, "run": [0, 0, 1, 1], "off": off.tolist(), "settings": SETTINGS}
    name, stage = ("zero-offset", "dynamometers") if index % 2 else ("none", "")
    return Example(
        index, (name,), (stage,) if stage else (), {"components": of_components(numbers)}
    )


@pytest.mark.slow
def test_what_is_plain_is_named_with_its_stage() -> None:
    """An offset of 20 sigma cannot be missed, and nothing is called nothing."""
    rng = np.random.default_rng(5)
    model = Classifier.fitted([_example(rng, at) for at in range(60)], "components")
    for index in (100, 101):
        asked = _example(rng, index)
        shares, stages = model.shares(asked.features["components"])
        assert shares[asked.right[0]] > 0.9
        assert stages[(asked.stages or ("none",))[0]] > 0.9


@pytest.mark.slow
def test_a_rare_answer_is_not_sure_of_itself() -> None:
    """Of 3 campaigns of noise in 60 that have an answer of their own, nothing foretells one."""
    rng = np.random.default_rng(7)
    found = [_example(rng, 2 * at) for at in range(60)]
    rare = [
        replace(one, right=("backlash",), stages=("drive",)) if at < 3 else one
        for at, one in enumerate(found)
    ]
    model = Classifier.fitted(rare, "components")
    shares = [
        model.shares(_example(rng, 200 + 2 * at).features["components"])[0] for at in range(9)
    ]
    assert max(one["backlash"] for one in shares) < 0.2


def test_a_campaign_that_is_told_counts_as_such() -> None:
    """By hand: of two campaigns one is told at 0.5, the other is given 0.25 for its answer."""
    rng = np.random.default_rng(8)
    found = [_example(rng, 0), _example(rng, 1)]
    said = [{"none": 0.5, "zero-offset": 0.3}, {"none": 0.75, "zero-offset": 0.25}]
    loss = (np.log(2.0) + np.log(4.0)) / 2.0
    assert scored(found, said) == f"right in 0.500 of 2, mean log loss {loss:.3f}"


def test_a_pair_that_is_named_counts_for_both_of_its_effects() -> None:
    """By hand: what a row that cannot say pairs would have to say to mean the same."""
    names = catalogue().keys() - {"added-mass-error", "damping-error"}
    seen = dict.fromkeys(names, 0.0) | {"none": 0.2, "hum": 0.1, "cable+hum": 0.7}
    assert by_effect(seen) == pytest.approx({"none": 0.2, "hum": 0.45, "cable": 0.35})


def test_an_effect_that_does_not_show_has_its_part_of_none() -> None:
    """By hand: of prior odds 0.6 for none, and 0.6 for effects half of which do not show.

    Those are singles, and pairs of them by half: 0.6 times 0.5 times (1 + 0.5 times 0.5) = 0.375.
    """
    names = sorted(catalogue().keys() - {"added-mass-error", "damping-error"})
    assert len(names) % 2 == 0
    shown = dict.fromkeys(names[::2], 0.0) | {"none": 0.975, "unknown": 0.025}
    found = by_effect(shown)
    assert found["none"] == pytest.approx(0.6)
    assert [found[name] for name in names[1::2]] == pytest.approx(
        [0.75 / len(names)] * (len(names) // 2)
    )


def test_only_the_cell_that_tells_is_important() -> None:
    """Shuffled, half of two equally frequent answers are left; the other column tells nothing."""
    from sklearn.tree import DecisionTreeClassifier

    rng = np.random.default_rng(6)
    right = [("a",), ("b",)] * 200
    matrix = np.column_stack([np.array([0.0, 1.0] * 200), rng.standard_normal(400)])
    model = DecisionTreeClassifier(max_depth=1, random_state=0).fit(matrix, ["a", "b"] * 200)
    falls = importance(model, matrix, right, {"telling": [0], "other": [1]}, rng)
    assert falls["telling"].mean() == pytest.approx(0.5, abs=0.08)
    assert not falls["other"].any()
