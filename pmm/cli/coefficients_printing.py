"""A campaign's coefficients as tables for people."""

import math
from collections.abc import Sequence
from itertools import groupby
from typing import TYPE_CHECKING

from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from pmm.cli.printing import counted
from pmm.cli.screen import print_flags
from pmm.coefficients.workflow import Outcome
from pmm.report.rounding import rounded

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

_LINES = 3  # of each budget
_DIGITS = 0.1


def print_outcome(console: "Console", outcome: Outcome) -> None:
    """Print tables, what was found about them, and what was noticed."""
    found = outcome.result
    used = counted(len(outcome.cycles), "run")
    console.print(f"{', '.join(outcome.names)}: {used}, {found.plane}, {found.form} form")
    console.print(f"system: {found.normalisation}; intervals hold {100.0 * found.level:g} %")
    _print_values(console, found)
    _print_findings(console, found)
    _print_references(console, found)
    print_flags(console, outcome.left_out)
    print_flags(console, [flag for flags in outcome.flags.values() for flag in flags])


def _print_values(console: "Console", found: CampaignCoefficients) -> None:
    rows = found.rows()
    by_way = sorted(rows, key=lambda k: found.entries[k].method)
    for method, own in groupby(by_way, key=lambda k: found.entries[k].method):
        console.print()
        console.print(_values(found, method, list(own)))


def _values(found: CampaignCoefficients, method: str, rows: Sequence[int]) -> "Table":
    trials = found.trials.count > 0 and any(math.isfinite(found.trials.low[k]) for k in rows)
    heads = ["coefficient", "unit", "f [Hz]", "U [m/s]", "amplitude", "value", "largest inputs"]
    if trials:
        heads.insert(6, "Monte Carlo")
    table = _table(f"{method} ({found.normalisation})", heads, right=(2, 3, 4, 5))
    half = found.half_widths
    for k in rows:
        entry = found.entries[k]
        cells = [
            entry.name,
            entry.unit,
            _frequency(entry.frequency_hz),
            f"{entry.speed_m_s:g}",
            _amplitude(entry.translation_amplitude_m, entry.rotation_amplitude_rad),
            rounded(float(found.values[k]), float(half[k])) + (_few_digits(entry.retained)),
            _inputs(found, k),
        ]
        if trials:
            low, high = (float(part[k]) for part in (found.trials.low, found.trials.high))
            cells.insert(6, f"{low:.5g} to {high:.5g}" if math.isfinite(low) else "–")
        table.add_row(*cells)
    return table


def _few_digits(retained: float) -> str:
    return " (!)" if retained < _DIGITS else ""


def _frequency(value: float) -> str:
    return "several" if math.isnan(value) else f"{value:.4g}"


def _amplitude(way_m: float, turn_rad: float) -> str:
    """Return both amplitudes, leaving out one that is nothing beside the other."""
    parts = []
    if way_m > 1e-3 * turn_rad:
        parts.append(f"{1e3 * way_m:.3g} mm")
    if turn_rad > 1e-3 * way_m:
        parts.append(f"{math.degrees(turn_rad):.3g}°")
    return ", ".join(parts) or "–"


def _inputs(found: CampaignCoefficients, row: int) -> str:
    lines = budget(found, row).lines[:_LINES]
    return ", ".join(f"{one.source} {100.0 * one.share:.0f} %" for one in lines) or "–"


def _print_findings(console: "Console", found: CampaignCoefficients) -> None:
    agree = sum(one.agrees for one in found.checks)
    if found.checks:
        console.print()
        console.print(f"{agree} of {counted(len(found.checks), 'check')} between runs agree")
    for check in found.checks:
        if not check.agrees:
            console.print(f"WARNING {check.message}", style="yellow", soft_wrap=True)
    for choice in found.choices:
        console.print(f"form    {choice.message}", soft_wrap=True)
    for outlier in found.outliers:
        console.print(f"WARNING {outlier.message}", style="yellow", soft_wrap=True)
    for missing in found.missing:
        console.print(f"missing {missing.name}: {missing.message}", soft_wrap=True)
    flags = tuple(dict.fromkeys(found.flags))
    small = [one for one in flags if one.code == "digits_lost"]
    print_flags(console, [one for one in flags if one.code != "digits_lost"])
    if small:
        names = ", ".join(dict.fromkeys(str(one.channel) for one in small))
        console.print(
            f"WARNING (!) small differences that lose digits: {names}; see the budgets",
            soft_wrap=True,
        )


def _print_references(console: "Console", found: CampaignCoefficients) -> None:
    if not found.references:
        return
    heads = ("coefficient", "unit", "f [Hz]", "U [m/s]", "measured", "reference", "off", "")
    table = _table("beside reference tables", heads, right=(2, 3, 4, 5, 6))
    for one in found.references:
        table.add_row(
            one.name,
            one.unit,
            _frequency(one.frequency_hz),
            f"{one.speed_m_s:g}",
            rounded(one.measured, one.half_width),
            f"{one.expected:.5g} ({one.reference})",
            f"{one.difference:+.3g}",
            "within" if one.within else "OUTSIDE",
        )
    console.print()
    console.print(table)


def _table(title: str, heads: Sequence[str], right: Sequence[int]) -> "Table":
    from rich.table import Table

    table = Table(title=title, title_justify="left", box=None, padding=(0, 1), pad_edge=False)
    for k, head in enumerate(heads):
        table.add_column(head, justify="right" if k in right else "left", overflow="fold")
    return table
