"""What ``pmm gap CAMPAIGN`` prints: three plain sentences, then what they rest on."""

from typing import TYPE_CHECKING

from pmm.cli.sections import print_sections
from pmm.gap.report import GapReport
from pmm.gap.sections import sections

if TYPE_CHECKING:
    from rich.console import Console


def print_report(console: "Console", report: GapReport) -> None:
    """Print a diagnosis for people."""
    wrong, *others = report.said
    for line in (f"{report.campaign}: {wrong}", *others):
        console.print(line, style="bold", soft_wrap=True)
    console.print(f"\n{report.used}", soft_wrap=True)
    for name, reason in report.left_out.items():
        console.print(f"LEFT OUT {name}: {reason}", soft_wrap=True)
    for note in report.notes:
        console.print(f"NOTE     {note}", soft_wrap=True)
    print_sections(console, sections(report))
