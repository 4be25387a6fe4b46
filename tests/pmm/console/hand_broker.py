"""An MQTT broker by hand, as slow as a test wants it: it keeps numbers and hands nothing on."""

import json
import socket
import threading
from collections import deque
from types import TracebackType
from typing import Any

_CONNECT, _PUBLISH, _PING = 1, 3, 12
_CONNACK, _PONG, _ACKNOWLEDGED = b"\x20\x02\x00\x00", b"\xd0\x00", b"\x40\x02"


class HandBroker:
    """Answers one connection after the other.

    Attributes
    ----------
    numbers, came
        Of the ticks that it has acknowledged, in their order; of those that reached it.
    told
        The latest message of each topic.
    reading
        Cleared: it takes no byte more until it is set.
    wait_s
        Before each acknowledgement.
    behind
        Ticks that it has not acknowledged when it acknowledges the one before them.
    """

    def __init__(self) -> None:
        self.numbers: list[int] = []
        self.came: list[int] = []
        self.told: dict[str, dict[str, Any]] = {}
        self.connections = 0
        self.reading = threading.Event()
        self.reading.set()
        self.wait_s = 0.0
        self.behind = 0
        self._waiting = deque[tuple[bytes, int]]()
        self._end = threading.Event()
        self._server = socket.create_server(("127.0.0.1", 0))
        self._server.settimeout(0.02)
        self.port = int(self._server.getsockname()[1])
        self._thread = threading.Thread(target=self._serve, name="broker by hand")

    def __enter__(self) -> "HandBroker":
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        self._end.set()
        self.reading.set()
        self._thread.join()
        self._server.close()

    def _serve(self) -> None:
        while not self._end.is_set():
            try:
                one, _ = self._server.accept()
            except TimeoutError:
                continue
            self.connections += 1
            self._waiting.clear()
            one.settimeout(0.02)
            with one:
                try:
                    while self._answer(one):
                        pass
                except OSError:  # the other side has gone
                    continue

    def _answer(self, one: socket.socket) -> bool:
        """Answer a packet; return whether another may come."""
        kind = self._bytes(one, 1)[0] >> 4
        body = self._bytes(one, self._length(one))
        if kind == _CONNECT:
            one.sendall(_CONNACK)
        elif kind == _PING:
            one.sendall(_PONG)
        elif kind == _PUBLISH:
            self._take(one, body)
        return not self._end.is_set()

    def _take(self, one: socket.socket, body: bytes) -> None:
        end = 2 + int.from_bytes(body[:2], "big")
        self._end.wait(self.wait_s)
        topic, content = body[2:end].decode(), json.loads(body[end + 2 :])
        self.told[topic] = content
        if not topic.endswith("/live"):
            one.sendall(_ACKNOWLEDGED + body[end : end + 2])
            return
        self.came.append(content["n"])
        self._waiting.append((body[end : end + 2], content["n"]))
        while len(self._waiting) > self.behind:
            name, number = self._waiting.popleft()
            one.sendall(_ACKNOWLEDGED + name)
            self.numbers.append(number)

    def _length(self, one: socket.socket) -> int:
        length, shift = 0, 0
        while True:
            (byte,) = self._bytes(one, 1)
            length |= (byte & 0x7F) << shift
            shift += 7
            if byte < 0x80:
                return length

    def _bytes(self, one: socket.socket, count: int) -> bytes:
        """Return so many bytes.

        Raises
        ------
        ConnectionError
            If the other side, or the test, ends before.
        """
        got = b""
        while len(got) < count and not self._end.is_set():
            self.reading.wait()
            try:
                part = one.recv(count - len(got))
            except TimeoutError:
                continue
            if not part:
                break
            got += part
        if len(got) < count:
            raise ConnectionError
        return got
