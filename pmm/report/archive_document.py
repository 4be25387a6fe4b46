"""What ``pmm archive`` shows: campaigns, what was found, one run."""

from collections.abc import Iterator
from dataclasses import asdict
from operator import itemgetter
from pathlib import Path
from typing import Any, Final

from pmm.archive.indexing import AddedFolder
from pmm.archive.notebook import read_notes
from pmm.archive.queries import COEFFICIENT_COLUMNS, HARMONIC_COLUMNS, RUN_COLUMNS, Row, ShownRun
from pmm.archive.results import LEVEL
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Note,
    Notes,
    Section,
    Table,
    Text,
    number,
    pairs,
    word,
)
from pmm.document.notation import NOT_KNOWN, counted, rounded
from pmm.remote import url_of

SCHEMA: Final = "pmm-archive-1"
_MOST: Final = 100  # rows for people; JSON holds all
_STATES: Final = {True: "analysed", False: "not analysed"}


def _document(name: str, about: str, *contents: Content) -> Document:
    return Document(name, about, (Section("", contents),), f"{SCHEMA}-{about.replace(' ', '-')}")


def _cell(
    heading: str, key: str, unit: str = "", *, form: str = "", once: bool = False
) -> Column[Row]:
    def written(value: Any) -> str:
        return NOT_KNOWN if value is None else f"{value:{form}}"

    return Column(heading, itemgetter(key), key, written, unit, number=bool(form), once=once)


def _data(*keys: str) -> tuple[Column[Row], ...]:
    return tuple(Column(None, itemgetter(key), key) for key in keys)


_NOTES: Final = (
    _cell("time", "time_utc"),
    _cell("run", "run"),
    _cell("author", "author"),
    _cell("note", "text"),
)


def added_document(added: tuple[AddedFolder, ...], archive: str) -> Document:
    """Return what was done with each folder."""
    columns: tuple[Column[AddedFolder], ...] = (
        word("campaign", "campaign"),
        word("folder", "folder"),
        word("", "state"),
        number("runs", "runs"),
        word("computed", "computed", ", ".join),
        Column(None, lambda row: row.refused, "refused"),
    )
    refused = [
        Note("not found", f"{folder.campaign}: {text}")
        for folder in added
        for text in folder.refused
    ]
    return _document(
        archive,
        "folders added",
        Table("Folders", columns, added, "added"),
        Notes(refused),
        Text([] if added else ["no folder was added"]),
    )


def list_document(rows: list[Row], archive: str) -> Document:
    """Return the campaigns, with what changed since they were added."""
    columns: tuple[Column[Row], ...] = (
        _cell("campaign", "campaign"),
        _cell("hull", "hull"),
        Column("recorded", itemgetter("recorded_utc"), "recorded_utc", day),
        Column("runs", lambda row: f"{row['recorded']} of {row['runs']}", number=True),
        Column("", lambda row: _STATES[bool(row["analysed"])]),
        Column("gap", _gap),
        Column("folder", itemgetter("folder"), "folder", _short),
        Column(None, lambda row: bool(row["analysed"]), "analysed"),
        Column(None, lambda row: bool(row["diagnosed"]), "diagnosed"),
        *_data("runs", "recorded", "sha256", "verdict", "answer", "probability", "changes",
               "refused"),
    )  # fmt: skip
    return _document(
        archive,
        "campaigns",
        Table("Campaigns", columns, rows, "campaigns"),
        Notes(list(_warnings(rows))),
        Text([] if rows else ["no campaigns yet: pmm archive add FOLDER..."]),
    )


def _warnings(rows: list[Row]) -> Iterator[Note]:
    for row in rows:
        if row["changes"]:
            changes = "; ".join(row["changes"])
            yield Note("changed", f"{row['folder']}: {changes}; what is told is of before")
        for text in row["refused"]:
            yield Note("not found", f"{row['campaign']}: {text}")


def day(time_utc: str | None) -> str:
    """Return the date of a time in ISO 8601, or that it is not known."""
    return NOT_KNOWN if time_utc is None else time_utc[:10]


def _short(folder: str) -> str:
    path, working_folder = Path(folder), Path.cwd()
    if url := url_of(path):
        return url
    return str(path.relative_to(working_folder)) if path.is_relative_to(working_folder) else folder


def _gap(row: Row) -> str:
    if not row["diagnosed"]:
        return ""
    answer = "" if row["answer"] in (None, row["verdict"]) else f": {row['answer']}"
    likely = "" if row["probability"] is None else f" ({100.0 * row['probability']:.0f} %)"
    return f"{row['verdict']}{answer}{likely}"


