"""A page that takes nothing for long is let go of, and one that is only slow is not."""

import asyncio
from typing import Any

import pytest
from uvicorn import Config
from uvicorn.server import ServerState

from pmm.console import connections


class Transport:
    """Notes that it was ended."""

    def __init__(self) -> None:
        self.ended = asyncio.Event()

    def get_extra_info(self, _name: str) -> Any:
        return None

    def abort(self) -> None:
        self.ended.set()


async def _app(scope: Any, receive: Any, send: Any) -> None:
    raise AssertionError("nobody asks")


@pytest.mark.parametrize("slow", [False, True])
def test_a_full_stream_is_ended_unless_something_is_taken(
    monkeypatch: pytest.MonkeyPatch, slow: bool
) -> None:
    monkeypatch.setattr(connections, "SLOW_S", 0.01)

    async def act() -> bool:
        one = connections.PageStream(config=Config(_app), server_state=ServerState(), app_state={})
        transport = Transport()
        one.connection_made(transport)  # type: ignore[arg-type]
        one.pause_writing()
        if slow:
            one.resume_writing()
            await asyncio.sleep(0.1)
        else:
            await asyncio.wait_for(transport.ended.wait(), 60.0)
        return transport.ended.is_set()

    assert asyncio.run(act()) is not slow
