"""A drive panel asked by lines of text, one at a time, without ever waiting."""

from abc import abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from hardware.asked_link import READ, WRITE, Answer, AskedSettings, PortLink, RegisterRequest
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.driver import Services
from hardware.errors import LineError
from hardware.line_registers import Ending, Line, LineCommand, LineNumber, LineStatus
from hardware.port_lines import LineSplitter, Splitter
from hardware.serial_port import PortSettings

_UNKNOWN: Final = -1  # address of what a log has, and nobody asked


@dataclass(frozen=True)
class LinePortSettings(PortSettings):
    """How to open a port to a panel; ``ending`` closes lines and replies."""

    baud_rate: int = 9600
    ending: Ending = "\r\n"

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def splitter(self, name: str) -> Splitter:
        """Return what makes exchanges of bytes."""
        return LineExchanges(name, self.ending.encode())


class LineExchanges:
    """Finds the reply to the line that was sent last: both, with a tab between, for the log."""

    def __init__(self, name: str, ending: bytes) -> None:
        self._ending, self._asked = ending, b""
        self._replies = LineSplitter(name, ending, "; check port.ending")

    def sent(self, data: bytes) -> None:
        """Take a line; what is left of a reply to another one is forgotten."""
        self._asked = data.removesuffix(self._ending)
        self._replies.forget()

    def split(self, data: bytes) -> list[bytes]:
        """Return the exchange that bytes complete; an echo of the line is left out.

        Raises
        ------
        LineError
            If so much has come without an ending that it cannot be a reply.
        """
        lines = self._replies.split(data)
        said = [line for line in lines if line.strip() != self._asked.strip()]
        return [self._asked + b"\t" + line for line in said[-1:]]


@dataclass(frozen=True, kw_only=True)
class LineSettings(AskedSettings):
    """How a panel is reached."""

    port: LinePortSettings

    @property
    def is_numbered(self) -> bool:
        """Whether a reply says which line it belongs to: it does not."""
        return False

    @property
    @abstractmethod
    def every_line(self) -> tuple[Line, ...]:
        """All that it is asked and told, each with an address of its own."""

    def link(self, name: str, services: Services) -> "LineLink":
        """Return what asks it."""
        return LineLink(name, self, services)


class LineLink(PortLink):
    """A link to a panel that is asked and told in lines of text."""

    def __init__(self, name: str, settings: LineSettings, services: Services) -> None:
        self._lines = {line.address: line for line in settings.every_line}
        self._ending = settings.port.ending
        self._sent: dict[str, RegisterRequest] = {}
        super().__init__(name, settings, services.port(name, settings.port))

    def _frame(self, request: RegisterRequest) -> bytes:
        text = self._lines[request.address].text(request.words)
        self._sent[text] = request
        return (text + self._ending).encode()

    def _answers_in(self, line: bytes) -> Iterator[Answer]:
        asked, _, said = line.decode("ascii", "replace").partition("\t")
        query = next((query for query in self._reads() if query.text(()) == asked), None)
        if query is None:  # what was told: the reply alone counts
            request = self._sent.get(asked, RegisterRequest(WRITE, _UNKNOWN))
            set_line = self._lines.get(request.address)
            if set_line is not None and set_line.words(said) is None:
                raise self._unexpected(asked, said)
            yield request, request.words
            return
        words = query.words(said)
        if words is None:
            raise self._unexpected(asked, said)
        yield RegisterRequest(READ[query.table], query.address, query.count), words

    def _reads(self) -> Iterator[LineNumber | LineStatus]:
        for line in self._lines.values():
            if not isinstance(line, LineCommand) and not is_told(line):
                yield line

    def _unexpected(self, asked: str, said: str) -> LineError:
        return LineError(
            self.name, f"{said!r} is no answer to {asked!r}; correct line or answer of its table"
        )


def is_told(line: Line) -> bool:
    """Whether a line of text sets something, and does not ask."""
    return isinstance(line, LineCommand) or "{value" in getattr(line, "line", "")
