"""One folder into the archive."""

import sqlite3
from pathlib import Path

from pmm.archive.indexing import AddedFolder, add_folders
from pmm.archive.results import Analyses
from pmm.parallel import InThisProcess


def add_folder(
    connection: sqlite3.Connection, folder: Path, analyses: Analyses, now_utc: str
) -> AddedFolder:
    """Take a folder in, in this process; what it is refused with is raised."""
    (outcome,) = add_folders(connection, [folder], analyses, now_utc, InThisProcess())
    if not isinstance(outcome, AddedFolder):
        raise outcome
    return outcome
