"""A change of the queue is answered once it is on the disk, however long that takes."""

import asyncio
import json
import threading
from pathlib import Path

import pytest

from pmm.console.queue_journal import KeptPlan, KeptQueue, QueueJournal
from pmm.console.queue_keeper import QueueKeeper


class SlowJournal(QueueJournal):
    """Writes when it is let."""

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, Path("rig.toml"))
        self.let = threading.Semaphore(0)
        self.begun = 0

    def write(self, queue: KeptQueue) -> None:
        self.begun += 1
        self.let.acquire()
        super().write(queue)

    @property
    def plans(self) -> list[str]:
        return [one["plan"] for one in json.loads(self.path.read_text())["plans"]]


async def _begun(journal: SlowJournal, times: int) -> None:
    while journal.begun < times:
        await asyncio.sleep(0.001)


def test_who_changed_it_waits_and_nobody_else(tmp_path: Path) -> None:
    journal, names = SlowJournal(tmp_path), list[str]()

    def state() -> KeptQueue:
        return KeptQueue(tuple(KeptPlan(k, name, "") for k, name in enumerate(names, 1)))

    async def changes() -> None:
        keeper = QueueKeeper(journal, state, pytest.fail)
        keeper.begin()
        await _begun(journal, 1)
        names.append("one.toml")
        keeper.note_change()  # while the writing before is under way
        waits = asyncio.ensure_future(keeper.wait_written())
        journal.let.release()
        await _begun(journal, 2)  # the event loop goes on
        assert journal.plans == []
        assert not waits.done()
        journal.let.release()
        assert await waits == ""
        assert journal.plans == ["one.toml"]

    asyncio.run(changes())


def test_a_full_disk_is_said_in_the_answer(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    said = list[str]()

    async def changes() -> str:
        keeper = QueueKeeper(QueueJournal(tmp_path / "file", Path("rig")), KeptQueue, said.append)
        keeper.begin()
        return await keeper.wait_written()

    found = asyncio.run(changes())
    assert found.startswith("the queue is not kept: ")
    assert said == [found]
