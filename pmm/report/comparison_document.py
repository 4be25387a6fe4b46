"""What is said of a comparison of two channels."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.comparison.parts import Parts
from analysis.comparison.result import ChannelComparison
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.freedom import student_factor
from pmm.document.content import Column, Content, Data, Document, Figure, Section, Table, pairs
from pmm.document.notation import rounded
from pmm.report.comparison_figure import comparison_figure
from pmm.report.harmonics_tables import noticed

SCHEMA: Final = "pmm-comparison-1"
_PPM: Final = 1e6
_MS: Final = 1e3


@dataclass(frozen=True)
class _Row:
    """One number that was found: in the unit in which people read it, with its half-width."""

    what: str
    value: float
    half_width: float
    unit: str
    meaning: str


@dataclass(frozen=True)
class _Part:
    """One part of the record, or of the frequencies."""

    at: float
    gain: float
    gain_half_width: float
    lag_s: float
    lag_half_width_s: float


_FOUND: Final[tuple[Column[_Row], ...]] = (
    Column("", lambda row: row.what),
    Column("", lambda row: rounded(row.value, row.half_width), number=True),
    Column("", lambda row: row.unit),
    Column("", lambda row: row.meaning),
)


def comparison_document(found: ChannelComparison, level: float) -> Document:
    """Return what ``pmm compare`` shows; ``docs/comparison.md`` describes the keys.

    Parameters
    ----------
    level
        Probability of the intervals.
    """
    shows = f", derivative {found.order}" if found.order else ""
    about = {
        "first": f"{found.first}{shows}",
        "second": found.second,
        "compared": f"{found.from_s:.3f} s to {found.to_s:.3f} s on the second's clock, "
        f"{found.band_hz[0]:.3g} Hz to {found.band_hz[1]:.3g} Hz",
    }
    caption = "Both channels on one clock, what is left, and lag and gain along the record."
    figure = Figure("comparison", caption, lambda: comparison_figure(found, level))
    told: tuple[Content, ...] = (
        pairs("Channels", about),
        Table("Found", _FOUND, _rows(found, level)),
        noticed(found.flags),
        figure,
        *_data(found, level),
    )
    return Document("", "two channels compared", (Section("", told),), SCHEMA)


def _rows(found: ChannelComparison, level: float) -> Sequence[_Row]:
    def row(what: str, of: Estimate, meaning: str, factor: float = 1.0, unit: str = "") -> _Row:
        shown = unit or of.unit.removeprefix("1")
        return _Row(what, factor * of.value, factor * of.half_width(level), shown, meaning)

    modulo = "" if found.modulo_s is None else f", modulo {found.modulo_s:.5g} s"
    rows = [
        row("gain", found.gain, "second over first"),
        row("lag", found.lag_s, f"of the second, at {found.mid_s:.3f} s{modulo}", _MS, "ms"),
        row("clock rate", found.clock_rate, "by which the second's clock is fast", _PPM, "ppm"),
        row("", found.lag_at(found.from_s), f"at {found.from_s:.3f} s, the beginning", _MS, "ms"),
        row("", found.lag_at(found.to_s), f"at {found.to_s:.3f} s, the end", _MS, "ms"),
        *(row(f"arm of {name}", arm, "") for name, arm in found.levers.items()),
    ]
    if found.dead_band is not None:
        seen = "that the first goes at a reversal before the second follows"
        unseen = "not told from none; the other numbers are those without"
        rows.append(row("dead band", found.dead_band, seen if found.dead_band_found else unseen))
    return rows


def _data(found: ChannelComparison, level: float) -> Sequence[Data]:
    def both(of: Estimate | None) -> dict[str, object] | None:
        if of is None:
            return None
        return {"value": of.value, "half_width": of.half_width(level), "unit": of.unit}

    named = {
        "level": level,
        "first": found.first,
        "second": found.second,
        "derivative": found.order,
        "from_s": found.from_s,
        "to_s": found.to_s,
        "mid_s": found.mid_s,
        "band_hz": found.band_hz,
        "gain": both(found.gain),
        "lag": both(found.lag_s),
        "lag_modulo_s": found.modulo_s,
        "clock_rate": both(found.clock_rate),
        "levers": {name: both(arm) for name, arm in found.levers.items()},
        "dead_band": both(found.dead_band),
        "dead_band_found": found.dead_band_found,
        "over_time": _parts(found.over_time, found, level),
        "over_frequency": _parts(found.over_frequency, found, level),
        "flags": found.flags,
    }
    return [Data(key, value) for key, value in named.items()]


def _parts(parts: Parts, found: ChannelComparison, level: float) -> list[_Part]:
    """Return the parts with the whole's gain and lag in theirs."""
    factor = student_factor(np.array([np.inf]), level)[0]
    gain = found.gain.value
    lags_s = parts.lag_s + found.lag_s.value
    if parts is found.over_time:
        lags_s = lags_s + found.clock_rate.value * (parts.at - found.mid_s)
    rows = zip(
        parts.at,
        gain * parts.gain,
        factor * abs(gain) * parts.gain_uncertainty,
        lags_s,
        factor * parts.lag_uncertainty_s,
        strict=True,
    )
    return [_Part(*map(float, row)) for row in rows]
