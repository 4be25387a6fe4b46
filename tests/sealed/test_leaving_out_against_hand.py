"""Which effects are left out where: each in turn, drawn by the seed, in cases with one effect."""

import json
from collections import Counter
from pathlib import Path

import pytest

from tests.sealed.answering import still_asked
from tests.sealed.leaving_out import left_out
from tests.sealed.scoring import handmade

DRAWN = {"cable": 9, "memory": 4, "hum": 1}


def _keys(board: Path, seed: int) -> Path:
    """Write keys of cases with one effect each, in which some are drawn more often than others."""
    names = [name for name, count in DRAWN.items() for _ in range(count)]
    for number, name in enumerate(names, start=1):
        case = f"case-{number:04d}"
        (board / "keys" / case).mkdir(parents=True)
        truth = {"case": case, "seed": str(seed), "kind": "single", "verdict": "gap",
                 "determinable": True, "effects": [{"name": name}], "right": [[name]]}  # fmt: skip
        (board / "keys" / case / "truth.json").write_text(json.dumps(truth))
    return board


def test_right_effects_of_cases_with_one_that_can_be_seen(tmp_path: Path) -> None:
    board = handmade.write(tmp_path / "board")
    for key in (board / "keys").iterdir():
        table = json.loads((key / "truth.json").read_text())
        table["determinable"] = table["snr"] >= 3.0
        (key / "truth.json").write_text(json.dumps(table))
    everything = left_out(board)
    # Not 5, which is hidden, nor the pair 8, nor the twins 11.
    assert everything == {
        "case-0006": ["gain-error"],
        "case-0007": ["coulomb-friction"],
        "case-0012": ["quadratic-damping"],
    }
    asked = still_asked(board, ("leave-one-out",), everything)
    assert {one.case: list(one.left_out) for one in asked} == everything
    assert asked[0].target("leave-one-out") == board / "answers-leave-one-out" / "case-0006.json"


@pytest.mark.parametrize(
    ("most", "counts"),
    [
        (3, {"cable": 1, "memory": 1, "hum": 1}),
        (5, {"cable": 2, "memory": 2, "hum": 1}),
        (10, {"cable": 5, "memory": 4, "hum": 1}),
        (None, DRAWN),
    ],
)
def test_each_effect_comes_once_before_any_comes_twice(
    tmp_path: Path, most: int | None, counts: dict[str, int]
) -> None:
    found = left_out(_keys(tmp_path, 7), most)
    assert Counter(name for (name,) in found.values()) == counts


def test_the_seed_draws_and_fewer_are_among_more(tmp_path: Path) -> None:
    board = _keys(tmp_path / "one", 7)
    few, more = left_out(board, 4), left_out(board, 8)
    assert few == left_out(board, 4)
    assert set(few) < set(more)
    others = [set(left_out(_keys(tmp_path / str(seed), seed), 4)) for seed in range(5)]
    assert len(set(map(frozenset, others))) > 1


def test_nothing_to_leave_out(tmp_path: Path) -> None:
    (tmp_path / "keys").mkdir()
    assert left_out(tmp_path, 3) == {}
