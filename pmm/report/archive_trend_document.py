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


def trend_document(found: tuple[Trend, ...], probability: float) -> Document:
    """Return a coefficient, or a harmonic of a repeated run, over time with its control chart."""
    name = found[0].name.removesuffix(", in phase")
    several = len({one.name for one in found}) > 1
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
        Column("recorded", lambda one: one.row["recorded_utc"], "recorded_utc", day),
        of_row("campaign", "campaign"),
        *((of_row("run", "run"),) if "run" in found[0].rows[0] else ()),
        Column("", lambda one: one.trend.name.rpartition(", ")[2] if several else "", "part"),
        Column("value" if several else name,
               lambda one: rounded(one.row["value"], one.row["half_width"] or 0.0),
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
                f"{one.row['campaign']} ({day(one.row['recorded_utc'])}): {one.trend.name} "
                f"{one.row['value']:.4g} "
                f"is not within {one.point.low:.4g} to {one.point.high:.4g}, where the "
                f"others let it be expected with {100.0 * probability:g} %",
            )


def _too_few(found: tuple[Trend, ...]) -> Iterator[str]:
    few = sum(len(one.rows) < FEWEST for one in found)
    if few:
        yield f"limits take {FEWEST} of one hull, speed and frequency"


def trend_figures(found: tuple[Trend, ...]) -> Iterator[Figure]:
    """Yield a figure for each hull, speed and frequency."""
    caption = (
        "Each value with its interval, and the limits that the others set for it; what lies "
        "outside is marked."
    )
    for k, one in enumerate(found, 1):
        name = f"trend-{k}" if len(found) > 1 else "trend"
        yield Figure(name, caption, lambda one=one: trend_figure(one))  # type: ignore[misc]
