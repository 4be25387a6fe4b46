"""Browsers that do not keep up: what waits is bounded, and nobody waits for them."""

import asyncio
import json
import math
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest

from pmm.console.client import WAITING, Client
from pmm.console.desk import Desk, Holder, NotInControlError
from pmm.console.hub import Hub
from pmm.console.messages import Bus, ChannelInfo, Frame, Hello, Notice, SignalTrace
from pmm.console.pump import send_round
from pmm.console.request_body import Requester
from pmm.console.security import Visitor
from pmm.console.traces import POINTS
from pmm.recorder.lateness import CycleStatistics
from pmm.run.states import State
from pmm.run.status import RunStatus

EACH = 4  # points a frame


@dataclass
class Browser:
    """Takes what is sent, or nothing until it is told to."""

    session: str
    took: list[dict[str, Any]] = field(default_factory=list)
    open: asyncio.Event = field(default_factory=asyncio.Event)
    closed: tuple[int, str] | None = None

    async def send(self, text: str) -> None:
        await self.open.wait()
        self.took.append(json.loads(text))

    async def close(self, code: int, reason: str) -> None:
        self.closed = code, reason

    @property
    def frames(self) -> list[dict[str, Any]]:
        return [one for one in self.took if one["type"] == "frame"]


def who(session: str) -> Requester:
    return Requester(session, "127.0.0.1", Visitor())


@dataclass
class Room:
    """A hub, its browsers, and whose control has lapsed."""

    hub: Hub
    lapsed: list[Requester]
    number: int = 0

    def join(self, session: str, *, slow: bool = False) -> Browser:
        one = Browser(session)
        if not slow:
            one.open.set()
        self.hub.join(Client(who(session), one.send, one.close))
        return one

    async def frame(self) -> None:
        """Take the next frame and send it to whoever takes it."""
        self.number += 1
        first = self.number * EACH
        values = np.arange(first, first + EACH, dtype=float)[None, :]
        self.hub.take(_frame(self.number, SignalTrace(first, first / 100.0, values)))
        await self.round()

    async def round(self) -> None:
        await send_round(self.hub)
        for _ in range(3):
            await asyncio.sleep(0)


def _frame(number: int, trace: SignalTrace) -> Frame:
    nothing = math.nan
    return Frame(
        number,
        RunStatus(State.IDLE, number, number / 25.0),
        0,
        (),
        None,
        nothing,
        nothing,
        nothing,
        (),
        (),
        "",
        Bus(True, 0, 0),
        CycleStatistics(0, 0.0, 0.0, 0.0, 0),
        None,
        trace,
    )


def _in_room(act: Callable[[Room], Coroutine[Any, Any, None]]) -> None:
    async def run() -> None:
        lapsed: list[Requester] = []
        utc = "2026-01-01T00:00:00+00:00"
        hub = Hub(lambda _: None, lambda _: None, lapsed.append, lambda: utc)
        channels = (ChannelInfo("force", "N"),)
        hub.take(Hello("rig", __file__, False, channels, 100.0, 100.0, 3, 1.0))  # type: ignore[arg-type]
        await act(Room(hub, lapsed))
        for one in list(hub.clients.values()):
            hub.part(one)

    asyncio.run(run())


def _points(messages: list[dict[str, Any]]) -> list[float]:
    return [x for one in messages for piece in one.get("traces", ()) for x in piece["values"][0]]


def test_begins_with_a_snapshot_and_then_gets_every_frame_and_message() -> None:
    async def act(room: Room) -> None:
        one = room.join("a")
        await room.round()
        for _ in range(3):
            await room.frame()
        room.hub.add_notice(Notice("state", 0.0, "homing"))
        await room.round()
        kinds = [message["type"] for message in one.took]
        assert kinds == ["snapshot", "frame", "frame", "frame", "notice"]
        assert one.took[0]["hello"]["rig"] == "rig"

    _in_room(act)


def test_a_silence_is_counted_from_its_beginning_whoever_else_comes_and_goes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("pmm.console.hub.SILENT_S", 10.0)

    async def act(room: Room) -> None:
        hub, clock = room.hub, asyncio.get_running_loop()
        began_s = clock.time()
        room.join("a")
        hub.part(hub.clients["a"])
        ended_s = clock.time()
        for name in "bcd":
            await asyncio.sleep(0.01)
            room.join(name)
            hub.part(hub.clients[name])
        silence = hub._silence
        assert silence is not None
        assert began_s + 10.0 <= silence.when() <= ended_s + 10.0
        hub.hear_holder()  # a request of its own
        assert silence.cancelled()
        assert hub._silence is not None
        assert hub._silence.when() > ended_s + 10.0
        room.join("a")
        assert hub._silence is None
        assert room.lapsed == []

    _in_room(act)


