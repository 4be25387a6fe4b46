"""What the archive answers: campaigns, runs and coefficients by condition, one run."""

import sqlite3
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from pmm.archive.contents import changes
from pmm.archive.expression import NUMBER, TEXT, KnownColumn, read_condition
from pmm.archive.filing import stamps
from pmm.archive.results import LEVEL
from pmm.remote import local_path
from pmm.whole_file import write_whole

_OF_CAMPAIGN: Final = ("folder", "campaign", "hull")
_OF_RUN: Final = {
    "run": TEXT, "kind": TEXT, "outcome": TEXT, "repeat": NUMBER, "frequency_hz": NUMBER,
    "eccentricity_m": NUMBER, "strut_phase_rad": NUMBER, "carriage_speed_m_s": NUMBER,
    "medium": TEXT, "drift_rad": NUMBER, "recording": TEXT, "sha256": TEXT, "recorded_utc": TEXT,
}  # fmt: skip
_CAMPAIGN_COLUMNS: Final = {
    **{name: KnownColumn(f"campaigns.{name}", TEXT) for name in _OF_CAMPAIGN},
    "verdict": KnownColumn("verdicts.verdict", TEXT),
    "answer": KnownColumn("verdicts.answer", TEXT),
    "probability": KnownColumn("verdicts.probability", NUMBER),
}
RUN_COLUMNS: Final = {
    **_CAMPAIGN_COLUMNS,
    **{name: KnownColumn(f"runs.{name}", kind) for name, kind in _OF_RUN.items()},
}
_AMPLITUDE: Final = (
    "sqrt(harmonics.in_phase * harmonics.in_phase + harmonics.quadrature * harmonics.quadrature)"
)
HARMONIC_COLUMNS: Final = {
    "gate": KnownColumn("harmonics.gate", NUMBER),
    "unit": KnownColumn("harmonics.unit", TEXT),
    "in_phase": KnownColumn("harmonics.in_phase", NUMBER),
    "quadrature": KnownColumn("harmonics.quadrature", NUMBER),
    "in_phase_half_width": KnownColumn("harmonics.in_phase_half_width", NUMBER),
    "quadrature_half_width": KnownColumn("harmonics.quadrature_half_width", NUMBER),
    "amplitude": KnownColumn(_AMPLITUDE, NUMBER),
}
FILED_HARMONICS: Final = {
    **{name: column for name, column in RUN_COLUMNS.items() if name != "sha256"},
    **{name: column for name, column in HARMONIC_COLUMNS.items() if name != "amplitude"},
    "channel": KnownColumn("harmonics.channel", TEXT),
    "order": KnownColumn("harmonics.ord", NUMBER),
}
COEFFICIENT_COLUMNS: Final = {
    **_CAMPAIGN_COLUMNS,
    "recorded_utc": KnownColumn("campaigns.recorded_utc", TEXT),
    "coefficient": KnownColumn("coefficients.name", TEXT),
    "unit": KnownColumn("coefficients.unit", TEXT),
    **{
        name: KnownColumn(f"coefficients.{name}", NUMBER)
        for name in ("speed_m_s", "frequency_hz", "value", "standard_uncertainty", "half_width")
    },
}
# How to ask for a column that the rows in question do not have.
_ELSEWHERE: Final = {
    **dict.fromkeys(COEFFICIENT_COLUMNS, "coefficients have it: --coefficients"),
    **dict.fromkeys(HARMONIC_COLUMNS, "a channel's harmonics have it: --channel NAME"),
    "unit": "harmonics and coefficients have it: --channel NAME or --coefficients",
}
# Of tables whose rows have a campaign.
_WITH_CAMPAIGN: Final = (
    "JOIN campaigns ON campaigns.id = {0}.campaign "
    "LEFT JOIN verdicts ON verdicts.campaign = {0}.campaign"
)
_RUNS: Final = f"runs {_WITH_CAMPAIGN.format('runs')}"
_HARMONICS: Final = (
    f"harmonics JOIN runs ON runs.id = harmonics.run {_WITH_CAMPAIGN.format('runs')}"
)
_COEFFICIENTS: Final = f"coefficients {_WITH_CAMPAIGN.format('coefficients')}"
_IN_ORDER: Final = " ORDER BY campaigns.folder, runs.id"
Row = Mapping[str, Any]
_WHOLE = ("repeat", "gate", "order")