def find_document(
    rows: list[Row], expression: str, channel: str | None, order: int, archive: str
) -> Document:
    """Return the runs that were found, and a harmonic of each where one is asked for."""
    about_run = (_cell("kind", "kind"), _cell("medium", "medium"))
    columns = (
        _cell("campaign", "campaign", once=True),
        _cell("hull", "hull", once=True),
        _cell("run", "run"),
        _cell("f", "frequency_hz", "Hz", form=".4g"),
        _cell("r", "eccentricity_m", "m", form=".4g"),
        _cell("U", "carriage_speed_m_s", "m/s", form=".4g"),
        *(about_run if channel is None else _harmonic_cells()),
    )
    names = RUN_COLUMNS if channel is None else RUN_COLUMNS | HARMONIC_COLUMNS
    rest = _data(*(name for name in names if name not in {column.key for column in columns}))
    summary = f"{counted(len(rows), 'run' if channel is None else 'value')}: {expression}"
    if channel is not None:
        summary += f"; {channel}, order {order}"
    cut = f"the first {_MOST} are shown; --json has all" if len(rows) > _MOST else ""
    return _document(
        archive,
        "runs found",
        Table("Runs", (*columns, *rest), rows, "runs", most=_MOST),
        Text([summary, cut] if cut else [summary]),
        Data("expression", expression),
        Data("channel", channel),
        Data("order", None if channel is None else order),
    )


def coefficients_found_document(rows: list[Row], expression: str, archive: str) -> Document:
    """Return the coefficients that were found, each with its campaign."""
    columns = (
        _cell("campaign", "campaign", once=True),
        _cell("hull", "hull", once=True),
        _cell("coefficient", "coefficient"),
        _cell("U", "speed_m_s", "m/s", form=".4g"),
        _cell("f", "frequency_hz", "Hz", form=".4g"),
        Column("value", _interval("value", "half_width"), number=True),
        _cell("unit", "unit"),
    )
    rest = _data(
        *(name for name in COEFFICIENT_COLUMNS if name not in {column.key for column in columns})
    )
    lines = [f"{counted(len(rows), 'coefficient')}: {expression}"]
    lines += [f"the first {_MOST} are shown; --json has all"] if len(rows) > _MOST else []
    return _document(
        archive,
        "coefficients found",
        Table("Coefficients", (*columns, *rest), rows, "coefficients", most=_MOST),
        Text(lines),
        Data("expression", expression),
    )


def _harmonic_cells() -> tuple[Column[Row], ...]:
    return (
        _cell("gate", "gate", form="d"),
        Column("in phase", _interval("in_phase", "in_phase_half_width"), number=True),
        Column("quadrature", _interval("quadrature", "quadrature_half_width"), number=True),
        _cell("unit", "unit"),
    )


def _interval(key: str, half_width: str) -> Any:
    def interval_text(row: Row) -> str:
        if row[key] is None:
            return NOT_KNOWN
        half = row[half_width]
        return rounded(row[key], 0.0 if half is None else half)

    return interval_text


def show_document(shown_run: ShownRun) -> Document:
    """Return all that is known of a run."""
    about = {key: str(value) for key, value in shown_run.run.items() if value not in (None, "")}
    harmonics = (
        _cell("channel", "channel", once=True),
        _cell("order", "order", form="d"),
        *_harmonic_cells(),
        *_data("in_phase", "quadrature", "in_phase_half_width", "quadrature_half_width"),
    )
    return _document(
        str(shown_run.run["run"]),
        "run",
        pairs("Run", about),
        Data("run", shown_run.run),
        Table("Harmonics", harmonics, shown_run.harmonics, "harmonics", titled=True,
              notes=(f"half-widths of {100 * LEVEL:g} % intervals",)),
        Text([] if shown_run.harmonics else ["not analysed: pmm archive add FOLDER --analyse"]),
        Table("Notes", _NOTES, shown_run.notes, "notes", titled=True),
    )  # fmt: skip


def notes_story(folder: Path) -> Iterator[Section]:
    """Yield what people noted on a campaign and its runs, where they did.

    Raises
    ------
    ConfigurationError
        If a line of its file is no note.
    """
    notes = [asdict(note) for note in read_notes(folder)]
    if notes:
        yield Section("Notes", (Table("", _NOTES, notes, "notes"),))
