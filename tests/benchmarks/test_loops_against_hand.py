"""Sealed loops counted: four cases, worked out by hand."""

import pytest

from benchmarks.boards.rows import Line
from benchmarks.gap_loop import counted, is_known, needed, of_oracle, over_random, sure, wrong
from benchmarks.outcome import judge
from tests.sealed.loops import WAYS


def line(world: str, snr: float, **ways: list[tuple[float, float, bool]]) -> Line:
    """Return a line; each stand is the true class, what is said of what is named, and if right."""
    stands = {
        way: [dict(zip(("truth", "said", "right"), one, strict=True)) for one in made]
        for way, made in zip(WAYS, ways.values(), strict=True)
    }
    return {"campaign": world, "snr": snr, "ways": stands, "frozen": "abc", "passed": {"sure": 1},
            "cpu_s": 10.0}  # fmt: skip


UNSURE = (0.5, 0.6, True)
QUICK = [UNSURE, (0.97, 0.97, True)]  # ends sure after one run
SLOW = [UNSURE, UNSURE, UNSURE, UNSURE, (0.92, 0.92, True), (0.93, 0.93, True)]
NEVER = [UNSURE] * 6
WRONG = [UNSURE, (0.01, 0.98, False)]
OUT = [UNSURE, UNSURE]  # nothing left is worth a run
LINES = [
    line("A", 12.0, ours=QUICK, random=SLOW, filling=NEVER, oracle=QUICK),
    line("A", 5.0, ours=SLOW, random=NEVER, filling=NEVER, oracle=QUICK),
    line("C", 40.0, ours=WRONG, random=NEVER, filling=QUICK, oracle=QUICK),
    line("C", 20.0, ours=OUT, random=NEVER, filling=NEVER, oracle=NEVER),
]


def test_what_a_loop_ended_with_counts_afterwards() -> None:
    assert [is_known(LINES[0], "ours", k) for k in (0, 1, 5)] == [False, True, True]
    assert [is_known(LINES[0], "random", k) for k in (3, 4)] == [False, True]
    assert [needed(one, "ours") for one in LINES] == [1, 4, 6, 6]
    assert [needed(one, "random") for one in LINES] == [4, 6, 6, 6]


def test_figures_by_hand() -> None:
    assert of_oracle(LINES) == pytest.approx(1 / 3)
    assert over_random(LINES) == pytest.approx(17 / 22)
    assert sure(LINES) == [True, False]
    assert wrong(LINES) == pytest.approx(1 / 2)


@pytest.mark.slow
def test_each_snr_and_world_is_held_to_its_thresholds() -> None:
    found = counted(LINES)
    assert found.measured["needed_over_random_from_10"] == pytest.approx(13 / 16)
    assert found.measured["cases_a"] == 2
    verdicts = {one.key: one.word for one in judge("gap_loop", found.measured)}
    assert set(found.measured) == set(verdicts)
    assert verdicts["sure_and_wrong_from_10"] == "MISSED"
    (ours,) = [
        row for row in found.tables["Known after so many runs"]
        if row["way"] == "ours" and row["cases"] == "SNR from 3, world A"
    ]  # fmt: skip
    assert str(ours["after 1"]).startswith("0.500")
    assert str(ours["runs needed"]).startswith("2.50")
    assert ours["ended sure, of them wrong"] == "1, 0"


def test_nothing_measured_is_nothing_missed() -> None:
    found = counted([])
    assert found.measured == {"cases_a": 0.0, "cases_c": 0.0}
    assert found.tables == {}
