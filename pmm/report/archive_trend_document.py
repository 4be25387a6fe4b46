"""What ``pmm archive trend`` shows: values over time, with their control charts."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from pmm.archive.trends import FEWEST, ChartPoint, Trend
from pmm.document.content import Column, Data, Document, Figure, Note, Notes, Section, Table, Text
from pmm.document.notation import NOT_KNOWN, rounded
from pmm.report.archive_document import SCHEMA, day
from pmm.report.archive_figure import trend_figure


class _TrendRow(NamedTuple):
    trend: Trend
    row: Mapping[str, Any]
    point: ChartPoint


def trend_document(trends: tuple[Trend, ...], probability: float) -> Document:
    """Return a coefficient, or a harmonic of a repeated run, over time with its control chart."""
    name = trends[0].name.removesuffix(", in phase")
    several = len({trend.name for trend in trends}) > 1
    units = {trend.unit for trend in trends}
    rows = [
        _TrendRow(trend, row, point)
        for trend in trends
        for row, point in zip(trend.rows, trend.chart, strict=True)
    ]

    def of_row(heading: str | None, key: str) -> Column[_TrendRow]:
        return Column(heading, lambda entry: entry.row[key], key)

    columns: tuple[Column[_TrendRow], ...] = (
        of_row("hull", "hull"),
        Column("U", lambda entry: entry.trend.speed_m_s, "speed_m_s", "{:.4g}".format, "m/s",
               number=True),
        Column("f", lambda entry: entry.trend.frequency_hz, "frequency_hz", "{:.4g}".format, "Hz",
               number=True),
        Column("recorded", lambda entry: entry.row["recorded_utc"], "recorded_utc", day),
        of_row("campaign", "campaign"),
        *((of_row("run", "run"),) if "run" in trends[0].rows[0] else ()),
        Column("", lambda entry: entry.trend.name.rpartition(", ")[2] if several else "", "part"),
        Column("value" if several else name,
               lambda entry: rounded(entry.row["value"], entry.row["half_width"] or 0.0),
               unit=trends[0].unit if len(units) == 1 else "", number=True),
        of_row(None if len(units) == 1 else "unit", "unit"),
        Column("limits", lambda entry: f"{entry.point.low:.4g} to {entry.point.high:.4g}"
               if entry.point.low == entry.point.low else NOT_KNOWN, number=True),
        Column("", lambda entry: "outside" if entry.point.outside else ""),
        *(of_row(None, key) for key in ("folder", "value", "standard_uncertainty", "half_width")),
        Column(None, lambda entry: entry.point.low, "low"),
        Column(None, lambda entry: entry.point.high, "high"),
        Column(None, lambda entry: entry.point.outside, "outside"),
    )  # fmt: skip
    contents = (
        Table("Trend", columns, rows, "trend"),
        Data("name", name),
        Data("probability", probability),
        Notes(list(_outlier_notes(rows, probability))),
        Text(list(_too_few(trends)), faint=True),
    )
    figures = Section("Figures", tuple(trend_figures(trends)))
    return Document(name, "trend", (Section("", contents), figures), f"{SCHEMA}-trend")


def _outlier_notes(rows: list[_TrendRow], probability: float) -> Iterator[Note]:
    for entry in rows:
        if entry.point.outside:
            yield Note(
                "outside",
                f"{entry.row['campaign']} ({day(entry.row['recorded_utc'])}): {entry.trend.name} "
                f"{entry.row['value']:.4g} "
                f"is not within {entry.point.low:.4g} to {entry.point.high:.4g}, where the "
                f"others let it be expected with {100.0 * probability:g} %",
            )


def _too_few(trends: tuple[Trend, ...]) -> Iterator[str]:
    few = sum(len(trend.rows) < FEWEST for trend in trends)
    if few:
        yield f"limits take {FEWEST} of one hull, speed and frequency"


def trend_figures(trends: tuple[Trend, ...]) -> Iterator[Figure]:
    """Yield a figure for each hull, speed and frequency."""
    caption = (
        "Each value with its interval, and the limits that the others set for it; what lies "
        "outside is marked."
    )
    for k, trend in enumerate(trends, 1):
        name = f"trend-{k}" if len(trends) > 1 else "trend"
        yield Figure(name, caption, lambda trend=trend: trend_figure(trend))  # type: ignore[misc]
