"""The tables of a campaign's report, as plain text in rows."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.stated import STATED
from pmm.coefficients.workflow import Outcome
from pmm.report.rounding import rounded

_FEW_DIGITS = 0.1
_DASH = "–"
_MANY = 1000  # degrees of freedom beyond which Student's t is the normal distribution
_LITTLE = 0.005
_NOTHING = 0.0005  # 0.0 % as it is written


@dataclass(frozen=True)
class Grid:
    """A table.

    Attributes
    ----------
    numbers
        Columns that are set to the right.
    note
        What it says about all rows.
    """

    title: str
    heads: tuple[str, ...]
    numbers: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    note: str = ""


def value_tables(found: CampaignCoefficients) -> Iterator[Grid]:
    """Yield the values of each method, which name their system."""
    half = found.half_widths
    for method in dict.fromkeys(entry.method for entry in found.entries):
        rows = found.rows(method=method)
        drawn = found.trials.count > 0 and any(math.isfinite(found.trials.low[k]) for k in rows)
        heads = ["coefficient", "unit", "f (Hz)", "U (m/s)", "motion", "value", "runs"]
        numbers: tuple[int, ...] = (2, 3, 4, 5)
        if drawn:
            heads.insert(6, f"Monte Carlo, {found.trials.count}")
            numbers = (*numbers, 6)
        yield Grid(
            f"{method}: {found.normalisation}",
            tuple(heads),
            numbers,
            tuple(_value_row(found, k, float(half[k]), drawn=drawn) for k in rows),
            f"Intervals hold the value with {100.0 * found.level:g} %. "
            "An exclamation mark: a small difference of large loads, see the budget.",
        )


def _value_row(
    found: CampaignCoefficients, k: int, half_width: float, *, drawn: bool
) -> tuple[str, ...]:
    entry = found.entries[k]
    small = " !" if entry.retained < _FEW_DIGITS else ""
    row = [
        entry.name,
        entry.unit,
        frequency(entry.frequency_hz),
        f"{entry.speed_m_s:g}",
        amplitudes(entry.translation_amplitude_m, entry.rotation_amplitude_rad),
        rounded(float(found.values[k]), half_width) + small,
        shortened(entry.runs),
    ]
    if drawn:
        row.insert(6, _interval(float(found.trials.low[k]), float(found.trials.high[k])))
    return tuple(row)


def budget_table(found: CampaignCoefficients) -> Grid:
    """Return the budget of every value, largest input first."""
    rows = []
    for k in found.rows():
        one, entry = budget(found, k), found.entries[k]
        rows.append(
            (
                one.name,
                frequency(entry.frequency_hz),
                f"{entry.speed_m_s:g}",
                entry.method,
                f"{one.standard_uncertainty:.2g}",
                _freedom(one.degrees_of_freedom),
                f"{one.coverage_factor:.2f}",
                _shares(one) + (f". {one.digits}" if one.digits else ""),
            )
        )
    heads = ("coefficient", "f (Hz)", "U (m/s)", "method", "u", "ν", "k", "share of the variance")
    note = "u: standard uncertainty; ν: its degrees of freedom; k: coverage factor of the interval."
    return Grid(f"Budgets: {found.normalisation}", heads, (1, 2, 4, 5, 6), tuple(rows), note)


def _freedom(value: float) -> str:
    return f"{value:.0f}" if value < _MANY else f"over {_MANY}"


def _shares(one: CoefficientBudget) -> str:
    """Return what each kind of input adds; those that add next to nothing are put together."""
    told = [line for line in one.lines if line.share >= _LITTLE]
    words = [f"{line.source} {_percent(line.share)}" for line in told]
    left = sum(line.share for line in one.lines) - sum(line.share for line in told)
    if left >= _NOTHING:
        words.append(f"others {_percent(left)}")
    return ", ".join(words)


def _percent(share: float) -> str:
    return f"{100.0 * share:.1f}\N{NO-BREAK SPACE}%"


def finding_tables(found: CampaignCoefficients) -> Iterator[Grid]:
    """Yield checks, forms, outliers, what is missing and reference tables, where there are any."""
    yield from _checks(found)
    if found.choices:
        choices = [
            (one.load, one.verdict, ", ".join(one.forms), f"{one.evidence_ratio:.3g}", one.message)
            for one in found.choices
        ]
        heads = ("load", "verdict", "compared", "evidence ratio", "")
        yield Grid("Which form the data support", heads, (3,), tuple(choices))
    if found.outliers:
        outliers = [
            (one.run, one.load, f"{one.ratio:.3g}", f"{one.limit:.3g}", one.message)
            for one in found.outliers
        ]
        heads = ("run", "load", "distance (u)", "limit", "")
        yield Grid("Repeats that stand off", heads, (2, 3), tuple(outliers))
    if found.missing:
        missing = tuple((one.name, one.message) for one in found.missing)
        yield Grid("What these runs do not tell", ("coefficient", "why"), (), missing)
    if found.references:
        yield _references(found)


def _checks(found: CampaignCoefficients) -> Iterator[Grid]:
    """Yield a table for each kind of check."""
    heads = ("coefficient", "unit", "first", "second", "difference ± u", "", "of")
    for kind in dict.fromkeys(one.kind for one in found.checks):
        rows = [
            (c.name, c.unit, f"{c.first_value:.5g}", f"{c.second_value:.5g}",
             f"{c.difference:+.2g} ± {c.standard_uncertainty:.2g}",
             "agree" if c.agrees else "DIFFER", f"{c.first}; {c.second}")
            for c in found.checks if c.kind == kind
        ]  # fmt: skip
        yield Grid(f"Checks in SI units: {kind}", heads, (2, 3, 4), tuple(rows))


def _references(found: CampaignCoefficients) -> Grid:
    rows = [
        (one.name, one.unit, frequency(one.frequency_hz), f"{one.speed_m_s:g}",
         rounded(one.measured, one.half_width), f"{one.expected:.5g}", f"{one.difference:+.3g}",
         "within" if one.within else "OUTSIDE", one.reference)
        for one in found.references
    ]  # fmt: skip
    heads = ("coefficient", "unit", "f (Hz)", "U (m/s)", "measured", "table", "off", "", "table")
    return Grid("Beside tables from elsewhere", heads, (2, 3, 4, 5, 6), tuple(rows))


def run_table(outcome: Outcome) -> Grid:
    """Return the runs that were used, with the hash of each recording."""
    cycles = {cycle.name: cycle for cycle in outcome.cycles}
    rows = []
    for one in outcome.runs:
        cycle = cycles.get(one.name) or one.cycle
        way, turn = (0.0, 0.0)
        if cycle is not None and cycle.frequency_hz > 0.0:
            way, turn = (float(abs(value)) for value in cycle.run().motion.values)
        rows.append(
            (
                one.name,
                "zero" if cycle is None else ("dry" if one.name not in cycles else cycle.medium),
                _DASH if cycle is None else frequency(cycle.frequency_hz),
                _DASH if cycle is None else f"{cycle.speed_m_s:g}",
                amplitudes(way, turn),
                str(one.periods) if one.periods else _DASH,
                f"{one.duration_s:.1f}",
                f"{one.sample_rate_hz:g}",
                one.sha256[:16],
            )
        )
    heads = ("run", "medium", "f (Hz)", "U (m/s)", "motion", "periods", "record (s)", "rate (Hz)",
             "SHA-256 begins")  # fmt: skip
    return Grid("Recordings", heads, (2, 3, 4, 5, 6, 7, 8), tuple(rows))


def given_table(outcome: Outcome) -> Grid:
    """Return what was stated: the body that was taken off and standard uncertainties."""
    rows = []
    if outcome.body is not None:
        rows += [(f"model: {key}", f"{value:.6g}") for key, value in asdict(outcome.body).items()]
    stated = zip(STATED, outcome.stated.vector, strict=True)
    rows += [(f"u of {key}", f"{value:.3g}") for key, value in stated if value > 0.0]
    if not rows:
        rows = [("inertia", "taken off by dry runs")]
    return Grid("Given", ("what", "value"), (1,), tuple(rows))


def frequency(value: float) -> str:
    """Return a frequency; words where several share a value."""
    return "several" if math.isnan(value) else f"{value:.4g}"


def amplitudes(way_m: float, turn_rad: float) -> str:
    """Return both amplitudes of a motion, leaving out what is nothing beside the other."""
    parts = []
    if way_m > 1e-3 * turn_rad:
        parts.append(f"{1e3 * way_m:.3g} mm")
    if turn_rad > 1e-3 * way_m:
        parts.append(f"{math.degrees(turn_rad):.3g}°")
    return ", ".join(parts) or _DASH


def shortened(runs: Sequence[str]) -> str:
    """Return the names of runs, of many the first two."""
    more = len(runs) - 2
    return ", ".join(runs[:2]) + (f" and {more} more" if more > 0 else "")


def _interval(low: float, high: float) -> str:
    return f"{low:.5g} to {high:.5g}".replace("-", "−") if math.isfinite(low) else _DASH
