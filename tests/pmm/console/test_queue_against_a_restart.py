"""The queue after a console that was killed: the plans, their changes, order and proposals."""

import json
import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path
from typing import Any

import pytest

import pmm
from hardware.description.errors import ConfigurationError
from pmm.console.proposals import ProposedChange
from pmm.console.queue_journal import KeptPlan, KeptQueue, QueueJournal
from pmm.console.requests import EditPosted, HoldPosted, MovePosted, PlanPosted
from pmm.console.security import Visitor, VisitorRole
from tests.pmm.console.chromium import console, plan, rig_in

WITHIN_S = 120.0
KEPT = KeptQueue(
    (
        KeptPlan(3, "b.toml", (
            EditPosted(number=3, run="r", frequency_hz=1.05), MovePosted(number=3, run="r", by=-1),
            HoldPosted(number=3, held=True),
        )),
        KeptPlan(1, "ä.toml"),
    ),
    (
        ProposedChange(
            7, "queue", PlanPosted(name="c.toml"), "c", Visitor(VisitorRole.PROPOSE, "Ann"), "utc"
        ),
    ),
)  # fmt: skip


def test_what_is_kept_is_read_again_and_rigs_do_not_share(tmp_path: Path) -> None:
    one, other = (QueueJournal(tmp_path / "new", Path(name)) for name in ("a.toml", "b.toml"))
    assert one.read() == KeptQueue()
    one.write(KEPT)
    assert one.read() == KEPT
    assert other.read() == KeptQueue()


@pytest.mark.parametrize("content", ["", "{", "[]", '{"schema": "x"}', "\xff\xfe", "null"])
def test_a_file_that_is_none_of_ours_is_named(tmp_path: Path, content: str) -> None:
    journal = QueueJournal(tmp_path, Path("rig.toml"))
    journal.path.write_text(content, encoding="latin-1")
    with pytest.raises(ConfigurationError, match="not the queue of a console"):
        journal.read()


def test_a_writing_that_is_cut_leaves_the_queue_of_before(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = QueueJournal(tmp_path, Path("rig.toml"))
    journal.write(KEPT)

    def cut(_: int) -> None:
        raise OSError("cut")

    monkeypatch.setattr(os, "fsync", cut)
    with suppress(OSError):
        journal.write(KeptQueue())
    assert journal.read() == KEPT


def _kept(out: Path) -> dict[str, Any]:
    (file,) = out.glob("queue-*.json")
    return json.loads(file.read_text(encoding="utf-8"))


@pytest.mark.slow
def test_a_console_that_was_killed_has_its_queue_again(tmp_path: Path) -> None:
    rig, out = rig_in(tmp_path / "rig"), tmp_path / "out"
    two = plan("two", periods=4).replace("= 1.0", "= [1.0, 1.1]")
    rig.with_name("two.toml").write_text(two, encoding="utf-8")
    rig.with_name("gone.toml").write_text(plan("gone"), encoding="utf-8")
    ended = (AssertionError, subprocess.SubprocessError)
    with suppress(*ended), console(rig, out) as one, pmm.connect(one.address) as client:
        for name in ("gone.toml", "two.toml", plan("last")):
            client.queue(name)
        client.edit(2, "run-f1-a20", frequency_hz=0.95)
        client.move(2, 1, "run-f1-a20")
        client.hold(2, "run-f1.1-a20")
        client.move(3, -1)
        os.kill(one.pid, signal.SIGKILL)  # once it is answered it is on the disk
    kept = _kept(out)
    assert [(one["number"], len(one["changes"])) for one in kept["plans"]] == [
        (1, 0),
        (3, 0),
        (2, 3),
    ]
    assert kept["rig"] == str(rig.resolve())
    rig.with_name("gone.toml").unlink()
    with console(rig, out) as one, pmm.connect(one.address) as client:
        client.wait(lambda known: (known["frame"] or {}).get("queue") == [2], WITHIN_S)
        assert client.frame["state"] == "idle"
        client.wait(lambda known: set(known["plans"]) == {"1", "2"}, WITHIN_S)
        assert client.known["plans"]["1"]["name"] == "last"
        again = client.known["plans"]["2"]
        assert [(run["name"], run["frequency_hz"]) for run in again["runs"]] == [
            ("run-f1.1-a20", 1.1), ("run-f1-a20", 0.95),
        ]  # fmt: skip
        assert again["held"] == ["run-f1.1-a20"]
        said = [known["text"] for known in client.known["notices"] if known["kind"] == "alarm"]
        assert any(text.startswith("gone.toml is not in the queue again") for text in said)
