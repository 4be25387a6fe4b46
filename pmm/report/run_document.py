"""What ``pmm run`` says when its runs have ended."""

from typing import Final

from pmm.document.content import Data, Document, Section, Text
from pmm.document.notation import counted
from pmm.recorder.run_recorder import RunEnd
from pmm.run.session import RunJob, RunReport
from pmm.run.status import RunOutcome

SCHEMA: Final = "pmm-run-control-1"


def run_document(job: RunJob, report: RunReport, *, dry_run: bool) -> Document:
    """Return how the runs of a plan ended; ``docs/run-control.md`` describes the keys."""
    contents = (
        Text(_lines(job, report, dry_run=dry_run)),
        Data("plan", job.plan.path),
        Data("folder", job.folder),
        Data("dry_run", dry_run),
        Data("planned", [run.name for run in job.runs]),
        Data("findings", job.findings),
        Data("changes", job.changes),
        Data("fault", report.fault or None),
        Data("runs", report.outcomes),
    )
    return Document("", "runs of a plan", (Section("", contents),), SCHEMA)


def complete_runs(report: RunReport) -> int:
    """Return how many runs are complete."""
    return sum(outcome.outcome == RunEnd.COMPLETE for outcome in report.outcomes)


def _lines(job: RunJob, report: RunReport, *, dry_run: bool) -> list[str]:
    if dry_run:
        return [f"{job.plan.path}: {len(job.runs)} runs would be recorded to {job.folder}"]
    if not job.runs:
        return [f"{job.folder}: all runs are complete"]
    lines = [
        outcome_line(outcome)
        for outcome in report.outcomes
        if outcome.outcome != RunEnd.COMPLETE
        and not (report.fault and outcome.reason == report.fault)  # that is the error
    ]
    return [*lines, f"{complete_runs(report)} of {len(job.runs)} runs complete in {job.folder}"]


def outcome_line(outcome: RunOutcome) -> str:
    """Return a finished run in a line."""
    reason = f": {outcome.reason}" if outcome.reason else ""
    where = f", {outcome.file}" if outcome.file else ""
    voids = sum(flag.code == "gate_void" for flag in outcome.flags)
    void = f", {voids} void gates" if voids else ""
    far = [flag.channel or "" for flag in outcome.flags if flag.code == "force_far"]
    off = f", {' and '.join(far)} far from the plan's estimate" if far else ""
    return (
        f"{outcome.run}: {outcome.outcome}, {counted(outcome.periods, 'period')}"
        f"{void}{off}{where}{reason}"
    )
