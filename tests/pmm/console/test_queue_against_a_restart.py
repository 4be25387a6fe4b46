"""The queue after a console that was killed: the plans, their changes, order and proposals."""

import hashlib
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
from pmm.console.plans import Plans
from pmm.console.proposals import ProposedChange
from pmm.console.queue_journal import KeptPlan, KeptQueue, QueueJournal
from pmm.console.requests import EditPosted, HoldPosted, MovePosted, PlanPosted
from pmm.console.security import Visitor, VisitorRole
from pmm.console.worker_tasks import QueuedPlans, ready_plan, restored_plan
from pmm.plan.rig_file import read_rig_file
from tests.pmm.console.chromium import console, plan, rig_in

WITHIN_S = 120.0
KEPT = KeptQueue(
    (
        KeptPlan(3, "b.toml", "0" * 64, (
            EditPosted(number=3, run="r", frequency_hz=1.05), MovePosted(number=3, run="r", by=-1),
            HoldPosted(number=3, held=True),
        )),
        KeptPlan(1, "ä.toml", "1" * 64),
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


_HEAD = '{"schema": "pmm-console-queue-1", "rig": "rig.toml", "proposals": [], "plans": '
STRANGE = (
    "", "{", "[]", '{"schema": "x"}', "\xff\xfe", "null", "[" * 100_000,
    _HEAD + '[{"number": 1, "plan": "p.toml", "changes": []}]}',  # without a checksum
    _HEAD + '[{"number": 1, "plan": "p.toml", "sha256": "", "changes": [7]}]}',
    _HEAD + '[{"number": 1, "plan": "p.toml", "sha256": "", "changes": 7}]}',
)  # fmt: skip


@pytest.mark.parametrize("content", STRANGE)
def test_a_file_that_is_none_of_ours_is_set_aside_and_named(tmp_path: Path, content: str) -> None:
    journal = QueueJournal(tmp_path, Path("rig.toml"))
    for number in (1, 2):
        journal.path.write_text(content, encoding="latin-1")
        aside = journal.path.with_name(f"{journal.path.name}.unread-{number}")
        with pytest.raises(ConfigurationError, match="not the queue of a console") as raised:
            journal.read()
        assert f"it is kept as {aside.name}" in str(raised.value)
        journal.write(KEPT)
        assert aside.read_text(encoding="latin-1") == content
        assert journal.read() == KEPT


def test_a_file_that_can_be_neither_read_nor_moved_is_not_overwritten(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    journal = QueueJournal(tmp_path, Path("rig.toml"))
    journal.path.write_text("{", encoding="utf-8")

    def refused(*_: object) -> None:
        raise PermissionError("refused")

    monkeypatch.setattr(Path, "rename", refused)
    with pytest.raises(ConfigurationError, match="not be moved away either: refused"):
        journal.read()
    with pytest.raises(OSError, match="cannot be read"):
        journal.write(KEPT)
    assert journal.path.read_text(encoding="utf-8") == "{"


def test_a_plan_whose_file_is_another_one_by_now_is_not_queued_again(tmp_path: Path) -> None:
    rig = rig_in(tmp_path / "rig")
    file = rig.with_name("mine.toml")
    file.write_text(plan("mine"), encoding="utf-8")
    plans = Plans(rig, read_rig_file(rig).hashes, rig.parent, tmp_path / "out")
    queued = QueuedPlans()
    number = queued.add(ready_plan(plans, "mine.toml", ""))
    (kept,) = queued.kept_plans()
    assert kept.sha256 == hashlib.sha256(file.read_bytes()).hexdigest()
    again = restored_plan(plans, kept)
    assert again is not None
    assert again.packed.numbered(number) == queued.plan(number)
    file.write_text(plan("mine", periods=9), encoding="utf-8")
    with pytest.raises(ConfigurationError, match="is not the file that was queued"):
        restored_plan(plans, kept)


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