def rows_of(
    connection: sqlite3.Connection, sql: str, values: Sequence[object] | Mapping[str, object] = ()
) -> list[Row]:
    """Return the rows of a query, each by the names of its columns."""
    return [dict(row) for row in connection.execute(sql, values)]


def _select(columns: Mapping[str, KnownColumn]) -> str:
    return "SELECT " + ", ".join(f'{column.sql} AS "{name}"' for name, column in columns.items())


def campaigns(connection: sqlite3.Connection) -> list[Row]:
    """Return all campaigns, each with what is not as it was when it was added."""
    rows = rows_of(
        connection,
        "SELECT id, folder, campaigns.campaign, hull, recorded_utc, sha256, analysed, diagnosed, "
        "(SELECT count(*) FROM runs WHERE campaign = campaigns.id) AS runs, "
        "(SELECT count(*) FROM runs WHERE campaign = campaigns.id AND recording IS NOT NULL) "
        "AS recorded, "
        "verdict, answer, probability FROM campaigns "
        "LEFT JOIN verdicts ON verdicts.campaign = campaigns.id ORDER BY folder",
    )
    return [{**row, **_found_now(connection, row)} for row in rows]


def _found_now(connection: sqlite3.Connection, row: Row) -> Row:
    refusals = rows_of(connection, "SELECT text FROM refusals WHERE campaign = ?", (row["id"],))
    return {
        "changes": list(changes(Path(row["folder"]), stamps(connection, row["id"]))),
        "refused": [refusal["text"] for refusal in refusals],
    }


def find_runs(
    connection: sqlite3.Connection, expression: str, channel: str | None, order: int
) -> list[Row]:
    """Return the runs that fulfil a condition, with a harmonic of each where a channel is named.

    Raises
    ------
    ConfigurationError
        As :func:`pmm.archive.expression.read_condition`; or if no run has the channel.
    """
    columns = RUN_COLUMNS if channel is None else RUN_COLUMNS | HARMONIC_COLUMNS
    condition = read_condition(expression, columns, _ELSEWHERE)
    if channel is None:
        sql = f"{_select(columns)} FROM {_RUNS} WHERE {condition.sql}{_IN_ORDER}"
        return rows_of(connection, sql, condition.parameters)
    _check_channel(connection, channel, order)
    sql = (
        f"{_select(columns)} FROM {_HARMONICS} "
        f"WHERE harmonics.channel = ? AND harmonics.ord = ? AND {condition.sql}"
        f"{_IN_ORDER}, harmonics.gate"
    )
    return rows_of(connection, sql, (channel, order, *condition.parameters))


def find_coefficients(connection: sqlite3.Connection, expression: str) -> list[Row]:
    """Return the campaigns' coefficients that fulfil a condition.

    Raises
    ------
    ConfigurationError
        As :func:`pmm.archive.expression.read_condition`; or if no campaign has been analysed.
    """
    condition = read_condition(expression, COEFFICIENT_COLUMNS)
    rows = rows_of(
        connection,
        f"{_select(COEFFICIENT_COLUMNS)} FROM {_COEFFICIENTS} WHERE {condition.sql} "
        "ORDER BY campaigns.folder, coefficients.rowid",
        condition.parameters,
    )
    if not rows and not rows_of(connection, "SELECT 1 FROM coefficients LIMIT 1"):
        raise ConfigurationError(what_is_there("coefficients", "", ()))
    return rows


def _check_channel(connection: sqlite3.Connection, channel: str, order: int) -> None:
    where = "SELECT DISTINCT ord FROM harmonics WHERE channel = ? ORDER BY ord"
    orders = [row["ord"] for row in rows_of(connection, where, (channel,))]
    if orders and order not in orders:
        there = ", ".join(map(str, orders))
        raise ConfigurationError(f"no harmonic {order} of {channel}; there are: {there}")
    if not orders:
        rows = rows_of(connection, "SELECT DISTINCT channel FROM harmonics")
        hint = what_is_there("channels", channel, [row["channel"] for row in rows])
        raise ConfigurationError(f"no channel {channel!r}; {hint}")


