"""HTTPS and WSS beyond this machine: another loopback address, a token, a certificate."""

import json
import ssl
import time
from collections.abc import Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from http.client import BadStatusLine, HTTPConnection, HTTPSConnection
from socket import create_connection, socket

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import ClientConnection, connect

from pmm.console.limits import MOST_HALF_SENT, REQUEST_S, YOUNG_S
from tests.pmm.console import certificates
from tests.pmm.console.chromium import Browser, console, needed, plan, rig_in

pytestmark = certificates.needed
HOST = "127.0.0.2"
TOKEN = "a long and secret token"  # noqa: S105 - the test's own
SESSION = "0123456789abcdef"


@dataclass
class Remote:
    """A console that is reached over TLS."""

    address: str
    trusted: ssl.SSLContext

    @property
    def port(self) -> int:
        """Where it listens."""
        return int(self.address.rstrip("/").rsplit(":", 1)[1])

    @property
    def origin(self) -> str:
        """What its own page calls itself."""
        return self.address.rstrip("/")

    def post(self, path: str, body: object, cookie: str = "") -> tuple[int, str]:
        """Post as the page does; return the status and the cookie that is given."""
        given = {"origin": self.origin, "cookie": cookie, "x-pmm-session": SESSION}
        asking = HTTPSConnection(HOST, self.port, context=self.trusted, timeout=60.0)
        try:
            asking.request("POST", path, json.dumps(body), given)
            answer = asking.getresponse()
            answer.read()
            return answer.status, answer.getheader("set-cookie") or ""
        finally:
            asking.close()

    def stream(self, cookie: str = "") -> ClientConnection:
        """Open the stream of frames."""
        return connect(
            f"wss://{HOST}:{self.port}/stream?session={SESSION}",
            ssl=self.trusted,
            origin=self.origin,  # type: ignore[arg-type]
            additional_headers={"cookie": cookie},
            max_size=None,
        )


@pytest.fixture(scope="module")
def remote(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Remote]:
    folder = tmp_path_factory.mktemp("remote")
    certificate, key = certificates.self_signed(folder, HOST)
    token = folder / "token"
    token.write_text(TOKEN)
    options = ("--host", HOST, "--token-file", str(token))
    options += ("--certificate", str(certificate), "--key", str(key))
    with console(rig_in(folder / "rig"), folder / "out", *options) as one:
        yield Remote(one.address, ssl.create_default_context(cafile=str(certificate)))


@pytest.mark.slow
def test_token_cookie_and_frames_go_through_tls_alone(remote: Remote) -> None:
    assert remote.address.startswith(f"https://{HOST}:")
    quick = {"command": "quick stop"}
    assert remote.post("/api/command", quick)[0] == 401
    assert remote.post("/login", {"token": "a wrong and guessed token"}) == (401, "")
    with pytest.raises(InvalidStatus) as refused:
        remote.stream()
    assert refused.value.response.status_code == 403
    status, given = remote.post("/login", {"token": TOKEN})
    assert status == 200
    assert "secure" in given.lower()
    assert "httponly" in given.lower()
    cookie = given.split(";")[0]
    assert remote.post("/api/command", quick, cookie + "x")[0] == 401
    with remote.stream(cookie) as frames:
        assert json.loads(frames.recv(timeout=60.0))["type"] == "snapshot"
        kinds = {json.loads(frames.recv(timeout=60.0))["type"] for _ in range(20)}
        assert "frame" in kinds
        assert remote.post("/api/plans/queue", {"text": plan("tls")}, cookie)[0] == 200


def test_whoever_does_not_know_the_certificate_or_speaks_plainly_gets_nothing(
    remote: Remote,
) -> None:
    stranger = HTTPSConnection(
        HOST, remote.port, context=ssl.create_default_context(), timeout=60.0
    )
    with pytest.raises(ssl.SSLCertVerificationError):
        stranger.request("GET", "/login")
    stranger.close()
    plain = HTTPConnection(HOST, remote.port, timeout=60.0)
    try:
        plain.request("GET", "/login")
        with pytest.raises((ConnectionError, BadStatusLine)):
            plain.getresponse()
    finally:
        plain.close()


@pytest.mark.slow
def test_handshakes_that_stand_still_are_few_and_end_and_a_quick_stop_passes_them(
    remote: Remote,
) -> None:
    with ExitStack() as held:
        cookie = remote.post("/login", {"token": TOKEN})[1].split(";")[0]
        half = [_opened(held, remote) for _ in range(2 * MOST_HALF_SENT)]
        half[1].sendall(b"\x16\x03\x01")  # a hello that goes no further
        time.sleep(1.5 * YOUNG_S)
        half.append(_opened(held, remote))
        ends = [_end_s(each) for each in half[:2]]
        assert remote.post("/api/command", {"command": "quick stop"}, cookie)[0] == 200
        assert _end_s(half[-1]) - max(ends) > REQUEST_S / 2.0  # the oldest alone gave way


def _opened(held: ExitStack, remote: Remote) -> socket:
    return held.enter_context(create_connection((HOST, remote.port), timeout=60.0))


def _end_s(half: socket) -> float:
    with suppress(ConnectionResetError):
        assert half.recv(1) == b""
    return time.monotonic()


@pytest.mark.slow
@needed
def test_the_page_logs_in_and_draws_over_tls(remote: Remote, chromium: Browser) -> None:
    with chromium.window() as page:
        page.driver.get(remote.address)
        assert page.driver.current_url == f"{remote.address}login"
        page.find("#token").send_keys("a wrong and guessed token")
        page.find("#login button").click()
        page.until(lambda: "not the token" in page.text("#login-said"), "refusal")
        page.find("#token").clear()
        page.find("#token").send_keys(TOKEN)
        page.find("#login button").click()
        page.until(lambda: page.text("#state-name").endswith("idle"), "console")
        page.until(lambda: int(page.run("return pmmFrames()")) > 25, "a second's frames")
