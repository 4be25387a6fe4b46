"""Folders into the archive: what changed is taken in anew, what is known is not computed again."""

import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Executor
from dataclasses import astuple, dataclass, replace
from pathlib import Path
from typing import Any

from hardware.description.errors import ConfigurationError, DataError, PmmError
from pmm.archive.contents import Stamp, changes, read_contents, stamp
from pmm.archive.filing import (
    file_contents,
    file_notes,
    file_results,
    file_stamps,
    row_of,
    stamps,
)
from pmm.archive.notebook import NOTES_FILE, NoteLine, read_notes, write_note
from pmm.archive.results import AnalysedCampaign, Analyses, GapVerdict
from pmm.parallel import as_done, task_folder
from pmm.remote import local_path, url_of


@dataclass(frozen=True)
class AddedFolder:
    """What was done with a folder.

    Attributes
    ----------
    state
        ``"new"``, ``"changed"``, ``"as before"`` or ``"moved"``.
    computed
        What was computed now: ``"analysis"``, ``"diagnosis"``, both or none.
    refused
        What could not be found, from the analysis of now.
    """

    folder: Path
    campaign: str
    state: str
    runs: int
    computed: tuple[str, ...]
    refused: tuple[str, ...]


@dataclass(frozen=True)
class FolderTask:
    """A folder that was taken in, with what is to be computed of it.

    Attributes
    ----------
    key
        Of its row in the archive.
    due
        What is asked for and not known of these very files.
    """

    added: AddedFolder
    key: int
    stamps: Mapping[str, Stamp]
    due: Analyses


@dataclass(frozen=True)
class ComputedFolder:
    """What was computed of a folder, up to what it refused with."""

    task: FolderTask
    analysed: AnalysedCampaign | None = None
    verdict: GapVerdict | None = None
    error: PmmError | None = None


def add_folders(
    connection: sqlite3.Connection,
    folders: Iterable[Path],
    analyses: Analyses,
    now_utc: str,
    executor: Executor,
) -> Iterator[AddedFolder | PmmError]:
    """Take folders in, and compute what is asked for in an executor's workers.

    Each result is kept as it comes, by the hash of the files that it rests on: whoever is
    interrupted adds the same folders again, and nothing is computed twice. A folder that is refused
    gives its error, and the others go on.
    """
    results: list[AddedFolder | PmmError] = []

    def tasks() -> Iterator[FolderTask]:
        for folder in folders:
            try:
                task = _taken_in(connection, folder, analyses, now_utc)
            except PmmError as error:
                results.append(error)
                continue
            if task.due == Analyses():
                results.append(task.added)
            else:
                yield task

    for outcome in as_done(executor, compute, tasks()):
        try:
            results.append(_keep_results(connection, outcome))
        except PmmError as error:
            results.append(error)
        while results:
            yield results.pop(0)
    yield from results


def compute(task: FolderTask) -> ComputedFolder:
    """Compute what is due of a folder, wherever its task was sent."""
    analysed, verdict = None, None
    try:
        folder = task_folder(task.added.folder)
        if task.due.analyse is not None:
            analysed = task.due.analyse(folder)
        if task.due.diagnose is not None:
            verdict = task.due.diagnose(folder)
    except PmmError as error:
        return ComputedFolder(task, analysed, verdict, error)
    return ComputedFolder(task, analysed, verdict)


def _taken_in(
    connection: sqlite3.Connection, folder: Path, analyses: Analyses, now_utc: str
) -> FolderTask:
    folder = local_path(folder).resolve()
    last_row = row_of(connection, folder)
    contents = read_contents(folder, {} if last_row is None else stamps(connection, last_row["id"]))
    with connection:
        connection.execute("BEGIN IMMEDIATE")  # others may add the same folder meanwhile
        state = file_contents(connection, contents, now_utc)
        row = row_of(connection, folder)
        assert row is not None  # noqa: S101 - it was written above
        key: int = row["id"]
        connection.execute("UPDATE campaigns SET seen_utc = ? WHERE id = ?", (now_utc, key))
        file_stamps(connection, key, contents)
        file_notes(connection, key, contents.notes)
    open_analyses = Analyses(
        None if row["analysed"] else analyses.analyse,
        None if row["diagnosed"] else analyses.diagnose,
    )
    added_folder = AddedFolder(folder, contents.campaign.name, state, len(contents.records), (), ())
    return FolderTask(added_folder, key, contents.stamps, open_analyses)


def note_run(connection: sqlite3.Connection, run: Mapping[str, Any], note: NoteLine) -> Path:
    """Write a note to the folder of a run and take it into the archive; return the file.

    Parameters
    ----------
    run
        As :func:`pmm.archive.queries.the_run` finds it.

    Raises
    ------
    ConfigurationError
        As :func:`pmm.archive.notebook.write_note`; or if the folder lies elsewhere.
    DataError
        If the folder vanished.
    """
    folder, key = Path(run["folder"]), run["campaign_id"]
    if url := url_of(folder):
        raise ConfigurationError(f"{url}: what lies elsewhere is only read; write the note there")
    if not folder.is_dir():
        raise DataError(f"{folder}: the folder vanished; add it from where it is now")
    path = folder / NOTES_FILE
    with connection:
        connection.execute("BEGIN IMMEDIATE")  # an archive that cannot be written gets no note
        write_note(folder, note)
        file_notes(connection, key, read_notes(folder))
        connection.execute(
            "INSERT OR REPLACE INTO files VALUES (?, ?, ?, ?, ?)",
            (key, NOTES_FILE, *astuple(stamp(path))),
        )
    return path


def _keep_results(connection: sqlite3.Connection, outcome: ComputedFolder) -> AddedFolder:
    """Keep what was computed of a folder that is still as it was."""
    task, computed = outcome.task, []
    if folder_changes := changes(task.added.folder, task.stamps):
        raise DataError(
            f"{task.added.folder}: {'; '.join(folder_changes)} while it was analysed; add it again"
        )
    with connection:
        if outcome.analysed is not None:
            file_results(connection, task.key, outcome.analysed)
            computed.append("analysis")
        if outcome.verdict is not None:
            row = (task.key, *astuple(outcome.verdict))
            connection.execute("INSERT OR REPLACE INTO verdicts VALUES (?, ?, ?, ?)", row)
            connection.execute("UPDATE campaigns SET diagnosed = 1 WHERE id = ?", (task.key,))
            computed.append("diagnosis")
    if outcome.error is not None:
        raise outcome.error
    refusals = () if outcome.analysed is None else outcome.analysed.refused
    return replace(task.added, computed=tuple(computed), refused=refusals)
