"""Wrong tokens: counted by address, slower each time, and no page that is logged in is touched."""

import json
import socket
import threading
from http.client import HTTPConnection
from pathlib import Path
from typing import TYPE_CHECKING, cast

import pytest
import uvicorn
from hypothesis import given
from hypothesis import strategies as st
from starlette.types import Receive, Scope, Send

from pmm.console import lockout
from pmm.console.audit import COMMANDS
from pmm.console.limits import LONGEST_LOCKOUT_S, MOST_ADDRESSES, WRONG_TOKENS
from pmm.console.lockout import Lockout
from pmm.console.session import _configuration
from tests.pmm.console.chromium import console, rig_in
from tests.pmm.console.raw import address_of
from tests.pmm.console.serving import served

if TYPE_CHECKING:
    from pmm.console.security import Guard

TOKEN = "a token of more than sixteen"  # noqa: S105 - the test's own


class Clock:
    """Stands until it is moved."""

    now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


def test_each_wrong_token_doubles_the_wait_up_to_the_longest() -> None:
    clock = Clock()
    one = Lockout(clock)
    waits = []
    for _ in range(40):
        one.count_wrong("10.0.0.7")
        waits.append(one.wait_s("10.0.0.7"))
        clock.now_s += waits[-1]
    doubled = [2.0**k for k in range(40)]
    free = WRONG_TOKENS - 1
    assert waits[:free] == [0.0] * free
    assert waits[free:] == [min(wait, LONGEST_LOCKOUT_S) for wait in doubled][: 40 - free]
    assert one.wait_s("10.0.0.8") == 0.0
    one.forget_wrong("10.0.0.7")
    assert one.wait_s("10.0.0.7") == 0.0


@given(st.integers(0, 2**64 - 1), st.integers(0, 2**64 - 1))
def test_the_addresses_of_one_network_are_one(first: int, second: int) -> None:
    one = Lockout(Clock())
    for host in (first, second) * WRONG_TOKENS:
        parts = [f"{host >> shift & 0xFFFF:x}" for shift in (48, 32, 16, 0)]
        one.count_wrong("2001:db8:0:1:" + ":".join(parts))
    assert one.wait_s("2001:db8:0:1::1") > 0.0
    assert one.wait_s("2001:db8:0:2::1") == 0.0


def test_what_is_remembered_is_bounded() -> None:
    one = Lockout(Clock())
    for number in range(3 * MOST_ADDRESSES):
        for _ in range(WRONG_TOKENS):
            one.count_wrong(f"10.{number >> 16}.{number >> 8 & 255}.{number & 255}")
    assert len(one._counts) == MOST_ADDRESSES


def test_a_page_that_is_logged_in_stops_quickly_while_its_address_is_shut_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(lockout, "_FIRST_S", 800.0)  # longer than any machine needs for this test
    remote = "http://rig.tank.example:8063"
    with served(tmp_path, token=TOKEN, host="0.0.0.0", origin=remote) as one:  # noqa: S104
        assert one.post("/login", {"token": TOKEN})[0] == 200
        found = [one.post("/login", {"token": f"{TOKEN}{k}"}) for k in range(3 * WRONG_TOKENS)]
        assert [status for status, _ in found] == [401] * WRONG_TOKENS + [429] * 2 * WRONG_TOKENS
        assert "wait 800 s" in str(found[-1][1]["error"])
        assert one.post("/login", {"token": TOKEN})[0] == 429
        assert one.post("/api/command", {"command": "quick stop"})[0] == 200
        assert one.orders[-1].text == "quick stop"
    text = (tmp_path / COMMANDS).read_text(encoding="utf-8")
    lines = [json.loads(line) for line in text.splitlines()]
    wrong = [line for line in lines if line["action"] == "log in" and not line["taken"]]
    assert len(wrong) == WRONG_TOKENS
    assert wrong[-1]["said"] == f"wrong token, number {WRONG_TOKENS} from 127.0.0.1; it waits 800 s"
    assert {line["address"] for line in wrong} == {"127.0.0.1"}
    assert TOKEN not in text


def test_the_address_is_that_of_the_connection_whatever_a_header_says() -> None:
    async def page(scope: Scope, _: Receive, send: Send) -> None:
        if scope["type"] == "http":
            await send({"type": "http.response.start", "status": 200, "headers": []})
            await send({"type": "http.response.body", "body": scope["client"][0].encode()})

    listening = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(_configuration(cast("Guard", page), None, None))
    thread = threading.Thread(target=server.run, args=([listening],))
    thread.start()
    try:
        asker = HTTPConnection(*listening.getsockname(), timeout=60.0)
        headers = {"x-forwarded-for": "192.168.1.7", "x-forwarded-proto": "https"}
        asker.request("GET", "/", headers=headers)
        assert asker.getresponse().read() == b"127.0.0.1"
        asker.close()
    finally:
        server.should_exit = True
        thread.join(60.0)
        listening.close()


@pytest.mark.slow
def test_plain_http_beyond_the_machine_is_warned_of(tmp_path: Path) -> None:
    token = tmp_path / "token"
    token.write_text(TOKEN, encoding="utf-8")
    rig = rig_in(tmp_path / "rig")
    options = ("--host", "127.0.0.2", "--token-file", str(token), "--speed", "4")
    with console(rig, tmp_path / "out", *options) as far:
        port = address_of(far.address).port
    assert "warning: --host 127.0.0.2 without --certificate" in far.said
    assert f"ssh -L {port}:127.0.0.1:{port} USER@THIS-MACHINE" in " ".join(far.said.split())
