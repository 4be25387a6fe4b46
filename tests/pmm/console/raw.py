"""What goes over a socket byte by byte, as a browser sends it or as no browser would."""

import json
import socket
from dataclasses import dataclass

SESSION = "0123456789abcdef"
WITHIN_S = 60.0


@dataclass(frozen=True)
class Address:
    """Where a console listens."""

    host: str
    port: int

    @property
    def name(self) -> str:
        """Host and port."""
        return f"{self.host}:{self.port}"

    def connect(self) -> socket.socket:
        """Open a connection."""
        return socket.create_connection((self.host, self.port), timeout=WITHIN_S)

    def post(self, path: str, body: object, *, session: str = SESSION, cookie: str = "") -> bytes:
        """Return the bytes of a request as the page sends it."""
        text = json.dumps(body).encode()
        return (
            f"POST {path} HTTP/1.1\r\nhost: {self.name}\r\norigin: http://{self.name}\r\n"
            f"x-pmm-session: {session}\r\ncookie: {cookie}\r\ncontent-length: {len(text)}\r\n\r\n"
        ).encode() + text

    def ask(self, request: bytes) -> tuple[int, str]:
        """Send a request on a connection of its own; return the status and the answer's body."""
        with self.connect() as one:
            one.sendall(request)
            return answer(one)


def address_of(url: str) -> Address:
    """Return host and port of ``http://host:port/``."""
    host, port = url.rstrip("/").rsplit("/", 1)[1].rsplit(":", 1)
    return Address(host, int(port))


def answer(one: socket.socket) -> tuple[int, str]:
    """Return the status of the next answer and its body; 0 where the connection ends without."""
    with one.makefile("rb") as lines:
        first = lines.readline().split()
        length = 0
        while (line := lines.readline().strip()) != b"":
            name, _, value = line.partition(b":")
            length = int(value) if name.lower() == b"content-length" else length
        body = lines.read(length).decode()
    return (int(first[1]), body) if first else (0, "")
