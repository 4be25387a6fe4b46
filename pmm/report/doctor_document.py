"""What ``pmm doctor`` shows: what was found of the machine, with the cure of each fault."""

from collections.abc import Sequence
from typing import Final

from pmm.doctor.findings import MachineFinding, MachineStatus
from pmm.document.content import Column, Data, Document, Note, Section, Table, Text, data_only, word
from pmm.document.notation import counted

SCHEMA: Final = "pmm-doctor-1"
_FINDINGS: Final[tuple[Column[MachineFinding], ...]] = (
    Column("area", lambda finding: finding.area, "area", once=True),
    word("what", "what"),
    word("", "status"),
    Column(
        "found",
        lambda finding: f"{finding.found}\n-> {finding.cure}" if finding.cure else finding.found,
    ),
    *data_only("found", "cure"),
)


def doctor_document(findings: Sequence[MachineFinding]) -> Document:
    """Return what was found of a machine."""
    faults = sum(finding.status is MachineStatus.FAULT for finding in findings)
    contents = (
        Table("Findings", _FINDINGS, findings, "findings", grade=_grade),
        Text((counted(faults, "fault") if faults else "no fault",)),
        Data("faults", faults),
    )
    return Document("", "what was found of the machine", (Section("", contents),), SCHEMA)


def _grade(finding: MachineFinding) -> str:
    return "" if finding.status is MachineStatus.OK else Note(finding.status, "").grade