def what_is_there(kind: str, name: str, names: Sequence[str]) -> str:
    """Return what there is instead of a name, the nearest first."""
    if not names:
        return "nothing is analysed yet: pmm archive add FOLDER... --analyse"
    near = get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}{kind}: {', '.join(sorted(names))}"


def the_run(connection: sqlite3.Connection, name: str, campaign: str | None) -> Row:
    """Return a run by its name, with the keys of run and campaign.

    Parameters
    ----------
    campaign
        Name or folder of its campaign; needed where several have such a run.

    Raises
    ------
    ConfigurationError
        If there is none, or there are several.
    """
    rows = rows_of(
        connection,
        f"{_select(RUN_COLUMNS)}, runs.id AS id, campaigns.id AS campaign_id FROM {_RUNS} "
        f"WHERE runs.run = ?{_IN_ORDER}",
        (name,),
    )
    if campaign is not None:
        folder = str(local_path(campaign).resolve())
        rows = [row for row in rows if campaign == row["campaign"] or folder == row["folder"]]
    others = [] if campaign is None else connection.execute(
        "SELECT DISTINCT campaigns.campaign FROM runs JOIN campaigns "
        "ON campaigns.id = runs.campaign WHERE run = ? ORDER BY 1", (name,)
    ).fetchall()  # fmt: skip
    if not rows and others:
        there = ", ".join(row[0] for row in others)
        raise ConfigurationError(f"no run {name!r} of campaign {campaign!r}, but of: {there}")
    if not rows:
        names = [row["run"] for row in rows_of(connection, "SELECT DISTINCT run FROM runs")]
        near = get_close_matches(name, names, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}?" if near else "pmm archive find lists them"
        raise ConfigurationError(f"no run {name!r}; {hint}")
    if len(rows) > 1:
        folders = ", ".join(row["folder"] for row in rows)
        raise ConfigurationError(f"several runs {name!r}; say which with --campaign: {folders}")
    return rows[0]


@dataclass(frozen=True)
class ShownRun:
    """All that is known of a run: its set-point and file, its harmonics, its notes."""

    run: Row
    harmonics: list[Row]
    notes: list[Row]


def show_run(connection: sqlite3.Connection, name: str, campaign: str | None) -> ShownRun:
    """Return one run; it raises what :func:`the_run` raises."""
    run = the_run(connection, name, campaign)
    harmonics = rows_of(
        connection,
        'SELECT gate, channel, ord AS "order", unit, in_phase, quadrature, in_phase_half_width, '
        "quadrature_half_width FROM harmonics WHERE run = ? ORDER BY gate, channel, ord",
        (run["id"],),
    )
    notes = rows_of(
        connection,
        "SELECT time_utc, run, author, text FROM notes WHERE campaign = ? AND run IN (?, '') "
        "ORDER BY time_utc, rowid",
        (run["campaign_id"], name),
    )
    columns = {key: value for key, value in run.items() if key in RUN_COLUMNS}
    return ShownRun(columns, harmonics, notes)


def all_harmonics(connection: sqlite3.Connection) -> list[Row]:
    """Return every harmonic with its run's set-point: :data:`FILED_HARMONICS`."""
    return rows_of(
        connection,
        f"{_select(FILED_HARMONICS)} FROM {_HARMONICS}"
        f"{_IN_ORDER}, harmonics.gate, harmonics.channel, harmonics.ord",
    )


def write_parquet(columns: Mapping[str, KnownColumn], rows: Sequence[Row], path: Path) -> None:
    """Write rows; what is not known is null, the intervals' level is in the metadata."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    def kind(name: str) -> pa.DataType:
        if name in _WHOLE:
            return pa.int32()
        return pa.float64() if columns[name].kind == NUMBER else pa.string()

    schema = pa.schema([(name, kind(name)) for name in columns], {"level": repr(LEVEL)})
    file = BytesIO()
    pq.write_table(pa.Table.from_pylist([dict(row) for row in rows], schema), file)
    write_whole(path, file.getvalue())
