"""What of a web request is taken: who sends it, and a body that is not too large."""

from dataclasses import dataclass
from typing import Final

from starlette.requests import HTTPConnection, Request

from hardware.description.errors import PmmError
from pmm.console.limits import LARGEST_REQUEST
from pmm.console.security import VISITOR, Visitor

SESSION: Final = "x-pmm-session"


@dataclass(frozen=True)
class Requester:
    """The session, address and rights of whoever sends a request."""

    session: str
    address: str
    visitor: Visitor


def who_asks(request: HTTPConnection) -> Requester:
    """Return session, address and rights of a request; the address ``?`` if not known."""
    address = request.client.host if request.client is not None else "?"
    return Requester(request.headers.get(SESSION, ""), address, request.scope[VISITOR])


class TooLargeError(PmmError):
    """A request that is larger than any of its kind."""


async def body_of(request: Request, largest: int = LARGEST_REQUEST) -> bytes:
    """Read a body that is not larger than so many bytes.

    Raises
    ------
    TooLargeError
        If it is.
    """
    body = bytearray()
    async for part in request.stream():
        body += part
        if len(body) > largest:
            raise TooLargeError(f"the request is larger than {largest} bytes")
    return bytes(body)
