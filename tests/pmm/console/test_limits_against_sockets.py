"""What comes over the network is limited: a console in its own process, and sockets by hand."""

import re
import socket
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from pathlib import Path

import pytest
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from pmm.console import limits
from pmm.console.limits import MOST_HALF_SENT, MOST_STREAMS, REQUEST_S, YOUNG_S
from tests.pmm.console.chromium import console, rig_in
from tests.pmm.console.raw import SESSION, Address, address_of, answer
from tests.pmm.console.serving import OWN, served

DOCS = Path(__file__).parents[3] / "docs" / "console.md"
STOP = {"command": "quick stop"}


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Address]:
    folder = tmp_path_factory.mktemp("console")
    with console(rig_in(folder / "rig"), folder / "out") as one:
        yield address_of(one.address)


def _read_to_the_end(stream: WebSocketTestSession) -> None:
    while True:
        stream.receive_json()


@pytest.mark.parametrize("message", [b"\x00\xff", "start"])
def test_a_message_on_the_stream_is_refused_with_a_sentence(
    tmp_path: Path, message: bytes | str
) -> None:
    with served(tmp_path) as one:

        def stream() -> WebSocketTestSession:
            path = f"{one.stream}?session={SESSION}"
            return one.browser.websocket_connect(path, headers={"origin": OWN})

        with stream() as first:
            (first.send_text if isinstance(message, str) else first.send_bytes)(message)
            with pytest.raises(WebSocketDisconnect) as refused:
                _read_to_the_end(first)
        assert refused.value.code == 1003
        assert refused.value.reason == "nothing is taken on this stream; commands are posted"
        with stream() as second:
            assert second.receive_json()["type"] == "snapshot"


@pytest.mark.slow
def test_half_sent_requests_are_few_and_end_and_a_quick_stop_passes_them(address: Address) -> None:
    with ExitStack() as held:
        whole = address.post("/api/command", STOP)
        halves = (b"", b"POST /api/comm", whole[: whole.index(b"\r\n\r\n")], whole[:-3])
        assert address.ask(whole)[0] == 200  # it serves: nobody has waited for that
        half = [held.enter_context(address.connect()) for _ in range(2 * MOST_HALF_SENT)]
        for number, one in enumerate(half):
            one.sendall(halves[number % len(halves)])
        time.sleep(1.5 * YOUNG_S)
        assert address.ask(whole)[0] == 200
        _trickle_until_it_is_ended(held.enter_context(address.connect()))
        first, last = answer(half[0]), answer(half[-1])
        assert first[0] == last[0] == 408
        assert f"more than {MOST_HALF_SENT} requests are half sent" in first[1]
        assert f"not complete after {REQUEST_S:g} s" in last[1]


def _trickle_until_it_is_ended(one: socket.socket) -> None:
    """Send a request that never stands still: it is ended as the others are."""
    one.sendall(b"POST /api/command HTTP/1.1\r\nx: ")
    one.settimeout(REQUEST_S / 20.0)
    for _ in range(1000):
        with suppress(TimeoutError):
            assert one.recv(12) == b"HTTP/1.1 408"
            return
        one.sendall(b"x")
    raise AssertionError("the request goes on for ever")


@pytest.mark.slow
def test_one_page_more_than_the_limit_is_told_so(tmp_path: Path) -> None:
    with served(tmp_path) as one, ExitStack() as held:

        def stream(session: str) -> WebSocketTestSession:
            path = f"{one.stream}?session={session}"
            return held.enter_context(one.browser.websocket_connect(path, headers={"origin": OWN}))

        first, *_ = [stream(f"{number:032d}") for number in range(MOST_STREAMS)]
        with pytest.raises(WebSocketDisconnect) as refused:
            stream(SESSION).receive_json()
        assert refused.value.code == 1013
        assert f"{MOST_STREAMS} pages are open" in refused.value.reason
        assert one.post("/api/command", STOP)[0] == 200
        first.close()
        assert stream(f"{0:032d}").receive_json()["type"] == "snapshot"  # it has control


@pytest.mark.slow
def test_every_limit_is_in_the_one_table() -> None:
    rows = re.findall(r"^\| `([A-Z_]+)` \| ([0-9.]+)( KiB| MiB| s|) \|", DOCS.read_text(), re.M)
    factors = {" KiB": 1 << 10, " MiB": 1 << 20}
    found = {name: float(value) * factors.get(unit, 1) for name, value, unit in rows}
    assert found == {name: value for name, value in vars(limits).items() if name.isupper()}