def test_a_slow_browser_gets_the_latest_picture_with_all_points_and_nobody_waits_for_it() -> None:
    async def act(room: Room) -> None:
        first, slow = room.join("a"), room.join("b", slow=True)
        for _ in range(100):
            await room.frame()
        assert [one["n"] for one in first.frames] == list(range(1, 101))[-len(first.frames) :]
        assert len(first.frames) >= 99
        assert not slow.took
        slow.open.set()
        await room.frame()
        await room.frame()
        assert [one["n"] for one in slow.frames] == [102]
        assert _points(slow.took) == _points(first.took)

    _in_room(act)


def test_who_has_control_is_sent_to_before_each_batch_of_those_who_watch() -> None:
    async def act(room: Room) -> None:
        first = room.join("in control")
        for number in range(99):
            room.join(str(number))
        await room.frame()
        await room.frame()
        frames = len(first.frames)
        room.hub.desk.take_over(who("98"))  # the last of the round
        last = room.hub.clients["98"]
        room.number += 1
        room.hub.take(_frame(room.number, SignalTrace(0, 0.0, np.empty((1, 0)))))
        sending = asyncio.ensure_future(send_round(room.hub))
        await asyncio.sleep(0)
        assert last.frame == room.number
        assert room.hub.clients["50"].frame == room.number - 1
        await sending
        assert len(first.frames) == frames + 1

    _in_room(act)


def test_messages_that_are_not_taken_are_replaced_by_a_snapshot() -> None:
    async def act(room: Room) -> None:
        slow = room.join("a", slow=True)
        await room.round()
        for number in range(10 * WAITING):
            room.hub.add_notice(Notice("alarm", 0.0, str(number)))
        client = room.hub.clients["a"]
        assert len(client._waiting) <= WAITING
        assert client.dropped == 10 * WAITING
        slow.open.set()
        await room.round()
        await room.round()
        assert [one["type"] for one in slow.took] == ["snapshot", "snapshot"]
        assert slow.took[1]["notices"][-1]["text"] == str(10 * WAITING - 1)

    _in_room(act)


def test_a_snapshot_holds_the_points_of_one_window() -> None:
    async def act(room: Room) -> None:
        room.join("a")
        for _ in range(2 * POINTS // EACH):
            await room.frame()
        late = room.join("b")
        await room.round()
        assert len(_points(late.took)) == POINTS

    _in_room(act)


def test_a_session_that_is_opened_twice_ends_in_its_first_window() -> None:
    async def act(room: Room) -> None:
        old = room.join("a")
        await room.round()
        new = room.join("a")
        await room.frame()
        assert old.closed == (4001, "this session was opened in another window")
        assert not old.frames
        assert new.took[0]["type"] == "snapshot"

    _in_room(act)


def test_control_stays_with_the_first_until_it_is_taken() -> None:
    desk = Desk()
    assert desk.seen_from("a") is Holder.NOBODY
    desk.arrive(who("a"))
    desk.arrive(who("b"))
    assert (desk.seen_from("a"), desk.seen_from("b")) == (Holder.YOU, Holder.OTHER)
    desk.take_over(who("b"))
    assert (desk.seen_from("a"), desk.seen_from("b")) == (Holder.OTHER, Holder.YOU)
    with pytest.raises(NotInControlError):
        desk.give_back("a")
    desk.give_back("b")
    assert (desk.seen_from("a"), desk.seen_from("b")) == (Holder.NOBODY, Holder.NOBODY)
    desk.arrive(who("a"))
    assert desk.seen_from("a") is Holder.YOU


def test_control_lapses_where_its_holder_is_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pmm.console.hub.SILENT_S", 0.0)  # the loop's next round

    async def act(room: Room) -> None:
        for session in "ab":
            room.join(session)
        first, second = (room.hub.clients[session] for session in "ab")
        room.hub.part(first)
        room.join("a")  # a reload
        await room.round()
        room.hub.part(second)
        await room.round()
        assert (room.hub.desk.holder, room.lapsed) == (who("a"), [])
        room.hub.part(room.hub.clients["a"])
        room.hub.hear_holder()  # a request of the holder's without a page
        assert room.hub.desk.holder == who("a")
        await room.round()
        assert room.lapsed == [who("a")]
        assert room.hub.desk.seen_from("a") is Holder.NOBODY
        room.join("b")
        assert room.hub.desk.holder == who("b")

    _in_room(act)
