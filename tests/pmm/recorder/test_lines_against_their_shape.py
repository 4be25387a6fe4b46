"""A journal's line that is JSON, and not what the journal holds, ends what is whole of it."""

import json
from pathlib import Path

import pytest

from pmm.recorder.line_shapes import read_lines
from pmm.recorder.recording import read_run
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunRecorder
from tests.pmm.recorder.recorded import fed, header

JOURNALS = {
    "pulses.jsonl": [1, 7.5, None],
    "events.jsonl": {"cycle": 1, "time_s": 0.1, "kind": "state", "text": "gate open"},
    "harmonics.jsonl": {
        "opened_s": 0.1,
        "closed_s": 1.1,
        "periods": 1,
        "channels": ["force_aft"],
        "coefficients": [[0.0, 1.0, float("nan")]],
    },
    "lines.jsonl": [1, "photocell", "P,1,2,3\u00ff"],
    "cycles.jsonl": [100, 1e-4, 2e-4, 3e-4, 0],
}
OTHERS = (
    "1", "null", "[]", "{}", "[1,0.1", "[1,1e999,0,0,0]", '[1,"a"]', '[[],"photocell","a"]',
    "[1e400,7.5,null]", '[1,"photocell","\\u1234"]', '[1,true,0.1,0.1,"0"]',
    '{"cycle":1,"time_s":"now","kind":"state","text":"hold"}',
    '{"opened_s":0,"closed_s":1,"periods":1,"channels":["a"],"coefficients":[[1,2],[3]]}',
    "[" * 100_000,
)  # fmt: skip


@pytest.mark.parametrize("name", JOURNALS)
@pytest.mark.parametrize("other", OTHERS, ids=range(len(OTHERS)))
def test_another_shape_is_damage(name: str, other: str, tmp_path: Path) -> None:
    path, line = tmp_path / name, json.dumps(JOURNALS[name])
    path.write_text(f"{line}\n{line}\n{other}\n{line}\n", encoding="utf-8")
    values, behind = read_lines(path)
    assert len(values) == 2
    assert json.dumps(values) == f"[{line}, {line}]"
    assert behind == len(f"{other}\n{line}\n")


@pytest.mark.parametrize("name", JOURNALS)
@pytest.mark.parametrize("other", ["[1]", "{}"])
def test_a_run_is_recovered_all_the_same(name: str, other: str, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, 201))
    whole = (folder / name).read_bytes() if (folder / name).exists() else b""
    (folder / name).write_bytes(whole + f"{other}\n".encode())
    run = read_run(folder)
    assert run.tails[name] == len(other) + 1
    assert run.cycles is not None
    assert recover(folder).samples == 200
