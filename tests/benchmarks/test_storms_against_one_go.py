"""Sequences that were interrupted and gone on with count as those made in one go."""

import json
from pathlib import Path

from benchmarks.storms import main


def test_it_goes_on_where_it_ended(tmp_path: Path) -> None:
    once, twice = tmp_path / "once.json", tmp_path / "twice.json"
    assert main(["--to", "2", "--file", str(once)]) == 0
    assert main(["--to", "1", "--file", str(twice)]) == 0
    assert main(["--to", "2", "--file", str(twice)]) == 0
    found = json.loads(once.read_text(encoding="utf-8"))
    assert found == json.loads(twice.read_text(encoding="utf-8"))
    assert (found["sequences"], found["wrong"]) == (2, [])
