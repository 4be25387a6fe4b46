"""A browser that does not keep up: what waits is bounded, and a snapshot replaces what was lost."""

import asyncio

from pmm.console.client import WAITING, Client
from pmm.console.desk import Desk, Holder


def _client() -> Client:
    return Client("s", lambda session: f"snapshot for {session}")


async def _taken(client: Client, count: int) -> list[str]:
    return [await client.next() for _ in range(count)]


def test_begins_with_a_snapshot_and_then_gets_every_message() -> None:
    client = _client()
    client.offer("before")
    first = asyncio.run(_taken(client, 1))
    client.offer("a")
    client.offer("b")
    assert first + asyncio.run(_taken(client, 2)) == ["snapshot for s", "a", "b"]


def test_a_slow_browser_gets_a_snapshot_instead_of_a_long_queue() -> None:
    client = _client()
    asyncio.run(_taken(client, 1))
    for number in range(1000):
        client.offer(str(number))
    assert len(client._waiting) <= WAITING
    assert client.dropped == 1000
    assert asyncio.run(_taken(client, 1)) == ["snapshot for s"]
    client.offer("later")
    assert asyncio.run(_taken(client, 1)) == ["later"]


def test_control_stays_with_the_first_until_it_is_taken() -> None:
    desk = Desk()
    assert desk.seen_from("a") is Holder.NOBODY
    desk.arrive("a")
    desk.arrive("b")
    assert (desk.seen_from("a"), desk.seen_from("b")) == (Holder.YOU, Holder.OTHER)
    desk.take_over("b")
    assert (desk.seen_from("a"), desk.seen_from("b")) == (Holder.OTHER, Holder.YOU)
