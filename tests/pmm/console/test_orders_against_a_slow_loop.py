"""Orders that the loop answers late or not at all: each is carried out once, in time, or not."""

import asyncio
import json
import threading
import time
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from pmm.console.audit import COMMANDS
from pmm.console.loop_side import LoopSide, RefusedError, UnansweredError
from pmm.console.messages import LoopOrder, OrderKind, Reply
from pmm.console.quick_stop import PATIENCE_S, QuickStop
from tests.pmm.console import serving
from tests.pmm.console.serving import served
from tests.pmm.console.test_proposals_against_roles import PLANS, _enter

_WITHIN_S = 60.0


def test_an_order_may_be_begun_for_five_seconds_and_its_answer_is_taken_after_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    ours, theirs = Pipe()

    async def orders() -> tuple[LoopOrder, float, float, list[Reply]]:
        side = LoopSide(theirs, QuickStop(), lambda _: None, lambda: None)
        before_s = time.monotonic()
        order = asyncio.ensure_future(side.order(OrderKind.COMMAND, "start"))
        while not ours.poll():
            await asyncio.sleep(0.001)
        sent, after_s = ours.recv(), time.monotonic()
        side.replied(Reply(sent.number, True, "start taken"))
        assert (await order).text == "start taken"
        monkeypatch.setattr("pmm.console.loop_side.PATIENCE_S", 0.0)
        monkeypatch.setattr("pmm.console.loop_side._ANSWER_S", 0.05)
        late: list[Reply] = []
        with pytest.raises(UnansweredError, match="does not answer") as raised:
            await side.order(OrderKind.COMMAND, "start")
        raised.value.then(late.append)
        await asyncio.sleep(0.0)
        assert late == []
        side.replied(Reply(ours.recv().number, True, "start taken"))
        await asyncio.sleep(0.0)
        ours.close()
        with pytest.raises(RefusedError, match="is gone"):
            await side.order(OrderKind.COMMAND, "start")
        return sent, before_s, after_s, late

    sent, before_s, after_s, late = asyncio.run(orders())
    theirs.close()
    assert PATIENCE_S == 5.0
    assert before_s + 5.0 <= sent.until_s <= after_s + 5.0
    assert [reply.text for reply in late] == ["start taken"]


@pytest.mark.parametrize("carried_out", [True, False])
def test_an_approval_without_an_answer_is_offered_again_only_if_it_was_not_carried_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, carried_out: bool
) -> None:
    monkeypatch.setattr("pmm.console.loop_side.PATIENCE_S", 0.2)
    monkeypatch.setattr("pmm.console.loop_side._ANSWER_S", 0.1)
    answer = threading.Event()

    def slow(
        connection: Connection, _: QuickStop, orders: list[LoopOrder], end: threading.Event
    ) -> None:
        while not end.is_set():
            if connection.poll(0.02):
                orders.append(connection.recv())
                while not (answer.is_set() or end.is_set()):
                    time.sleep(0.01)
                connection.send(Reply(orders[-1].number, carried_out, "the answer"))
        connection.close()

    monkeypatch.setattr(serving, "_loop", slow)
    with served(tmp_path, **PLANS) as one:
        _enter(one, "propose_token", "Ann")
        assert one.post("/api/plans/queue", {"name": "plan.toml"})[0] == 200
        _enter(one, "token", "Eve")
        assert one.post("/api/take-control", {"confirm": True})[0] == 200
        status, said = one.post("/api/proposals/approve", {"number": 1})
        assert status == 409
        assert "does not answer" in str(said["error"])
        status, said = one.post("/api/proposals/approve", {"number": 1})
        assert "no proposal 1 waits" in str(said["error"])
        assert len(one.orders) == 1
        answer.set()
        late = _logged(tmp_path, "answered late: the answer")
        assert (late["action"], late["name"], late["taken"]) == ("approve", "Eve", carried_out)
        status, said = one.post("/api/proposals/approve", {"number": 1})
        is_offered = "no proposal 1 waits" not in str(said)
        assert is_offered is not carried_out
        assert len(one.orders) == (1 if carried_out else 2)


def _logged(folder: Path, said: str) -> dict[str, object]:
    """Return the line of the log that says so, once it is there."""
    end_s = time.monotonic() + _WITHIN_S
    while time.monotonic() < end_s:
        lines = (folder / COMMANDS).read_text("utf-8").splitlines()
        for record in map(json.loads, lines):
            if record["said"] == said:
                return dict(record)
        time.sleep(0.01)
    raise AssertionError(f"never logged: {said}")
