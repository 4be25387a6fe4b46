"""What ``pmm gap answer`` does: a pool of processes, one case each at a time."""

import json
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import click

from hardware.description.errors import ConfigurationError, DataError, PmmError
from pmm.cli.folders import check_folder
from pmm.cli.screen import error_line, messages
from pmm.parallel import one_thread


@dataclass(frozen=True)
class Request:
    """The options of the command, by their names there."""

    folder: str
    output: str | None
    leave_out: str | None
    workers: int
    overwrite: bool


def run(request: Request) -> None:
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
    jobs = [
        (case, target / f"{case.name}.json", tuple((left_out or {}).get(case.name, ())))
        for case in cases
        if request.overwrite or not (target / f"{case.name}.json").exists()
    ]
    target.mkdir(parents=True, exist_ok=True)
    started = time.monotonic()
    failed = [line for line in _work(jobs, request.workers) if line]
    took = time.monotonic() - started
    kept = len(cases) - len(jobs)
    messages().print(
        f"{len(jobs) - len(failed)} cases answered in {took:.0f} s"
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


def _work(jobs: Sequence[tuple[Path, Path, tuple[str, ...]]], workers: int) -> Iterator[str]:
    """Yield for each case an empty line, or why it could not be diagnosed."""
    from rich.progress import Progress

    console = messages()
    with Progress(console=console, transient=True, disable=not console.is_terminal) as progress:
        task = progress.add_task("cases", total=len(jobs))
        for line in _each(jobs, min(workers, max(len(jobs), 1))):
            progress.advance(task)
            yield line


def _each(jobs: Sequence[tuple[Path, Path, tuple[str, ...]]], workers: int) -> Iterator[str]:
    if workers == 1:
        yield from (answer_one(*job) for job in jobs)
        return
    with ProcessPoolExecutor(workers, get_context("spawn"), one_thread) as pool:
        for done in as_completed([pool.submit(answer_one, *job) for job in jobs]):
            yield done.result()


def answer_one(case: Path, target: Path, left_out: tuple[str, ...] = ()) -> str:
    """Diagnose one case and write its answer; return an empty line, or why it could not be."""
    try:
        found = diagnosed(case, left_out)
    except (PmmError, OSError) as error:
        return f"{case.name}: {error}"
    written = target.with_suffix(".part")
    written.write_text(json.dumps(found, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    written.replace(target)
    return ""


def diagnosed(folder: Path, left_out: tuple[str, ...] = ()) -> dict[str, Any]:
    """Return the answer to a case's folder, with some effects taken out of the catalogue."""
    from analysis.gap.diagnose import diagnose
    from pmm.gap.answer import answer
    from pmm.gap.prepare import prepare
    from sim.effects.catalogue import catalogue

    known = {name: kind for name, kind in catalogue().items() if name not in left_out}
    ready = prepare(folder, known)
    found = diagnose(ready.there.rig, ready.fitted, ready.settings)
    return answer(folder.name, found, ready.there, ready.case.held_out, ready.case.priors)
