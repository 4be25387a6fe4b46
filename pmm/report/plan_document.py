"""What ``pmm plan`` shows: what a check found, and the runs in their order."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import accumulate, groupby
from typing import Any, Final

from hardware.description.kinds import RunKind
from pmm.document.content import (
    Column,
    Data,
    Document,
    Note,
    Notes,
    Section,
    Table,
    Text,
    number,
    word,
)
from pmm.document.notation import clock, counted, written
from pmm.plan.duration import duration_rows, tank_length_m
from pmm.plan.findings import PlanFinding, PlanVerdict, largest_stated
from pmm.plan.force_estimate import force_peak_n
from pmm.plan.motion_peaks import acceleration_peak_m_s2, velocity_peak_m_s
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

CHECK_SCHEMA: Final = "pmm-plan-check-1"
SHOW_SCHEMA: Final = "pmm-plan-1"
_CONDITIONS: Final = (
    word("condition", "quantity"),
    number("largest", "value", written(".4g")),
    number("limit", "limit", lambda limit: f"{limit:.4g}" if math.isfinite(limit) else "none"),
    word("source", "source"),
    word("in run", "run"),
)


def check_document(
    plan: Plan, rig: RigFile, findings: Sequence[PlanFinding], *, show_all: bool
) -> Document:
    """Return what a check of a plan found.

    Parameters
    ----------
    show_all
        Whether people see all findings of a kind and not the worst alone.
    """
    refused = sum(finding.verdict is PlanVerdict.REFUSE for finding in findings)
    warned = sum(finding.verdict is PlanVerdict.WARN for finding in findings)
    summary = (
        f"the rig cannot run it: {counted(refused, 'refusal')}"
        if refused
        else f"the rig can run it, with {counted(warned, 'warning')}"
    )
    contents = (
        finding_notes(findings, show_all=show_all),
        Table("Conditions", _CONDITIONS, () if show_all else largest_stated(findings)),
        Text((f"{plan.name}: {counted(len(plan.runs), 'run')}; {summary}",)),
        Data("plan", plan.path),
        Data("rig", rig.path),
        Data("runs", len(plan.runs)),
        Data("possible", not refused),
        Data("findings", findings),
    )
    return Document("", "check of a plan", (Section("", contents),), CHECK_SCHEMA)


def finding_notes(findings: Sequence[PlanFinding], *, show_all: bool = False) -> Notes:
    """Return a note for each finding; of those of one kind the worst, unless all are wanted."""
    return Notes([_note(finding, more) for finding, more in _gathered(findings, show_all=show_all)])


def _note(finding: PlanFinding, more: int) -> Note:
    suffix = f" (and {counted(more, 'other run')} so)" if more else ""
    run = f"{finding.run}: " if finding.run else ""
    return Note(finding.verdict, f"{run}{finding.message}{suffix}")


def _gathered(
    findings: Sequence[PlanFinding], *, show_all: bool
) -> Iterator[tuple[PlanFinding, int]]:
    """Yield findings; of those of one kind the one furthest off, and how many there are beside."""
    if show_all:
        yield from ((finding, 0) for finding in findings)
        return
    ranks = list(PlanVerdict)
    findings = [finding for finding in findings if not finding.is_stated]

    def kind(finding: PlanFinding) -> tuple[int, str, float]:
        subject = finding.quantity if finding.run else finding.message
        return (
            ranks.index(finding.verdict),
            subject,
            0.0 if math.isnan(finding.limit) else finding.limit,
        )

    for _, group in groupby(sorted(findings, key=kind), kind):
        alike = list(group)
        worst = max(alike, key=lambda finding: abs(finding.value - kind(finding)[2]))
        yield worst, len({finding.run for finding in alike}) - 1


@dataclass(frozen=True)
class _Row:
    """A run in its place; the force is ``None`` where nobody can estimate it."""

    number: int
    run: RunPlan
    duration_s: float
    ends_at_s: float
    tank_length_m: float
    force_n: float | None

    @property
    def data(self) -> dict[str, Any]:
        """The run as programs get it, but for the peaks of an oscillation."""
        return {
            **asdict(self.run),
            "duration_s": self.duration_s,
            "tank_length_m": self.tank_length_m,
        }


def _turning(heading: str, unit: str, cell: Callable[[_Row], str]) -> Column[_Row]:
    """Return a column that is empty for a run at rest."""
    return Column(
        heading, lambda row: cell(row) if row.run.oscillates else "", unit=unit, number=True
    )


# Amplitudes are half the stroke.
_RUNS: Final[tuple[Column[_Row], ...]] = (
    number("", "number"),
    Column("run", lambda row: _run_name(row.run)),
    _turning("f", "Hz", lambda row: f"{row.run.set_point.frequency_hz:g}"),
    _turning("ampl.", "mm", lambda row: f"{1e3 * row.run.set_point.eccentricity_m:.6g}"),
    _turning("phase", "deg", lambda row: f"{math.degrees(row.run.set_point.strut_phase_rad):.1f}"),
    Column("U", lambda row: row.run.set_point.carriage_speed_m_s, unit="m/s", number=True,
           written=lambda speed: f"{speed:g}" if speed else ""),
    _turning("periods", "", lambda row: _periods(row.run)),
    Column("force, est.", lambda row: row.force_n, unit="N", number=True,
           written=lambda force_n: "" if force_n is None else f"{force_n:.1f}"),
    number("way", "tank_length_m", lambda way: f"{way:.1f}" if way else "", "m"),
    number("time", "duration_s", clock),
    number("ends at", "ends_at_s", clock),
)  # fmt: skip


def show_document(plan: Plan, rig: RigFile) -> Document:
    """Return the runs of a plan in their order, with how long they take and what they ask."""
    times = duration_rows(plan.runs, rig)
    rows = [
        _Row(number, run, time_s, end_s, tank_length_m(run, rig), force_peak_n(run, rig))
        for number, (run, time_s, end_s) in enumerate(
            zip(plan.runs, times, accumulate(times), strict=True), 1
        )
    ]
    total = math.fsum(times)
    summary = (
        f"{plan.name}: {counted(len(plan.runs), 'run')}, {clock(total)} at most, without handwork"
    )
    contents = (
        Text((summary, "")),
        Table("Runs", _RUNS, rows),
        Data("name", plan.name),
        Data("plan", plan.path),
        Data("rig", rig.path),
        Data("operator", plan.operator),
        Data("sha256", plan.sha256),
        Data("duration_s", total),
        Data("runs", [{**row.data, **_peaks(row, rig)} for row in rows]),
    )
    return Document("", "runs of a plan", (Section("", contents),), SHOW_SCHEMA)


def _peaks(row: _Row, rig: RigFile) -> dict[str, float | None]:
    """Return the largest of what the struts do, for an oscillation; of a tow their force."""
    if not row.run.oscillates:
        return {} if row.force_n is None else {"strut_force_estimate_n": row.force_n}
    return {
        "strut_velocity_m_s": velocity_peak_m_s(row.run, rig.oscillator),
        "strut_acceleration_m_s2": acceleration_peak_m_s2(row.run, rig.oscillator),
        "strut_force_estimate_n": row.force_n,
    }


def _run_name(run: RunPlan) -> str:
    """Return the run's name, and its kind where the name does not say it."""
    says = run.kind is RunKind.OSCILLATION or run.name.startswith(run.kind)
    return run.name if says else f"{run.name} ({run.kind})"


def _periods(run: RunPlan) -> str:
    return f"{run.periods}" + ("" if run.target_relative is None else f" to {run.max_periods}")
