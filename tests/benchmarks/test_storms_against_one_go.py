"""Sequences that were interrupted or shared among workers count as those made in one go."""

import json
from pathlib import Path

from benchmarks.storms import main


def test_it_goes_on_where_it_ended(tmp_path: Path) -> None:
    once, twice = tmp_path / "once.json", tmp_path / "twice.json"
    assert main(["--to", "2", "--file", str(once), "--workers", "1"]) == 0
    assert main(["--to", "1", "--file", str(twice), "--workers", "1"]) == 0
    assert main(["--to", "2", "--file", str(twice), "--workers", "1"]) == 0
    found = json.loads(once.read_text(encoding="utf-8"))
    assert found == json.loads(twice.read_text(encoding="utf-8"))
    assert (found["sequences"], found["wrong"]) == (2, [])


def test_two_workers_find_what_one_does(tmp_path: Path) -> None:
    alone, shared = tmp_path / "alone.json", tmp_path / "shared.json"
    assert main(["--to", "4", "--file", str(alone), "--workers", "1"]) == 0
    assert main(["--to", "4", "--file", str(shared), "--workers", "2"]) == 0
    assert alone.read_bytes() == shared.read_bytes()
