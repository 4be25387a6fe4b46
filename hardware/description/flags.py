"""What was noticed about a recording or a result, kept with it."""

from dataclasses import dataclass
from enum import StrEnum


class Severity(StrEnum):
    """How much a flag matters."""

    NOTE = "note"  # said for the record; the numbers stand
    WARNING = "warning"  # the numbers stand within what the message says
    VOID = "void"  # part of the data could not be used


@dataclass(frozen=True)
class Flag:
    """One finding: a stable ``code``, how much it matters, and a message with value and limit."""

    code: str
    severity: Severity
    message: str
    channel: str | None = None
