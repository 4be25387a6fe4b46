"""Figures of a world against the page's board by hand; calibration against drawn answers."""

from pathlib import Path

import numpy as np
import pytest

from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.by_world import Held, _excess, by_world, calibration_error


@pytest.mark.slow
def test_figures_of_the_page_s_board(board: Path) -> None:
    found = {one.key: one for one in by_world(read_board(board), "A")}
    expected = {  # from SNR 10 on: cases 7 to 12, and those without a gap
        "false_alarms": (1.0 / 3.0, 3),  # case 2
        "class": (0.75, 4),  # 7, 8, 11, not 12
        "stage": (4.0 / 6.0, 6),  # not 9 and 12
        "shrinkage_covered": (0.8, 5),  # 7, 9, 10, 11, not 8
        "sure_and_wrong": (2.0 / 6.0, 6),  # of 1, 3, 7, 10, 11 (0.5 + 0.4), 12: 10 and 12
    }
    for key, (value, count) in expected.items():
        assert found[key].value == pytest.approx(value), key
        assert found[key].count == count, key
        assert found[key].low <= found[key].value <= found[key].high  # type: ignore[operator]
    assert found["class_below_oracle"].word == ""  # there is no oracle
    assert found["invariance_class"].value is None


def test_words_follow_the_interval() -> None:
    def word(low: float, high: float, *, strict: bool = False) -> str:
        return Held("k", "w", 0.5 * (low + high), low, high, 9, 0.1, None, strict).word

    assert word(0.0, 0.09) == "met"
    assert word(0.05, 0.2) == "close"
    assert word(0.11, 0.2) == "missed"
    assert word(0.05, 0.2, strict=True) == "missed"
    both = Held("k", "w", 0.94, 0.91, 0.97, 9, 0.98, 0.90)
    assert both.word == "met"
    assert Held("k", "w", 0.80, 0.7, 0.89, 9, 0.98, 0.90).word == "missed"
    assert Held("k", "w", None, None, None, 0, 0.1, None).word == ""
    assert Held("k", "w", 0.5, 0.4, 0.6, 9, None, None).word == ""


def test_calibration_error_by_hand() -> None:
    said = np.array([0.95, 0.95, 0.55, 0.52])
    right = np.array([1.0, 0.0, 1.0, 0.0])
    # |1.9 - 1| and |1.07 - 1| over four
    assert calibration_error(said, right) == pytest.approx((0.9 + 0.07) / 4.0)


@pytest.mark.slow
def test_excess_is_nothing_for_answers_as_right_as_they_say() -> None:
    rng = np.random.default_rng(6)
    said = rng.uniform(0.3, 1.0, 300)
    fair = [_excess(np.column_stack([said, rng.random(300) < said])) for _ in range(40)]
    assert np.mean(fair) == pytest.approx(0.0, abs=0.008)
    bold = np.column_stack([said, rng.random(300) < said - 0.2])
    assert _excess(bold) > 0.1
