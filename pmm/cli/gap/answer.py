"""``pmm gap answer``: the diagnosis of every case of a board, without its keys."""

import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.options import SCHEDULER, jobs_option

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from analysis.gap.judge.diagnosis import Diagnosis
    from pmm.gap.preparation import PreparedCampaign


@dataclass(frozen=True)
class CaseTask:
    """A case's folder, absolute, and the effects that are taken out of the catalogue."""

    case: Path
    left_out: tuple[str, ...]


@dataclass(frozen=True)
class CaseAnswer:
    """What came of a case: the text of its answer, or why it could not be diagnosed."""

    case: str
    text: str = ""
    failed: str = ""


@click.command()
@click.argument("folder", metavar="BOARD")
@click.option("--output", metavar="FOLDER", help="Where the answers go; BOARD/answers if not said.")
@click.option(
    "--leave-out",
    metavar="FILE.json",
    help="Effects to take out of the catalogue, by case; only these cases are answered.",
)
@jobs_option("one for each core")
@SCHEDULER
@click.option("--overwrite", is_flag=True, help="Answer again what has an answer already.")
def answer(
    folder: str,
    output: str | None,
    leave_out: str | None,
    jobs: int | None,
    scheduler: str | None,
    overwrite: bool,
) -> None:
    """Diagnose every case in BOARD/cases and write one answer each (docs/sealed.md).

    It looks at nothing but BOARD/cases. What is answered already is kept, so that a board that was
    broken off goes on. Exit status: 0 all answered, 1 some cases could not be diagnosed.
    """
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from hardware.description.errors import DataError
    from pmm.cli.files import check_folder
    from pmm.cli.screen import error_line, messages

    board = Path(folder)
    target = board / "answers" if output is None else Path(output)
    check_folder(target, "--output")
    left_out = None if leave_out is None else _left_out(Path(leave_out))
    cases = [case for case in _cases(board) if left_out is None or case.name in left_out]
    tasks = [
        CaseTask(case.absolute(), tuple((left_out or {}).get(case.name, ())))
        for case in cases
        if overwrite or not (target / f"{case.name}.json").exists()
    ]
    target.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    failures = _answered(tasks, target, jobs, scheduler)
    duration_s = time.monotonic() - started
    kept_count = len(cases) - len(tasks)
    messages().print(
        f"{len(tasks) - len(failures)} cases answered in {duration_s:.0f} s"
        + (f", {kept_count} had answers already" if kept_count else "")
        + f": {target}"
    )
    for line in failures:
        error_line(line)
    if failures:
        click.get_current_context().exit(DataError.exit_status)


def _cases(board: Path) -> list[Path]:
    from hardware.description.errors import ConfigurationError

    folders = sorted(folder for folder in (board / "cases").glob("*") if folder.is_dir())
    if not folders:
        raise ConfigurationError(f"{board}: no cases in {board / 'cases'}")
    return folders


def _left_out(path: Path) -> "Mapping[str, Sequence[str]]":
    from hardware.description.errors import ConfigurationError
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


def _answered(
    tasks: "Sequence[CaseTask]", target: Path, jobs: int | None, scheduler: str | None
) -> list[str]:
    """Write each answer as it comes; return why cases have none, in their order."""
    from pmm.cli.screen import show_progress
    from pmm.parallel import as_done, open_executor
    from pmm.whole_file import write_whole

    failures: list[str] = []
    with open_executor(jobs, scheduler) as executor:
        for outcome in show_progress(as_done(executor, answer_one, tasks), "cases", len(tasks)):
            if outcome.failed:
                failures.append(outcome.failed)
            else:
                write_whole(target / f"{outcome.case}.json", outcome.text)
    return sorted(failures)


def answer_one(task: CaseTask) -> CaseAnswer:
    """Diagnose one case.

    Raises
    ------
    DataError
        If its folder is not there for this process.
    """
    from hardware.description.errors import PmmError
    from pmm.parallel import task_folder

    folder = task_folder(task.case)
    try:
        content = diagnosed(folder, task.left_out)
    except (PmmError, OSError) as error:
        return CaseAnswer(task.case.name, failed=f"{task.case.name}: {error}")
    return CaseAnswer(task.case.name, json.dumps(content, indent=1, allow_nan=False) + "\n")


def diagnosed(
    folder: Path, left_out: tuple[str, ...] = (), *, proposes: bool = True
) -> dict[str, Any]:
    """Return the answer to a case's folder; parameters as of :func:`diagnosis_of`."""
    return answer_to(folder.name, *diagnosis_of(folder, left_out, proposes=proposes))


def answer_to(case: str, prepared: "PreparedCampaign", diagnosis: "Diagnosis") -> dict[str, Any]:
    """Return a case's diagnosis as an answer."""
    from pmm.gap.answer import answer as answer_of

    stated = prepared.case
    return answer_of(case, diagnosis, prepared.recentred.free, stated.held_out, stated.tolerances)


def diagnosis_of(
    folder: Path, left_out: tuple[str, ...] = (), *, proposes: bool = True
) -> "tuple[PreparedCampaign, Diagnosis]":
    """Return a case's campaign and its diagnosis, with some effects taken out of the catalogue.

    Parameters
    ----------
    proposes
        Whether the next run is sought too: a fifth of the time.
    """
    from dataclasses import replace

    from analysis.gap.judge.diagnosis import diagnose
    from pmm.gap.preparation import prepare
    from sim.effects.catalogue import catalogue

    kinds = {name: kind for name, kind in catalogue().items() if name not in left_out}
    prepared = prepare(folder, kinds)
    settings = prepared.settings if proposes else replace(prepared.settings, choices=None)
    return prepared, diagnose(prepared.recentred.rig, prepared.fitted, settings)
