"""What was noticed about a recording or a result, kept with it."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, Final

DAMAGED: Final = "damaged"  # a file is not what was written


class Severity(StrEnum):
    """How much a flag matters."""

    NOTE = "note"  # said for the record; the numbers stand
    WARNING = "warning"  # the numbers stand within what the message says
    VOID = "void"  # part of the data could not be used


@dataclass(frozen=True)
class Flag:
    """One finding: a stable ``code``, how much it matters, and a message with value and limit.

    Attributes
    ----------
    runs
        Names of the runs that it is about, where several are at hand.
    """

    code: str
    severity: Severity
    message: str
    channel: str | None = None
    runs: tuple[str, ...] = ()

    @property
    def damaged(self) -> bool:
        """Whether it says that a file is not what was written."""
        return self.code == DAMAGED

    @classmethod
    def read(cls, table: Mapping[str, Any]) -> "Flag":
        """Return a flag that a file holds as a table of its fields; older files name no runs."""
        fields = {"runs": (), **table}
        return cls(
            **{**fields, "severity": Severity(fields["severity"]), "runs": tuple(fields["runs"])}
        )

    def of(self, *runs: str) -> "Flag":
        """Return the flag with its runs named; one that names its own keeps them."""
        return self if self.runs else replace(self, runs=runs)
