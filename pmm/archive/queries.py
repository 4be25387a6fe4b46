"""What the archive answers: campaigns, runs by condition, one run, trends, all harmonics."""

import sqlite3
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError, DataError
from pmm.archive.contents import changes
from pmm.archive.control_chart import ChartPoint, control_chart
from pmm.archive.expression import NUMBER, TEXT, KnownColumn, read_condition
from pmm.archive.indexing import stamps

_OF_CAMPAIGN: Final = ("folder", "campaign", "hull")
_OF_RUN: Final = {
    "run": TEXT, "kind": TEXT, "outcome": TEXT, "repeat": NUMBER, "frequency_hz": NUMBER,
    "eccentricity_m": NUMBER, "strut_phase_rad": NUMBER, "carriage_speed_m_s": NUMBER,
    "medium": TEXT, "drift_rad": NUMBER, "recording": TEXT, "sha256": TEXT, "recorded_utc": TEXT,
}  # fmt: skip
RUN_COLUMNS: Final = {
    **{name: KnownColumn(f"campaigns.{name}", TEXT) for name in _OF_CAMPAIGN},
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
_RUNS: Final = "runs JOIN campaigns ON campaigns.id = runs.campaign"
_IN_ORDER: Final = " ORDER BY campaigns.folder, runs.id"
Row = Mapping[str, Any]


def _rows(connection: sqlite3.Connection, sql: str, values: Sequence[object] = ()) -> list[Row]:
    return [dict(one) for one in connection.execute(sql, values)]


def _select(columns: Mapping[str, KnownColumn]) -> str:
    return "SELECT " + ", ".join(f"{one.sql} AS {name}" for name, one in columns.items())


def campaigns(connection: sqlite3.Connection) -> list[Row]:
    """Return all campaigns, each with what is not as it was when it was added."""
    rows = _rows(
        connection,
        "SELECT id, folder, campaign, hull, recorded_utc, sha256, analysed, diagnosed, "
        "(SELECT count(*) FROM runs WHERE campaign = campaigns.id) AS runs, "
        "(SELECT count(*) FROM runs WHERE campaign = campaigns.id AND recording IS NOT NULL) "
        "AS recorded, "
        "(SELECT verdict FROM verdicts WHERE campaign = campaigns.id) AS verdict, "
        "(SELECT answer FROM verdicts WHERE campaign = campaigns.id) AS answer, "
        "(SELECT probability FROM verdicts WHERE campaign = campaigns.id) AS probability "
        "FROM campaigns ORDER BY folder",
    )
    return [{**row, **_found_now(connection, row)} for row in rows]


def _found_now(connection: sqlite3.Connection, row: Row) -> Row:
    refused = _rows(connection, "SELECT text FROM refusals WHERE campaign = ?", (row["id"],))
    return {
        "changes": list(changes(Path(row["folder"]), stamps(connection, row["id"]))),
        "refused": [one["text"] for one in refused],
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
    condition = read_condition(expression, columns)
    if channel is None:
        sql = f"{_select(columns)} FROM {_RUNS} WHERE {condition.sql}{_IN_ORDER}"
        return _rows(connection, sql, condition.parameters)
    _check_channel(connection, channel)
    sql = (
        f"{_select(columns)} FROM harmonics JOIN runs ON runs.id = harmonics.run "
        "JOIN campaigns ON campaigns.id = runs.campaign "
        f"WHERE harmonics.channel = ? AND harmonics.ord = ? AND {condition.sql}"
        f"{_IN_ORDER}, harmonics.gate"
    )
    return _rows(connection, sql, (channel, order, *condition.parameters))


def _check_channel(connection: sqlite3.Connection, channel: str) -> None:
    names = [one["channel"] for one in _rows(connection, "SELECT DISTINCT channel FROM harmonics")]
    if channel not in names:
        raise ConfigurationError(f"no channel {channel!r}; {_there('channels', channel, names)}")


def _there(what: str, name: str, names: Sequence[str]) -> str:
    if not names:
        return "nothing is analysed yet: pmm archive add FOLDER... --analyse"
    near = get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}{what}: {', '.join(sorted(names))}"


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
    found = _rows(
        connection,
        f"{_select(RUN_COLUMNS)}, runs.id AS id, campaigns.id AS campaign_id FROM {_RUNS} "
        f"WHERE runs.run = ?{_IN_ORDER}",
        (name,),
    )
    if campaign is not None:
        folder = str(Path(campaign).resolve())
        found = [one for one in found if campaign == one["campaign"] or folder == one["folder"]]
    if not found:
        names = [one["run"] for one in _rows(connection, "SELECT DISTINCT run FROM runs")]
        near = get_close_matches(name, names, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}?" if near else "pmm archive find lists them"
        where = "" if campaign is None else f" of campaign {campaign!r}"
        raise ConfigurationError(f"no run {name!r}{where}; {hint}")
    if len(found) > 1:
        folders = ", ".join(one["folder"] for one in found)
        raise ConfigurationError(f"several runs {name!r}; say which with --campaign: {folders}")
    return found[0]


@dataclass(frozen=True)
class ShownRun:
    """All that is known of a run: its set-point and file, its harmonics, its notes."""

    run: Row
    harmonics: list[Row]
    notes: list[Row]


def show_run(connection: sqlite3.Connection, name: str, campaign: str | None) -> ShownRun:
    """Return one run; it raises what :func:`the_run` raises."""
    run = the_run(connection, name, campaign)
    harmonics = _rows(
        connection,
        'SELECT gate, channel, ord AS "order", unit, in_phase, quadrature, in_phase_half_width, '
        "quadrature_half_width FROM harmonics WHERE run = ? ORDER BY gate, channel, ord",
        (run["id"],),
    )
    notes = _rows(
        connection,
        "SELECT time_utc, run, author, text FROM notes WHERE campaign = ? AND run IN (?, '') "
        "ORDER BY time_utc, rowid",
        (run["campaign_id"], name),
    )
    told = {key: value for key, value in run.items() if key in RUN_COLUMNS}
    return ShownRun(told, harmonics, notes)


@dataclass(frozen=True)
class Trend:
    """A coefficient over time, of one model at one speed and frequency, with its control chart."""

    name: str
    hull: str
    unit: str
    speed_m_s: float
    frequency_hz: float
    rows: tuple[Row, ...]
    chart: tuple[ChartPoint, ...]


def trends(connection: sqlite3.Connection, name: str, probability: float) -> tuple[Trend, ...]:
    """Return a coefficient's values, earliest first, a trend for what can be compared.

    Speeds are the same within 1 mm/s, frequencies within 0.1 mHz.

    Raises
    ------
    DataError
        If no campaign has it; the message names the nearest and all.
    """
    rows = _rows(
        connection,
        "SELECT campaigns.recorded_utc, campaigns.campaign, campaigns.folder, campaigns.hull, "
        "coefficients.unit, speed_m_s, frequency_hz, value, standard_uncertainty, half_width "
        "FROM coefficients JOIN campaigns ON campaigns.id = coefficients.campaign "
        "WHERE name = ? AND value IS NOT NULL ORDER BY campaigns.recorded_utc, campaigns.folder",
        (name,),
    )
    if not rows:
        names = [one["name"] for one in _rows(connection, "SELECT DISTINCT name FROM coefficients")]
        raise DataError(f"no coefficient {name!r}; {_there('coefficients', name, names)}")
    groups: dict[tuple[str, str, float, float], list[Row]] = defaultdict(list)
    for row in rows:
        key = (row["hull"], row["unit"], round(row["speed_m_s"], 3), round(row["frequency_hz"], 4))
        groups[key].append(row)
    return tuple(
        Trend(name, *key, tuple(found), control_chart([one["value"] for one in found], probability))
        for key, found in sorted(groups.items())
    )


def all_harmonics(connection: sqlite3.Connection) -> list[Row]:
    """Return every harmonic with its run's set-point, for files."""
    columns = {
        name: one
        for name, one in (RUN_COLUMNS | HARMONIC_COLUMNS).items()
        if name not in ("sha256", "amplitude")
    }
    return _rows(
        connection,
        f'{_select(columns)}, harmonics.channel, harmonics.ord AS "order" FROM harmonics '
        "JOIN runs ON runs.id = harmonics.run JOIN campaigns ON campaigns.id = runs.campaign"
        f"{_IN_ORDER}, gate, channel, ord",
    )
