"""Isotonic and conformal calibration: worked by hand, and simulated where they promise a share."""

import numpy as np
import pytest

from tests.sealed.learning.calibration import Conformal, Isotonic, covered
from tests.sealed.scoring.answers import Answer
from tests.sealed.scoring.keys import Truth


def _truth(verdict: str, name: str = "") -> Truth:
    right = ((name,),) if name else ()
    return Truth("case", verdict, verdict == "none", verdict, 20.0, right, (), {}, {})  # type: ignore[arg-type]


def _answer(**shares: float) -> Answer:
    return Answer("sealed-answer-1", "case", shares, {})


def test_pooled_violators() -> None:
    """0.1, 0.3, 0.5, 0.7, 0.9 were right 0, 1, 0, 1, 1 times: 0.3 and 0.5 pool to a half."""
    fit = Isotonic.fitted([0.5, 0.1, 0.9, 0.3, 0.7], [0, 0, 1, 1, 1])
    assert fit.said == pytest.approx([0.1, 0.3, 0.5, 0.7, 0.9])
    assert fit.right == pytest.approx([0.0, 0.5, 0.5, 1.0, 1.0])


def test_a_block_pools_further_back_when_its_mean_falls_below() -> None:
    """1, 2, 0 with weights 1, 1, 2: the last two pool to 2/3, and these with the first to 3/4."""
    fit = Isotonic.fitted([0.1, 0.2, 0.3, 0.3], [1, 2, 0, 0])
    assert fit.right == pytest.approx([0.75] * 3)


def test_calibrated_shares_sum_to_one_and_keep_their_order() -> None:
    """0.7 becomes 1 and 0.3 a half, so 2/3 and 1/3."""
    fit = Isotonic.fitted([0.1, 0.3, 0.5, 0.7, 0.9], [0, 1, 0, 1, 1])
    found = fit.shares({"cable": 0.3, "none": 0.7})
    assert found == pytest.approx({"cable": 1 / 3, "none": 2 / 3}, abs=1e-8)
    tied = fit.shares({"cable": 0.4, "hum": 0.45})
    assert tied["hum"] > tied["cable"]


def test_credibility_counts_what_is_as_strange() -> None:
    """Of strangeness 0.1, 0.4, 0.6, two are no less strange than 0.4: (1 + 2) / 4; of 0.6, one."""
    said = ((0.9, 0.1), (0.6, 0.4), (0.4, 0.6))
    fit = Conformal.of([(_answer(none=p, hum=q), _truth("none")) for p, q in said])
    assert fit.credibility("none", 0.6) == pytest.approx(0.75)
    assert fit.credibility("none", 0.95) == 1.0
    assert fit.within({"none": 0.6, "hum": 0.4}, 0.45) == ["none", "hum"]
    assert fit.within({"none": 0.6, "hum": 0.39}, 0.45) == ["none"]


def _drawn(rng: np.random.Generator, count: int) -> list[tuple[Answer, Truth]]:
    """Return answers of one who is too sure: shares are the fourth power of what is right."""
    found = []
    for _ in range(count):
        true = float(rng.uniform(0.05, 0.95))
        said = true**4 / (true**4 + (1.0 - true) ** 4)
        truth = _truth("none") if rng.random() < true else _truth("gap", "hum")
        found.append((_answer(none=said, hum=1.0 - said), truth))
    return found


@pytest.mark.slow
def test_sets_hold_what_is_right_as_often_as_promised() -> None:
    """Exchangeable cases, 200 boards of 60: 0.9 within what 200 x 60 draws scatter, each class too.

    The mean over boards of split-conformal coverage lies in [1 - miss, 1 - miss + 1 / (n + 1)]
    for scores without ties.
    """
    rng = np.random.default_rng(2026)
    hits: dict[str, list[bool]] = {"none": [], "gap": []}
    for _ in range(200):
        fit = Conformal.of(_drawn(rng, 100))
        tried = _drawn(rng, 60)
        for (holds, _), (_, truth) in zip(covered(fit, tried, 0.1), tried, strict=True):
            hits[truth.verdict].append(holds)
    for found in hits.values():
        assert 0.885 < np.mean(found) < 0.935


def test_a_class_with_few_cases_has_no_scores_of_its_own() -> None:
    """Nineteen are too few, twenty are enough."""
    few = [(_answer(none=0.8, hum=0.2), _truth("none"))] * 19
    many = [(_answer(none=0.8, hum=0.2), _truth("gap", "hum"))] * 20
    assert set(Conformal.of([*few, *many]).strange) == {"any", "effect"}
