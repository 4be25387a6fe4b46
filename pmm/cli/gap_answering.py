"""What ``pmm gap answer`` does: the cases go out to workers, this process writes their answers."""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import click

from hardware.description.errors import ConfigurationError, DataError, PmmError
from pmm.cli.folders import check_folder
from pmm.cli.screen import error_line, messages
from pmm.parallel import as_done, check_seen, open_executor
from pmm.whole_file import write_whole


@dataclass(frozen=True)
class GapAnswerOptions:
    """The options of the command, by their names there."""

    folder: str
    output: str | None
    leave_out: str | None
    jobs: int | None
    scheduler: str | None
    overwrite: bool


@dataclass(frozen=True)
class CaseTask:
    """A case's folder, absolute, and the effects that are taken out of the catalogue."""

    case: Path
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class Answered:
    """What came of a case: the text of its answer, or why it could not be diagnosed."""

    case: str
    text: str = ""
    failed: str = ""


def run(request: GapAnswerOptions) -> None:
    """Answer a board.

    Raises
    ------
    ConfigurationError
        If there are no cases, or an option is wrong.
    DataError
        With the cases that could not be diagnosed; all others are answered.
    """
    board = Path(request.folder)
    target = board / "answers" if request.output is None else Path(request.output)
    check_folder(target, "--output")
    left_out = None if request.leave_out is None else _left_out(Path(request.leave_out))
    cases = [one for one in _cases(board) if left_out is None or one.name in left_out]
    tasks = [
        CaseTask(case.absolute(), tuple((left_out or {}).get(case.name, ())))
        for case in cases
        if request.overwrite or not (target / f"{case.name}.json").exists()
    ]
    target.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    failed = _answered(request, tasks, target)
    took = time.monotonic() - started
    kept = len(cases) - len(tasks)
    messages().print(
        f"{len(tasks) - len(failed)} cases answered in {took:.0f} s"
        + (f", {kept} had answers already" if kept else "")
        + f": {target}"
    )
    for line in failed:
        error_line(line)
    if failed:
        click.get_current_context().exit(DataError.exit_status)


def _cases(board: Path) -> list[Path]:
    found = sorted(one for one in (board / "cases").glob("*") if one.is_dir())
    if not found:
        raise ConfigurationError(f"{board}: no cases in {board / 'cases'}")
    return found


def _left_out(path: Path) -> Mapping[str, Sequence[str]]:
    from sim.effects.catalogue import catalogue

    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise ConfigurationError(f"--leave-out {path}: cannot be read: {error}") from None
    names = {name for names in table.values() for name in names}
    unknown = sorted(names - set(catalogue()))
    if unknown:
        raise ConfigurationError(f"--leave-out {path}: no effects: {', '.join(unknown)}")
    return dict(table)


def _answered(request: GapAnswerOptions, tasks: Sequence[CaseTask], target: Path) -> list[str]:
    """Write each answer as it comes; return why cases have none, in their order."""
    failed = []
    for one in _work(request, tasks):
        if one.failed:
            failed.append(one.failed)
        else:
            write_whole(target / f"{one.case}.json", one.text)
    return sorted(failed)


def _work(request: GapAnswerOptions, tasks: Sequence[CaseTask]) -> Iterator[Answered]:
    """Yield what came of each case, with progress on a terminal."""
    from rich.progress import Progress

    console = messages()
    with (
        Progress(console=console, transient=True, disable=not console.is_terminal) as progress,
        open_executor(request.jobs, request.scheduler) as executor,
    ):
        bar = progress.add_task("cases", total=len(tasks))
        for done in as_done(executor, answer_one, tasks):
            progress.advance(bar)
            yield done


def answer_one(task: CaseTask) -> Answered:
    """Diagnose one case.

    Raises
    ------
    DataError
        If its folder is not there for this process.
    """
    check_seen(task.case)
    try:
        found = diagnosed(task.case, task.left_out)
    except (PmmError, OSError) as error:
        return Answered(task.case.name, failed=f"{task.case.name}: {error}")
    return Answered(task.case.name, json.dumps(found, indent=1, allow_nan=False) + "\n")


def diagnosed(folder: Path, left_out: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the answer to a case's folder, with some effects taken out of the catalogue."""
    from analysis.gap.diagnose import diagnose
    from pmm.gap.answer import answer
    from pmm.gap.prepare import prepare
    from sim.effects.catalogue import catalogue

    known = {name: kind for name, kind in catalogue().items() if name not in left_out}
    ready = prepare(folder, known)
    found = diagnose(ready.there.rig, ready.fitted, ready.settings)
    return answer(folder.name, found, ready.there.rig, ready.case.held_out, ready.case.tolerances)
