"""The crowd before a console: pages as light sockets, half-sent requests, and a plan to be checked.

``python -m benchmarks.crowd_sockets PORT PAGES HALVES``; it says "ready" when all pages are open,
and ends with its standard input.
"""

import asyncio
import json
import sys
from contextlib import suppress
from typing import Final

from benchmarks.console_source import plan_of_many

_AGAIN_S: Final = 1.0  # until whoever was refused comes again
_HOST: Final = "127.0.0.1"
_PING, _PONG = 0x89, 0x8A


async def _page(port: int, number: int, ready: asyncio.Semaphore) -> None:
    """Take pictures and answer pings, for ever."""
    reader, writer = await asyncio.open_connection(_HOST, port)
    writer.write(
        f"GET /stream?session={number:032d} HTTP/1.1\r\nhost: {_HOST}:{port}\r\n"
        f"origin: http://{_HOST}:{port}\r\nupgrade: websocket\r\nconnection: upgrade\r\n"
        "sec-websocket-version: 13\r\nsec-websocket-key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n".encode()
    )
    answer = await reader.readuntil(b"\r\n\r\n")
    if b" 101 " not in answer:
        raise RuntimeError(answer)
    ready.release()
    while True:
        kind, length = await reader.readexactly(2)
        if length >= 126:
            length = int.from_bytes(await reader.readexactly(2 if length == 126 else 8), "big")
        payload = await reader.readexactly(length)
        if kind == _PING:
            writer.write(bytes((_PONG, 0x80 | length, 0, 0, 0, 0)) + payload)


async def _half(port: int) -> None:
    """Send half a request, and again when it is refused."""
    while True:
        reader, writer = await asyncio.open_connection(_HOST, port)
        writer.write(b"POST /api/command HTTP/1.1\r\nhost: ")
        with suppress(OSError):
            await reader.read()
        writer.close()
        await asyncio.sleep(_AGAIN_S)


async def _check(port: int) -> None:
    """Let a plan be checked, one time after the other."""
    body = json.dumps({"text": plan_of_many()}).encode()
    head = (
        f"POST /api/plans/check HTTP/1.1\r\nhost: {_HOST}:{port}\r\n"
        f"origin: http://{_HOST}:{port}\r\nconnection: close\r\ncontent-length: {len(body)}\r\n\r\n"
    )
    while True:
        reader, writer = await asyncio.open_connection(_HOST, port, limit=1 << 24)
        writer.write(head.encode() + body)
        status = (await reader.readline()).split()[1:2]
        await reader.read()
        writer.close()
        if status != [b"200"]:
            await asyncio.sleep(_AGAIN_S)


async def main(port: int, pages: int, halves: int) -> None:
    """Crowd until the standard input ends."""
    ready = asyncio.Semaphore(0)
    work = [_page(port, number, ready) for number in range(pages)]
    tasks = [asyncio.ensure_future(one) for one in work]
    for _ in range(pages):
        await ready.acquire()
    rest = [_half(port) for _ in range(halves)] + ([_check(port)] if halves else [])
    tasks += [asyncio.ensure_future(one) for one in rest]
    print("ready", flush=True)
    await asyncio.to_thread(sys.stdin.read)
    lost = [one.exception() for one in tasks if one.done()]
    print(len(lost), *{repr(one) for one in lost}, flush=True)
    for one in tasks:
        one.cancel()


if __name__ == "__main__":
    asyncio.run(main(*map(int, sys.argv[1:4])))
