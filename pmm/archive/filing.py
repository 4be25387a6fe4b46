"""Rows of the archive: what a folder holds and what was computed of it, each kept once."""

import sqlite3
from collections.abc import Iterable, Mapping
from dataclasses import astuple
from pathlib import Path

from hardware.description.errors import DataError
from pmm.archive.contents import Contents, Stamp, recorded_utc
from pmm.archive.notebook import NoteLine
from pmm.archive.repeats import settings_of
from pmm.archive.results import LEVEL, AnalysedCampaign, HarmonicValue
from pmm.remote import url_of


def file_contents(connection: sqlite3.Connection, contents: Contents, now_utc: str) -> str:
    """Give a folder a row for what it holds now; return its state.

    One that holds what a folder held that is gone is that folder, moved.

    Raises
    ------
    DataError
        If it holds what another one holds: a copy is no new measurement.
    """
    row = row_of(connection, contents.folder)
    if row is not None and row["sha256"] == contents.sha256:
        return "as before"
    if row is not None:
        connection.execute("DELETE FROM campaigns WHERE id = ?", (row["id"],))
        _insert(connection, contents, now_utc)
        return "changed"
    alike = connection.execute(
        "SELECT id, folder FROM campaigns WHERE sha256 = ? ORDER BY id", (contents.sha256,)
    )
    for key, place in alike:
        if url_of(place) is not None or Path(place).exists():
            raise DataError(
                f"{contents.folder}: a copy of {place}, which the archive has: the same files are "
                "no new measurement"
            )
        connection.execute(
            "UPDATE campaigns SET folder = ? WHERE id = ?", (str(contents.folder), key)
        )
        return "moved"
    _insert(connection, contents, now_utc)
    return "new"


def row_of(connection: sqlite3.Connection, folder: Path) -> sqlite3.Row | None:
    """Return the row of a folder; ``None`` where the archive has none."""
    row: sqlite3.Row | None = connection.execute(
        "SELECT * FROM campaigns WHERE folder = ?", (str(folder),)
    ).fetchone()
    return row


def stamps(connection: sqlite3.Connection, campaign: int) -> Mapping[str, Stamp]:
    """Return the files of a campaign as they were seen."""
    rows = connection.execute(
        "SELECT path, bytes, mtime_ns, sha256 FROM files WHERE campaign = ?", (campaign,)
    )
    return {path: Stamp(*rest) for path, *rest in rows}


def _insert(connection: sqlite3.Connection, contents: Contents, now_utc: str) -> None:
    campaign = contents.campaign
    runs = contents.records
    places = [contents.recording(run) for run in runs]
    times = [None if place is None else recorded_utc(contents.folder / place) for place in places]
    first = min((time for time in times if time is not None), default=None)
    key = connection.execute(
        "INSERT INTO campaigns (folder, campaign, hull, recorded_utc, seen_utc, sha256) "
        "VALUES (?, ?, ?, ?, ?, ?)",
        (str(contents.folder), campaign.name, campaign.model_name, first, now_utc,
         contents.sha256),
    ).lastrowid  # fmt: skip
    rows = []
    for run, place, time in zip(runs, places, times, strict=True):
        set_point = run.set_point
        rows.append(
            (key, run.name, str(run.kind), run.outcome, run.repeat, set_point.frequency_hz,
             set_point.eccentricity_m, set_point.strut_phase_rad, set_point.carriage_speed_m_s,
             str(set_point.medium), set_point.drift_rad, place,
             None if place is None else contents.stamps[place].sha256, time, settings_of(run))
        )  # fmt: skip
    connection.executemany(
        "INSERT INTO runs (campaign, run, kind, outcome, repeat, frequency_hz, eccentricity_m, "
        "strut_phase_rad, carriage_speed_m_s, medium, drift_rad, recording, sha256, recorded_utc, "
        "settings) VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        rows,
    )


def file_stamps(connection: sqlite3.Connection, key: int, contents: Contents) -> None:
    """File the stamps of a folder in place of those that a campaign had."""
    rows = [(key, path, *astuple(stamp)) for path, stamp in contents.stamps.items()]
    connection.execute("DELETE FROM files WHERE campaign = ?", (key,))
    connection.executemany("INSERT INTO files VALUES (?, ?, ?, ?, ?)", rows)


def file_notes(connection: sqlite3.Connection, key: int, notes: Iterable[NoteLine]) -> None:
    """File notes in place of those that a campaign had."""
    rows = [(key, *astuple(note)) for note in notes]
    connection.execute("DELETE FROM notes WHERE campaign = ?", (key,))
    connection.executemany("INSERT INTO notes VALUES (?, ?, ?, ?, ?)", rows)


def file_results(connection: sqlite3.Connection, key: int, result: AnalysedCampaign) -> None:
    """File harmonics, coefficients and refusals in place of those that a campaign had."""
    ids = dict(connection.execute("SELECT run, id FROM runs WHERE campaign = ?", (key,)))
    for table in ("harmonics", "coefficients", "refusals"):  # others may have computed them too
        connection.execute(f"DELETE FROM {table} WHERE campaign = ?", (key,))  # noqa: S608
    connection.executemany(
        "INSERT INTO harmonics VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
        _harmonic_rows(key, ids, result.harmonics),
    )
    connection.executemany(
        "INSERT INTO coefficients VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?)",
        [(key, *astuple(coefficient), LEVEL) for coefficient in result.coefficients],
    )
    connection.executemany(
        "INSERT INTO refusals VALUES (?, ?)", [(key, text) for text in result.refused]
    )
    connection.execute("UPDATE campaigns SET analysed = 1 WHERE id = ?", (key,))


def _harmonic_rows(
    key: int, ids: Mapping[str, int], values: Iterable[HarmonicValue]
) -> Iterable[tuple[object, ...]]:
    for harmonic in values:
        name, *rest = astuple(harmonic)
        yield (key, ids[name], *rest)
