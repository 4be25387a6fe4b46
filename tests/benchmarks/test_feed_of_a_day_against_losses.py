"""What feeds a day of live values, against arithmetic: what is lost or dropped holds nothing up."""

from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, cast

import pytest

from benchmarks import live_values
from benchmarks.live_values import Counted, Feed
from pmm.console.live.outlet import OutletStatus
from pmm.console.messages import Frame, LoopMessage

if TYPE_CHECKING:
    from pmm.console.live.process import Publishing


class _Process:
    """Carries each tick at once; some it loses, some it drops, and none while nobody waits."""

    def __init__(self, counted: Counted, lost: range, dropped: range, *, slow: bool) -> None:
        self.counted, self.lost, self.dropped, self.slow = counted, lost, dropped, slow
        self.carried = self.drops = self.waiting = self.most = self.naps = 0

    def take(self, message: LoopMessage) -> None:
        if not isinstance(message, Frame):
            return
        self.waiting += self.slow
        self.most = max(self.most, self.waiting)
        if message.number in self.dropped:
            self.drops += 1
            return
        self.carried += 1
        if message.number not in self.lost:
            content = f'{{"n": {message.number}}}'
            self.counted(None, None, SimpleNamespace(topic="t/live", payload=content))

    def statuses(self) -> tuple[OutletStatus, ...]:
        return (OutletStatus("MQTT", True, self.carried, self.drops),)

    def nap(self) -> None:
        self.naps += 1
        self.waiting = 0


def _feed(
    monkeypatch: pytest.MonkeyPatch,
    *,
    lost: range = range(0),
    dropped: range = range(0),
    slow: bool = False,
) -> tuple[Feed, Any]:
    """Return a feed whose waits take no time, and its process."""
    counted, clock = Counted(), [0.0]
    process = _Process(counted, lost, dropped, slow=slow)

    def sleep(duration_s: float) -> None:
        clock[0] += duration_s
        process.nap()

    monkeypatch.setattr(
        live_values, "time", SimpleNamespace(monotonic=lambda: clock[0], sleep=sleep)
    )
    return Feed(cast("Publishing", process), counted), process


def test_what_was_lost_in_an_outage_holds_up_none_of_those_that_follow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A reader that came back after the publisher once cost two minutes for each hundred ticks."""
    feed, process = _feed(monkeypatch, lost=range(1001, 2501))
    feed.give(1000, reads=True)
    feed.give(1500, reads=False)
    feed.settle()
    assert feed.lost == 1500
    before = process.naps
    feed.give(5000, reads=True)
    assert process.naps == before
    assert (feed.number, feed.counted.once, feed.on_the_way()) == (7500, 6000, 0)


def test_what_was_dropped_while_it_reads_holds_up_none_of_those_that_follow(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    feed, process = _feed(monkeypatch, dropped=range(501, 2001))
    feed.give(5000, reads=True)
    feed.settle()
    assert process.naps == 0
    assert (feed.counted.once, feed.status.dropped, feed.lost) == (3500, 1500, 0)


def test_what_came_though_it_was_told_as_dropped_hides_nothing_that_was_lost(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    feed, process = _feed(monkeypatch, lost=range(2001, 2031))
    feed.give(1000, reads=True)
    process.drops += 50  # it had sent them, and nobody confirmed it
    feed.settle()
    assert (feed.lost, feed.both) == (0, 50)
    feed.give(2000, reads=True)
    feed.settle()
    assert (feed.lost, feed.both) == (30, 50)


def test_ticks_of_an_outage_that_come_later_do_not_count_as_those_of_reading(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The share of ticks that arrived was 1.0015: those that had waited in the outages counted."""
    feed, _ = _feed(monkeypatch, lost=range(101, 104))
    feed.give(1000, reads=True)
    feed.give(500, reads=False)
    feed.give(1000, reads=True)
    assert (feed.counted.once, feed.counted.while_read, feed.reached) == (2497, 1997, 2000)


def test_ticks_that_do_not_come_while_it_reads_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    feed, _ = _feed(monkeypatch, lost=range(1001, 2000))
    with pytest.raises(TimeoutError, match=r"600 ticks on their way at tick 1600"):
        feed.give(3000, reads=True)


@pytest.mark.parametrize("reads", [True, False])
def test_no_more_wait_to_be_fetched_than_may(monkeypatch: pytest.MonkeyPatch, reads: bool) -> None:
    """Whether it reads or not: no tick of the day is dropped in front of the process."""
    feed, process = _feed(monkeypatch, slow=True)
    feed.give(5000, reads=reads)
    assert process.most == 200
