"""A broker that is slow, or reads no more: nothing waits for it or grows, drops are counted."""

import asyncio
import sys
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

import aiomqtt
import paho.mqtt
import pytest

from pmm.console.live import mqtt
from pmm.console.live.live_settings import live_settings
from pmm.console.live.mqtt import MqttOutlet
from pmm.console.live.values import LiveTable
from tests.pmm.console.hand_broker import HandBroker
from tests.pmm.console.live_rig import HELLO, WITHIN_S, frame

TABLE = LiveTable(HELLO)
MOST = 40
TOGETHER = 50  # on their way at a time


@pytest.fixture(autouse=True)
def _impatient(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mqtt, "_PATIENCE_S", 0.5)
    monkeypatch.setattr("pmm.console.live.outlet.AGAIN_S", 0.05)


async def _until(condition: Callable[[], bool]) -> None:
    async with asyncio.timeout(WITHIN_S):
        while not condition():
            await asyncio.sleep(0.005)


def _outlet(broker: HandBroker, most: int) -> MqttOutlet:
    given = live_settings("tank", f"mqtt://127.0.0.1:{broker.port}/t", None, None, None)
    return MqttOutlet(given.broker, most)


def _offer(outlet: MqttOutlet, first: int, last: int) -> None:
    for number in range(first, last + 1):
        outlet.offer(TABLE.tick(frame(number), 0.0))


def test_ticks_have_their_numbers_and_are_told_with_units() -> None:
    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, MOST)
        running = asyncio.create_task(outlet.run())
        _offer(outlet, 1, 20)
        await _until(lambda: outlet.status().carried == 20)
        await _until(lambda: broker.told.get("t/status", {}).get("carried") == 20)
        assert broker.told["t/status"]["dropped"] == 0
        running.cancel()

    with HandBroker() as broker:
        asyncio.run(run(broker))
    assert broker.numbers == list(range(1, 21))
    live, units = broker.told["t/live"], broker.told["t/units"]
    assert set(units) == set(live["values"])
    assert (live["values"]["force_aft"], units["force_aft"]) == (40.0, "N")
    assert (live["values"]["moment__fore"], live["values"]["shaft"]) == (7.0, None)
    assert live["alarms"] == {"shaft": "invalid", "free_space": "invalid"}


def test_one_that_stops_reading_costs_what_is_counted() -> None:
    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, MOST)
        running = asyncio.create_task(outlet.run())
        _offer(outlet, 1, 30)
        await _until(lambda: outlet.status().carried == 30)
        broker.reading.clear()
        _offer(outlet, 31, 130)
        await _until(lambda: not outlet.status().connected)
        assert "no answer within 0.5 s" in outlet.status().trouble
        _offer(outlet, 131, 230)
        status = outlet.status()
        assert (status.carried, status.dropped) == (30, 200 - MOST)
        broker.reading.set()
        await _until(lambda: outlet.status().carried == 30 + MOST)
        running.cancel()
        assert set(broker.numbers) >= {*range(1, 31), *range(231 - MOST, 231)}

    with HandBroker() as broker:
        asyncio.run(run(broker))


def test_one_that_is_slow_gets_all_in_the_end() -> None:
    """It takes longer for those that go together than it is waited for: some pass each time."""

    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, 100)
        broker.wait_s = 0.02
        _offer(outlet, 1, 60)
        running = asyncio.create_task(outlet.run())
        await _until(lambda: outlet.status().carried == 60)
        running.cancel()
        assert outlet.status().dropped == 0

    with HandBroker() as broker:
        asyncio.run(run(broker))
        assert set(broker.numbers) == set(range(1, 61))
        assert broker.connections > 1


def test_one_that_confirms_a_tick_when_another_comes_gets_each_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """As a network does that carries confirmations back only with what comes next."""
    monkeypatch.setattr(mqtt, "_PATIENCE_S", 5.0)

    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, 200)
        broker.behind = TOGETHER - 1
        _offer(outlet, 1, 200)
        running = asyncio.create_task(outlet.run())
        await _until(lambda: len(broker.came) >= 200 or broker.connections > 1)
        assert broker.connections == 1
        assert broker.came == list(range(1, 201))
        await _until(lambda: outlet.status().carried == 201 - TOGETHER)
        running.cancel()

    with HandBroker() as broker:
        asyncio.run(run(broker))


def test_one_that_comes_back_gets_again_only_what_was_on_its_way() -> None:
    """However many wait meanwhile."""

    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, 1000)
        broker.behind = TOGETHER  # it never confirms one
        _offer(outlet, 1, 1000)
        running = asyncio.create_task(outlet.run())
        await _until(lambda: broker.connections > 1 and len(broker.came) >= 2 * TOGETHER)
        broker.behind = 0
        await _until(lambda: outlet.status().carried == 1000)
        running.cancel()
        assert outlet.status().dropped == 0

    with HandBroker() as broker:
        asyncio.run(run(broker))
        assert sorted(set(broker.came)) == list(range(1, 1001))
        assert len(broker.came) - 1000 <= TOGETHER * (broker.connections - 1)


def test_lines_run_for_a_tick_do_not_grow_with_those_that_wait(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(mqtt, "_PATIENCE_S", 60.0)  # a traced line takes longer
    few, many = _lines_a_tick(100), _lines_a_tick(800)
    assert many <= 1.1 * few


def _lines_a_tick(ticks: int) -> float:
    """Return how many lines of ours and of the client's library run for each tick that waits."""
    ours = tuple(
        str(Path(one).parent) for one in (mqtt.__file__, aiomqtt.__file__, paho.mqtt.__file__)
    )
    lines = 0

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        nonlocal lines
        lines += event == "line"
        return trace if frame.f_code.co_filename.startswith(ours) else None

    async def run(broker: HandBroker) -> None:
        outlet = _outlet(broker, ticks)
        _offer(outlet, 1, ticks)
        before = sys.gettrace()
        sys.settrace(trace)
        running = asyncio.create_task(outlet.run())
        try:
            await _until(lambda: outlet.status().carried == ticks)
        finally:
            sys.settrace(before)
        running.cancel()

    with HandBroker() as broker:
        asyncio.run(run(broker))
    return lines / ticks
