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

    name: str
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
    Column("", lambda row: row.name),
    Column("", lambda row: rounded(row.value, row.half_width), number=True),
    Column("", lambda row: row.unit),
    Column("", lambda row: row.meaning),
)


def comparison_document(comparison: ChannelComparison, level: float) -> Document:
    """Return what ``pmm compare`` shows; ``docs/comparison.md`` describes the keys.

    Parameters
    ----------
    level
        Probability of the intervals.
    """
    shows = f", derivative {comparison.order}" if comparison.order else ""
    about = {
        "first": f"{comparison.first}{shows}",
        "second": comparison.second,
        "compared": f"{comparison.from_s:.3f} s to {comparison.to_s:.3f} s on the second's clock, "
        f"{comparison.band_hz[0]:.3g} Hz to {comparison.band_hz[1]:.3g} Hz",
    }
    caption = "Both channels on one clock, what is left, and lag and gain along the record."
    figure = Figure("comparison", caption, lambda: comparison_figure(comparison, level))
    contents: tuple[Content, ...] = (
        pairs("Channels", about),
        Table("Found", _FOUND, _rows(comparison, level)),
        noticed(comparison.flags),
        figure,
        *_data(comparison, level),
    )
    return Document("", "two channels compared", (Section("", contents),), SCHEMA)


def _rows(comparison: ChannelComparison, level: float) -> Sequence[_Row]:
    def row(
        name: str, estimate: Estimate, meaning: str, factor: float = 1.0, unit: str = ""
    ) -> _Row:
        label = unit or estimate.unit.removeprefix("1")
        return _Row(
            name, factor * estimate.value, factor * estimate.half_width(level), label, meaning
        )

    modulo = "" if comparison.modulo_s is None else f", modulo {comparison.modulo_s:.5g} s"
    rows = [
        row("gain", comparison.gain, "second over first"),
        row(
            "lag",
            comparison.lag_s,
            f"of the second, at {comparison.mid_s:.3f} s{modulo}",
            _MS,
            "ms",
        ),
        row(
            "clock rate", comparison.clock_rate, "by which the second's clock is fast", _PPM, "ppm"
        ),
        row(
            "",
            comparison.lag_at(comparison.from_s),
            f"at {comparison.from_s:.3f} s, the beginning",
            _MS,
            "ms",
        ),
        row(
            "",
            comparison.lag_at(comparison.to_s),
            f"at {comparison.to_s:.3f} s, the end",
            _MS,
            "ms",
        ),
        *(row(f"arm of {name}", arm, "") for name, arm in comparison.levers.items()),
    ]
    if comparison.dead_band is not None:
        definition = "that the first goes at a reversal before the second follows"
        remark = "not told from none; the other numbers are those without"
        rows.append(
            row(
                "dead band",
                comparison.dead_band,
                definition if comparison.dead_band_found else remark,
            )
        )
    return rows


def _data(comparison: ChannelComparison, level: float) -> Sequence[Data]:
    def estimate_data(estimate: Estimate | None) -> dict[str, object] | None:
        if estimate is None:
            return None
        return {
            "value": estimate.value,
            "half_width": estimate.half_width(level),
            "unit": estimate.unit,
        }

    values = {
        "level": level,
        "first": comparison.first,
        "second": comparison.second,
        "derivative": comparison.order,
        "from_s": comparison.from_s,
        "to_s": comparison.to_s,
        "mid_s": comparison.mid_s,
        "band_hz": comparison.band_hz,
        "gain": estimate_data(comparison.gain),
        "lag": estimate_data(comparison.lag_s),
        "lag_modulo_s": comparison.modulo_s,
        "clock_rate": estimate_data(comparison.clock_rate),
        "levers": {name: estimate_data(arm) for name, arm in comparison.levers.items()},
        "dead_band": estimate_data(comparison.dead_band),
        "dead_band_found": comparison.dead_band_found,
        "over_time": _parts(comparison.over_time, comparison, level),
        "over_frequency": _parts(comparison.over_frequency, comparison, level),
        "flags": comparison.flags,
    }
    return [Data(key, value) for key, value in values.items()]


def _parts(parts: Parts, comparison: ChannelComparison, level: float) -> list[_Part]:
    """Return the parts with the whole's gain and lag in theirs."""
    factor = student_factor(np.array([np.inf]), level)[0]
    gain = comparison.gain.value
    lags_s = parts.lag_s + comparison.lag_s.value
    if parts is comparison.over_time:
        lags_s = lags_s + comparison.clock_rate.value * (parts.at - comparison.mid_s)
    rows = zip(
        parts.at,
        gain * parts.gain,
        factor * abs(gain) * parts.gain_uncertainty,
        lags_s,
        factor * parts.lag_uncertainty_s,
        strict=True,
    )
    return [_Part(*map(float, row)) for row in rows]
