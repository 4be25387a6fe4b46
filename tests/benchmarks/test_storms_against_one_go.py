"""Sequences that were interrupted or shared among workers count as those made in one go."""

import json
from pathlib import Path
from typing import Any

import pytest

from benchmarks.storms import TRIALS


@pytest.mark.slow
def test_it_goes_on_where_it_ended(tmp_path: Path) -> None:
    once, twice = tmp_path / "once.json", tmp_path / "twice.json"
    assert _main(["--to", "2", "--file", str(once), "--workers", "1"]) == 0
    assert _main(["--to", "1", "--file", str(twice), "--workers", "1"]) == 0
    assert _main(["--to", "2", "--file", str(twice), "--workers", "1"]) == 0
    found = _found(once)
    assert found == _found(twice)
    assert (found["sequences"], found["wrong"]) == (2, [])


@pytest.mark.slow
def test_two_workers_find_what_one_does(tmp_path: Path) -> None:
    alone, shared = tmp_path / "alone.json", tmp_path / "shared.json"
    assert _main(["--to", "4", "--file", str(alone), "--workers", "1"]) == 0
    assert _main(["--to", "4", "--file", str(shared), "--workers", "2"]) == 0
    assert _found(alone) == _found(shared)


def test_it_says_where_and_at_which_commits_it_was_counted(tmp_path: Path) -> None:
    file = tmp_path / "kept.json"
    file.write_text(
        json.dumps({"sequences": 0, "wrong": [], "counts": {}, "commits": ["earlier"]}),
        encoding="utf-8",
    )
    assert _main(["--to", "1", "--file", str(file), "--workers", "1"]) == 0
    kept = json.loads(file.read_text(encoding="utf-8"))
    assert kept["commits"] == ["earlier", kept["machine"]["commit"]]


def _found(file: Path) -> dict[str, Any]:
    """Return what was found, without the machine and its load."""
    kept = json.loads(file.read_text(encoding="utf-8"))
    return {key: value for key, value in kept.items() if key != "machine"}


def _main(arguments: list[str]) -> int:
    return TRIALS.main(arguments, None)
