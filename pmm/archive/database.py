"""The archive's file: its tables, and how it is opened."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Final

from hardware.description.errors import ConfigurationError

VERSION: Final = 3
_PATIENCE_S: Final = 60.0  # while another process writes
_TABLES: Final = """
CREATE TABLE campaigns (
    id INTEGER PRIMARY KEY, folder TEXT NOT NULL UNIQUE, campaign TEXT NOT NULL,
    hull TEXT NOT NULL, recorded_utc TEXT, seen_utc TEXT NOT NULL, sha256 TEXT NOT NULL,
    analysed INTEGER NOT NULL DEFAULT 0, diagnosed INTEGER NOT NULL DEFAULT 0);
CREATE TABLE files (
    campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE,
    path TEXT NOT NULL, bytes INTEGER NOT NULL, mtime_ns INTEGER NOT NULL, sha256 TEXT NOT NULL,
    PRIMARY KEY (campaign, path));
CREATE TABLE runs (
    id INTEGER PRIMARY KEY, campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE,
    run TEXT NOT NULL, kind TEXT NOT NULL, outcome TEXT NOT NULL, repeat INTEGER NOT NULL,
    frequency_hz REAL, eccentricity_m REAL, strut_phase_rad REAL, carriage_speed_m_s REAL,
    medium TEXT NOT NULL, drift_rad REAL, recording TEXT, sha256 TEXT, recorded_utc TEXT,
    settings TEXT NOT NULL,
    UNIQUE (campaign, run));
CREATE TABLE harmonics (
    campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE,
    run INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, gate INTEGER NOT NULL,
    channel TEXT NOT NULL, ord INTEGER NOT NULL, unit TEXT NOT NULL,
    in_phase REAL, quadrature REAL, in_phase_half_width REAL, quadrature_half_width REAL);
CREATE INDEX harmonics_by_channel ON harmonics
    (channel, ord, run, gate, unit, in_phase, quadrature, in_phase_half_width,
     quadrature_half_width);
CREATE INDEX harmonics_by_campaign ON harmonics (campaign);
CREATE INDEX harmonics_by_run ON harmonics (run);
CREATE TABLE coefficients (
    campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE,
    name TEXT NOT NULL, unit TEXT NOT NULL, speed_m_s REAL, frequency_hz REAL,
    value REAL, standard_uncertainty REAL, half_width REAL, level REAL NOT NULL);
CREATE INDEX coefficients_by_name ON coefficients (name, campaign);
CREATE TABLE verdicts (
    campaign INTEGER PRIMARY KEY REFERENCES campaigns ON DELETE CASCADE,
    verdict TEXT NOT NULL, answer TEXT, probability REAL);
CREATE TABLE refusals (
    campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE, text TEXT NOT NULL);
CREATE TABLE notes (
    campaign INTEGER NOT NULL REFERENCES campaigns ON DELETE CASCADE,
    time_utc TEXT NOT NULL, run TEXT NOT NULL, author TEXT NOT NULL, text TEXT NOT NULL);
"""


@contextmanager
def open_archive(path: Path, *, create: bool = False) -> Iterator[sqlite3.Connection]:
    """Open an archive; what a ``with connection:`` in it changes is kept whole or not at all.

    Parameters
    ----------
    create
        Whether a file that is not there is made.

    Raises
    ------
    ConfigurationError
        If there is none, it is no archive, it is of another version, or another program has it.
    """
    if not path.exists() and not create:
        raise ConfigurationError(f"{path}: no archive; make one with: pmm archive add FOLDER...")
    try:
        with closing(sqlite3.connect(path, timeout=_PATIENCE_S)) as connection:
            _prepare(connection, path, create=create)
            yield connection
    except sqlite3.Error as error:
        raise ConfigurationError(
            f"{path}: {error}; if it is no archive, name another file with --archive; if it is, "
            "it can be made again from the folders alone"
        ) from error


def _prepare(connection: sqlite3.Connection, path: Path, *, create: bool) -> None:
    connection.row_factory = sqlite3.Row
    connection.execute("PRAGMA foreign_keys = ON")
    (version,) = connection.execute("PRAGMA user_version").fetchone()
    (tables,) = connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
    if version == 0 and tables == 0:
        if not create:
            raise ConfigurationError(
                f"{path}: an empty file and no archive; make one with: pmm archive add FOLDER..."
            )
        connection.executescript(f"BEGIN; {_TABLES} PRAGMA user_version = {VERSION}; COMMIT;")
    elif version != VERSION:
        raise ConfigurationError(
            f"{path}: no archive of this version of the program; name another file with "
            "--archive, and add the folders to it"
        )
