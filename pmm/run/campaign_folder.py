"""A campaign's folder: which runs it holds, what it was made from, and what is still to be done."""

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from hardware.description.errors import ConfigurationError
from pmm.plan.campaign_writer import FinishedRun
from pmm.plan.plan import Plan
from pmm.plan.run_plan import RunPlan
from pmm.recorder.files import HEADER, MARKER, RECORDING, is_run
from pmm.recorder.header import RunHeader
from pmm.recorder.run_recorder import Outcome

KEPT: Final = "made-from"  # copies of plan and rig, as they were


def folder_of(plan: Plan, folder: str, output: str | None) -> Path:
    """Return where a campaign is recorded: ``output``, or the rig's folder and the plan's name."""
    if output is not None:
        return Path(output)
    return plan.rig_path.parent / folder / plan.name


def done_runs(folder: Path, runs: Sequence[RunPlan]) -> tuple[str, ...]:
    """Return the names of the runs that are recorded and complete."""
    return tuple(one.name for one in runs if _outcome(folder / one.name) == Outcome.COMPLETE)


def chosen_runs(
    plan: Plan, folder: Path, only: Sequence[str], *, resume: bool
) -> tuple[RunPlan, ...]:
    """Return the runs that are to be made now.

    Raises
    ------
    ConfigurationError
        If a name in ``only`` is no run, or the folder holds runs and nobody asked to resume.
    """
    _check_names(plan, only)
    wanted = tuple(one for one in plan.runs if not only or one.name in only)
    if resume:
        done = done_runs(folder, wanted)
        return tuple(one for one in wanted if one.name not in done)
    there = [one.name for one in wanted if is_run(folder / one.name)]
    if there:
        raise ConfigurationError(
            f"{folder}: holds {len(there)} of these runs already ({', '.join(there[:3])}"
            f"{', ...' if len(there) > 3 else ''}); --resume makes those that are not complete, "
            "--output records to another folder"
        )
    return wanted


def keep_sources(plan: Plan, folder: Path) -> None:
    """Copy plan and rig file into the folder, as they are now; earlier copies stay beside."""
    target = folder / KEPT
    target.mkdir(parents=True, exist_ok=True)
    for path in (plan.path, plan.rig_path):
        copy, number = target / path.name, 1
        while copy.exists() and copy.read_bytes() != path.read_bytes():
            number += 1
            copy = target / f"{path.stem}-{number}{path.suffix}"
        shutil.copyfile(path, copy)


def finished_runs(folder: Path, runs: Sequence[RunPlan]) -> tuple[FinishedRun, ...]:
    """Return the runs that have a recording, in the order in which they were made."""
    found = []
    for number, run in enumerate(runs):
        own = folder / run.name
        if not (own / RECORDING).exists():
            continue
        header = RunHeader.from_json((own / HEADER).read_text(encoding="utf-8"), str(own / HEADER))
        one = FinishedRun(run, f"{run.name}/{RECORDING}", header.readings, _outcome(own))
        found.append((header.started_utc, number, one))
    return tuple(one for *_, one in sorted(found, key=lambda each: each[:2]))


def _outcome(folder: Path) -> str:
    """Return how a run ended; empty if it is not there, not closed, or has no recording."""
    try:
        marker = json.loads((folder / MARKER).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ""
    return str(marker.get("outcome", "")) if (folder / RECORDING).exists() else ""


def _check_names(plan: Plan, only: Sequence[str]) -> None:
    from difflib import get_close_matches

    known = [one.name for one in plan.runs]
    for name in only:
        if name not in known:
            near = get_close_matches(name, known, n=3, cutoff=0.4)
            hint = f"did you mean {', '.join(near)}?" if near else f"runs: {', '.join(known)}"
            raise ConfigurationError(f"{plan.path}: no run {name!r}; {hint}")
