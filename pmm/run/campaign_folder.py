"""A campaign's folder: which runs it holds, what it was made from, and what is still to be done."""

from collections.abc import Sequence
from pathlib import Path

from hardware.description.errors import ConfigurationError
from pmm.plan.campaign_writer import FinishedRun
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan
from pmm.recorder.files import HEADER, RECORDING, is_run
from pmm.recorder.header import RunHeader
from pmm.recorder.line_shapes import read_marker
from pmm.recorder.recording import NOISE
from pmm.recorder.run_recorder import RunEnd
from pmm.run.run_origin import KEPT, Sources, check_unchanged
from pmm.whole_file import write_whole


def folder_of(plan: Plan, folder: str, output: str | None) -> Path:
    """Return where a campaign is recorded: ``output``, or the rig's folder and the plan's name."""
    if output is not None:
        return Path(output)
    return plan.rig_path.parent / folder / plan.name


def done_runs(folder: Path, runs: Sequence[RunPlan]) -> tuple[str, ...]:
    """Return the names of the runs that are recorded and complete."""
    return tuple(run.name for run in runs if _outcome(folder / run.name) == RunEnd.COMPLETE)


def chosen_runs(
    plan: Plan,
    rig: RigFile,
    folder: Path,
    only: Sequence[str] = (),
    *,
    resume: bool,
    accept_changes: bool = False,
) -> tuple[RunPlan, ...]:
    """Return the runs that are to be made now.

    Raises
    ------
    ConfigurationError
        If the folder holds these runs and nobody asked to resume, or runs of another plan, rig,
        model or calibration and nobody accepts that.
    """
    runs = _wanted_runs(plan, folder, only, resume=resume)
    if not accept_changes:
        check_unchanged(folder, kept_runs(plan, rig, folder, runs), plan)
    return runs


def kept_runs(
    plan: Plan, rig: RigFile, folder: Path, runs: Sequence[RunPlan]
) -> tuple[FinishedRun, ...]:
    """Return the runs of the folder that stay as they are when some are made."""
    made = {run.name for run in runs}
    return tuple(run for run in finished_runs(folder, plan, rig) if run.plan.name not in made)


def _wanted_runs(
    plan: Plan, folder: Path, only: Sequence[str], *, resume: bool
) -> tuple[RunPlan, ...]:
    wanted = tuple(run for run in plan.runs if not only or run.name in only)
    if resume:
        done_names = done_runs(folder, wanted)
        return tuple(run for run in wanted if run.name not in done_names)
    names = [run.name for run in wanted if is_run(folder / run.name)]
    if names:
        raise ConfigurationError(
            f"{folder}: holds {len(names)} of these runs already ({', '.join(names[:3])}"
            f"{', ...' if len(names) > 3 else ''}); --resume makes those that are not complete, "
            "--output records to another folder"
        )
    return wanted


def keep_sources(plan: Plan, rig: RigFile, folder: Path) -> None:
    """Keep plan and rig file in the folder, as they were read; earlier ones stay beside."""
    target = folder / KEPT
    target.mkdir(parents=True, exist_ok=True)
    for path, content in ((plan.path, plan.content), (rig.path, rig.content)):
        copy, number = target / path.name, 1
        while copy.exists() and copy.read_bytes() != content:
            number += 1
            copy = target / f"{path.stem}-{number}{path.suffix}"
        write_whole(copy, content)


def finished_runs(folder: Path, plan: Plan, rig: RigFile) -> tuple[FinishedRun, ...]:
    """Return the runs that have a recording, in the order in which they were made.

    Each has the plan that it was recorded with, and what plan and rig say otherwise now. Tries
    that were moved aside are left out.

    Raises
    ------
    DataError
        If a header is damaged.
    """
    rows, now = [], Sources(folder, plan, rig)
    for path in folder.glob(f"*/{HEADER}"):
        run_folder = path.parent
        if not (run_folder / RECORDING).exists():
            continue
        header = RunHeader.read(path)
        if header.run_name != run_folder.name:
            continue
        run = RunPlan.from_json(header.plan_json, str(path))
        marker, made = read_marker(run_folder) or {}, now.origin(header, run)
        finished_run = FinishedRun(
            run,
            f"{run.name}/{RECORDING}",
            header.readings,
            str(marker.get("outcome", "")),
            header.channels,
            marker.get(NOISE, {}),
            header.number,
            made.differs,
            made.recorded_with,
        )
        rows.append((header.order, finished_run))
    return tuple(finished_run for _, finished_run in sorted(rows, key=lambda each: each[0]))


def _outcome(folder: Path) -> str:
    """Return how a run ended; empty if it is not there, not closed, or has no recording."""
    marker = read_marker(folder) if (folder / RECORDING).exists() else None
    return str((marker or {}).get("outcome", ""))


def check_names(plan: Plan, only: Sequence[str]) -> None:
    """Refuse names that are no runs of the plan.

    Raises
    ------
    ConfigurationError
        Naming the nearest.
    """
    from difflib import get_close_matches

    names = [run.name for run in plan.runs]
    for name in only:
        if name not in names:
            near = get_close_matches(name, names, n=3, cutoff=0.4)
            hint = f"did you mean {', '.join(near)}?" if near else f"runs: {', '.join(names)}"
            raise ConfigurationError(f"{plan.path}: no run {name!r}; {hint}")
