"""What a check found."""

from dataclasses import dataclass
from enum import StrEnum


class MachineStatus(StrEnum):
    """How much a finding matters."""

    OK = "ok"
    NOTE = "note"  # nothing is wrong, but something can be had
    WARNING = "warning"  # it works, not as well as it could
    FAULT = "fault"  # something that was asked for cannot work


@dataclass(frozen=True)
class MachineFinding:
    """One thing that was looked at.

    Attributes
    ----------
    what
        Of the machine: ``"serial port /dev/ttyUSB0"``.
    found
        The value, with its limit where it has one.
    cure
        What to do; empty where nothing is to be done.
    """

    area: str
    what: str
    status: MachineStatus
    found: str
    cure: str = ""
