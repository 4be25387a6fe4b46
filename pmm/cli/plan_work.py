"""What ``pmm plan`` does: check a plan, print it, draw it."""

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import click

from hardware.description.kinds import RunKind
from pmm.cli.findings import condition_table, finding_lines
from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.screen import output
from pmm.document.data import plain
from pmm.document.notation import counted
from pmm.plan.checks import check_plan
from pmm.plan.duration import duration_rows, tank_length_m
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.force_estimate import force_peak_n
from pmm.plan.motion_peaks import acceleration_peak_m_s2, velocity_peak_m_s
from pmm.plan.plan import Plan, read_plan_and_rig
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan

CHECK_SCHEMA = "pmm-plan-check-1"
SHOW_SCHEMA = "pmm-plan-1"
# Amplitudes are half the stroke.
_HEADINGS = (
    "f\n[Hz]",
    "ampl.\n[mm]",
    "phase\n[deg]",
    "U\n[m/s]",
    "periods",
    "force, est.\n[N]",
    "way\n[m]",
    "time",
    "ends at",
)


def check(file: str, *, every: bool, as_json: bool) -> None:
    """Check a plan; exit with status 1 if the rig cannot run it.

    Raises
    ------
    ConfigurationError
        If the plan or its rig's file is wrong.
    """
    plan, rig = read_plan_and_rig(file)
    found = check_plan(plan, rig, datetime.now(UTC).date())
    refused = any(one.verdict is PlanVerdict.REFUSE for one in found)
    if as_json:
        click.echo(json.dumps(_check_document(plan, rig, found, refused), indent=1))
    else:
        _print_findings(plan, found, every=every)
    if refused:
        click.get_current_context().exit(1)


def show(file: str, *, plot: str | None, as_json: bool) -> None:
    """Print the runs of a plan in their order, and draw their matrix.

    Raises
    ------
    ConfigurationError
        If the plan or its rig's file is wrong, or the folder cannot be written to.
    """
    plan, rig = read_plan_and_rig(file)
    if plot is not None:
        check_folder(Path(plot), "--plot")
    figures = [] if plot is None else _draw(plan, rig, Path(plot))
    times = duration_rows(plan.runs, rig)
    if as_json:
        click.echo(json.dumps(_show_document(plan, rig, times), indent=1))
        return
    _print_runs(plan, rig, times)
    for figure in figures:
        output().print(str(figure), soft_wrap=True)
    output().print(pasted("plan", "check", file), soft_wrap=True)


def _draw(plan: Plan, rig: RigFile, folder: Path) -> list[Path]:
    from pmm.document.style import write_figure
    from pmm.report.matrix_figure import matrix_figure

    return write_figure(matrix_figure(plan, rig), folder, f"{plan.name}-matrix")


def clock(seconds: float) -> str:
    """Return a time as minutes and seconds, with hours where there are any: ``1:02:03``."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"


def _check_document(
    plan: Plan, rig: RigFile, found: Sequence[PlanFinding], refused: bool
) -> dict[str, Any]:
    return {
        "schema": CHECK_SCHEMA,
        "plan": str(plan.path),
        "rig": str(rig.path),
        "runs": len(plan.runs),
        "possible": not refused,
        "findings": [plain(one) for one in found],
    }


def _print_findings(plan: Plan, found: Sequence[PlanFinding], *, every: bool) -> None:
    console = output()
    for line in finding_lines(found, every=every):
        console.print(line, soft_wrap=True)
    if not every and (table := condition_table(found)) is not None:
        console.print(table)
    refused = sum(one.verdict is PlanVerdict.REFUSE for one in found)
    warned = sum(one.verdict is PlanVerdict.WARN for one in found)
    what = f"{plan.name}: {counted(len(plan.runs), 'run')}"
    if refused:
        console.print(f"{what}; the rig cannot run it: {counted(refused, 'refusal')}")
    else:
        console.print(f"{what}; the rig can run it, with {counted(warned, 'warning')}")


def _show_document(plan: Plan, rig: RigFile, times: Sequence[float]) -> dict[str, Any]:
    rows = []
    for one, duration in zip(plan.runs, times, strict=True):
        peaks: dict[str, Any] = {"duration_s": duration, "tank_length_m": tank_length_m(one, rig)}
        if one.oscillates:
            peaks["strut_velocity_m_s"] = velocity_peak_m_s(one, rig.oscillator)
            peaks["strut_acceleration_m_s2"] = acceleration_peak_m_s2(one, rig.oscillator)
            peaks["strut_force_estimate_n"] = force_peak_n(one, rig)
        rows.append(asdict(one) | peaks)
    return {
        "schema": SHOW_SCHEMA,
        "name": plan.name,
        "plan": str(plan.path),
        "rig": str(rig.path),
        "operator": plan.operator,
        "sha256": plan.sha256,
        "duration_s": math.fsum(times),
        "runs": rows,
    }


def _print_runs(plan: Plan, rig: RigFile, times: Sequence[float]) -> None:
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    total = clock(math.fsum(times))
    title = f"{plan.name}: {counted(len(plan.runs), 'run')}, {total} at most, without handwork"
    table = Table(title=title, title_justify="left", box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("", justify="right")
    table.add_column("run", overflow="fold")
    for heading in _HEADINGS:
        table.add_column(heading, justify="right", no_wrap=True)
    end = 0.0
    for number, (one, duration) in enumerate(zip(plan.runs, times, strict=True), 1):
        end += duration
        cells = (*_cells(one, rig), clock(duration), clock(end))
        table.add_row(str(number), _named(one), *cells)
    output().print(table)


def _named(run: RunPlan) -> str:
    """Return the run's name, and its kind where the name does not say it."""
    says = run.kind is RunKind.OSCILLATION or run.name.startswith(run.kind)
    return run.name if says else f"{run.name} ({run.kind})"


def _cells(run: RunPlan, rig: RigFile) -> tuple[str, ...]:
    point = run.set_point
    speed = f"{point.carriage_speed_m_s:g}" if point.carriage_speed_m_s else ""
    way = f"{tank_length_m(run, rig):.1f}" if speed else ""
    if not run.oscillates:
        return ("", "", "", speed, "", "", way)
    periods = f"{run.periods}"
    if run.target_relative is not None:
        periods += f" to {run.max_periods}"
    force = force_peak_n(run, rig)
    return (
        f"{point.frequency_hz:g}",
        f"{1e3 * point.eccentricity_m:.6g}",
        f"{math.degrees(point.strut_phase_rad):.1f}",
        speed,
        periods,
        "" if force is None else f"{force:.1f}",
        way,
    )
