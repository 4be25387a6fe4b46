"""What ``pmm archive`` shows: campaigns, runs that were found, one run, trends."""

from collections.abc import Iterator, Mapping
from operator import itemgetter
from pathlib import Path
from typing import Any, Final, NamedTuple

from pmm.archive.control_chart import FEWEST, ChartPoint
from pmm.archive.indexing import AddedFolder
from pmm.archive.queries import HARMONIC_COLUMNS, RUN_COLUMNS, Row, ShownRun, Trend
from pmm.archive.results import LEVEL
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
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
from pmm.report.archive_figure import trend_figure

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


def added_document(added: tuple[AddedFolder, ...], archive: str) -> Document:
    """Return what was done with each folder."""
    columns: tuple[Column[AddedFolder], ...] = (
        word("campaign", "campaign"),
        word("folder", "folder"),
        word("", "state"),
        number("runs", "runs"),
        word("computed", "computed", ", ".join),
        Column(None, lambda one: one.refused, "refused"),
    )
    refused = [
        Note("not found", f"{one.campaign}: {text}") for one in added for text in one.refused
    ]
    return _document(
        archive, "folders added", Table("Folders", columns, added, "added"), Notes(refused)
    )


def list_document(rows: list[Row], archive: str) -> Document:
    """Return the campaigns, with what changed since they were added."""
    columns: tuple[Column[Row], ...] = (
        _cell("campaign", "campaign"),
        _cell("hull", "hull"),
        Column("recorded", itemgetter("recorded_utc"), "recorded_utc", _day),
        Column("runs", lambda one: f"{one['recorded']} of {one['runs']}", number=True),
        Column("", lambda one: _STATES[bool(one["analysed"])]),
        Column("gap", _gap),
        Column("folder", itemgetter("folder"), "folder", _short),
        Column(None, lambda one: bool(one["analysed"]), "analysed"),
        Column(None, lambda one: bool(one["diagnosed"]), "diagnosed"),
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
            told = "; ".join(row["changes"])
            yield Note("changed", f"{row['folder']}: {told}; what is told is of before")
        for text in row["refused"]:
            yield Note("not found", f"{row['campaign']}: {text}")


def _day(time_utc: str | None) -> str:
    return NOT_KNOWN if time_utc is None else time_utc[:10]


def _short(folder: str) -> str:
    path, here = Path(folder), Path.cwd()
    return str(path.relative_to(here)) if path.is_relative_to(here) else folder


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
    shown = (
        _cell("campaign", "campaign", once=True),
        _cell("hull", "hull", once=True),
        _cell("run", "run"),
        _cell("f", "frequency_hz", "Hz", form=".4g"),
        _cell("r", "eccentricity_m", "m", form=".4g"),
        _cell("U", "carriage_speed_m_s", "m/s", form=".4g"),
        *(about_run if channel is None else _harmonic_cells()),
    )
    every = RUN_COLUMNS if channel is None else RUN_COLUMNS | HARMONIC_COLUMNS
    rest = _data(*(name for name in every if name not in {one.key for one in shown}))
    told = f"{counted(len(rows), 'run' if channel is None else 'value')}: {expression}"
    if channel is not None:
        told += f"; {channel}, order {order}"
    cut = f"the first {_MOST} are shown; --json has all" if len(rows) > _MOST else ""
    return _document(
        archive,
        "runs found",
        Table("Runs", (*shown, *rest), rows, "runs", most=_MOST),
        Text([told, cut] if cut else [told]),
        Data("expression", expression),
        Data("channel", channel),
        Data("order", None if channel is None else order),
    )


def _harmonic_cells() -> tuple[Column[Row], ...]:
    return (
        _cell("gate", "gate", form="d"),
        Column("in phase", _interval("in_phase"), number=True),
        Column("quadrature", _interval("quadrature"), number=True),
        _cell("unit", "unit"),
    )


def _interval(key: str) -> Any:
    def told(row: Row) -> str:
        if row[key] is None:
            return NOT_KNOWN
        half = row[f"{key}_half_width"]
        return rounded(row[key], 0.0 if half is None else half)

    return told


def show_document(found: ShownRun) -> Document:
    """Return all that is known of a run."""
    about = {key: str(value) for key, value in found.run.items() if value not in (None, "")}
    harmonics = (
        _cell("channel", "channel", once=True),
        _cell("order", "order", form="d"),
        *_harmonic_cells(),
        *_data("in_phase", "quadrature", "in_phase_half_width", "quadrature_half_width"),
    )
    notes = (
        _cell("time", "time_utc"),
        _cell("run", "run"),
        _cell("author", "author"),
        _cell("note", "text"),
    )
    return _document(
        str(found.run["run"]),
        "run",
        pairs("Run", about),
        Data("run", found.run),
        Table("Harmonics", harmonics, found.harmonics, "harmonics", titled=True,
              notes=(f"half-widths of {100 * LEVEL:g} % intervals",)),
        Text([] if found.harmonics else ["not analysed: pmm archive add FOLDER --analyse"]),
        Table("Notes", notes, found.notes, "notes", titled=True),
    )  # fmt: skip


class _TrendRow(NamedTuple):
    trend: Trend
    row: Mapping[str, Any]
    point: ChartPoint


def trend_document(found: tuple[Trend, ...], probability: float) -> Document:
    """Return a coefficient over time with its control chart."""
    name = found[0].name
    rows = [
        _TrendRow(trend, row, point)
        for trend in found
        for row, point in zip(trend.rows, trend.chart, strict=True)
    ]

    def of_row(heading: str | None, key: str) -> Column[_TrendRow]:
        return Column(heading, lambda one: one.row[key], key)

    columns: tuple[Column[_TrendRow], ...] = (
        of_row("hull", "hull"),
        Column("U", lambda one: one.trend.speed_m_s, "speed_m_s", "{:.4g}".format, "m/s",
               number=True),
        Column("f", lambda one: one.trend.frequency_hz, "frequency_hz", "{:.4g}".format, "Hz",
               number=True),
        Column("recorded", lambda one: one.row["recorded_utc"], "recorded_utc", _day),
        of_row("campaign", "campaign"),
        Column(name, lambda one: rounded(one.row["value"], one.row["half_width"] or 0.0),
               unit=found[0].unit if len({one.unit for one in found}) == 1 else "", number=True),
        Column("limits", lambda one: f"{one.point.low:.4g} to {one.point.high:.4g}"
               if one.point.low == one.point.low else NOT_KNOWN, number=True),
        Column("", lambda one: "outside" if one.point.outside else ""),
        *(of_row(None, key) for key in ("folder", "unit", "value", "standard_uncertainty",
                                        "half_width")),
        Column(None, lambda one: one.point.low, "low"),
        Column(None, lambda one: one.point.high, "high"),
        Column(None, lambda one: one.point.outside, "outside"),
    )  # fmt: skip
    contents = (
        Table("Trend", columns, rows, "trend"),
        Data("name", name),
        Data("probability", probability),
        Notes(list(_outside(rows, probability))),
        Text(list(_too_few(found)), faint=True),
    )
    figures = Section("Figures", tuple(trend_figures(found)))
    return Document(name, "trend", (Section("", contents), figures), f"{SCHEMA}-trend")


def _outside(rows: list[_TrendRow], probability: float) -> Iterator[Note]:
    for one in rows:
        if one.point.outside:
            yield Note(
                "outside",
                f"{one.row['campaign']} ({_day(one.row['recorded_utc'])}): {one.row['value']:.4g} "
                f"is not within {one.point.low:.4g} to {one.point.high:.4g}, where the other "
                f"campaigns let it be expected with {100.0 * probability:g} %",
            )


def _too_few(found: tuple[Trend, ...]) -> Iterator[str]:
    few = sum(len(one.rows) < FEWEST for one in found)
    if few:
        yield f"limits take {FEWEST} campaigns of one hull, speed and frequency"


def trend_figures(found: tuple[Trend, ...]) -> Iterator[Figure]:
    """Yield a figure for each hull, speed and frequency."""
    caption = (
        "Each campaign's value with its interval, and the limits that the other campaigns set "
        "for it; what lies outside is marked."
    )
    for k, one in enumerate(found, 1):
        name = f"trend-{k}" if len(found) > 1 else "trend"
        yield Figure(name, caption, lambda one=one: trend_figure(one))  # type: ignore[misc]
