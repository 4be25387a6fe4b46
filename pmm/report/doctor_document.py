"""What ``pmm doctor`` shows: what was found of the machine, with the cure of each fault."""

from collections.abc import Sequence
from typing import Final

from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.document.content import Column, Data, Document, Note, Section, Table, Text, data_only, word
from pmm.document.notation import counted

SCHEMA: Final = "pmm-doctor-1"
_FINDINGS: Final[tuple[Column[MachineFinding], ...]] = (
    Column("area", lambda one: one.area, "area", once=True),
    word("what", "what"),
    word("", "status"),
    Column("found", lambda one: f"{one.found}\n-> {one.cure}" if one.cure else one.found),
    *data_only("found", "cure"),
)


def doctor_document(found: Sequence[MachineFinding]) -> Document:
    """Return what was found of a machine."""
    faults = sum(one.status is MachineStatus.FAULT for one in found)
    told = (
        Table("Findings", _FINDINGS, found, "findings", grade=_grade),
        Text((counted(faults, "fault") if faults else "no fault",)),
        Data("faults", faults),
    )
    return Document("", "what was found of the machine", (Section("", told),), SCHEMA)


def _grade(one: MachineFinding) -> str:
    return "" if one.status is MachineStatus.OK else Note(one.status, "").grade
