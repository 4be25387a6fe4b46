"""The tables of a campaign's report, as plain text in rows."""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import count, product
from string import ascii_uppercase

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import BEYOND_DOUBT
from analysis.coefficients.recommendation import recommended
from analysis.coefficients.stated_uncertainties import STATED
from pmm.coefficients.workflow import Outcome
from pmm.document.notation import rounded

_FEW_DIGITS = 0.1
_DASH = "–"
_MANY = 1000  # degrees of freedom beyond which Student's t is the normal distribution
_LITTLE = 0.005
_NOTHING = 0.0005  # 0.0 % as it is written
_MISFIT = "Misfit: residuals over what scatter leads to expect; 1 where the form is the hull's."
_SMALL = "An exclamation mark: a small difference of large loads, see the budget."


@dataclass(frozen=True)
class Grid:
    """A table.

    Attributes
    ----------
    numbers
        Columns that are set to the right.
    notes
        What it says about all rows, a paragraph each.
    folded
        Whether a page shows it when it is asked for alone.
    """

    title: str
    heads: tuple[str, ...]
    numbers: tuple[int, ...]
    rows: tuple[tuple[str, ...], ...]
    notes: tuple[str, ...] = ()
    folded: bool = False


def recommended_table(found: CampaignCoefficients) -> Grid:
    """Return the values to be used first: one a coefficient, with the runs that it rests on."""
    rows = recommended(found)
    groups = dict.fromkeys(found.entries[k].runs for k in rows)
    letters = dict(zip(groups, _letters(), strict=False))
    half = found.half_widths
    told = [
        (
            found.entries[k].name,
            found.entries[k].unit,
            _value(found, k, float(half[k])),
            f"{found.entries[k].speed_m_s:g}",
            _way(found, k),
            _misfit(found, k),
            f"{letters[found.entries[k].runs]} ({len(found.entries[k].runs)})",
            _largest(budget(found, k)),
        )
        for k in rows
    ]
    heads = ("coefficient", "unit", "value", "U (m/s)", "how", "misfit", "runs", "largest input")
    notes = [f"Intervals hold the value with {100.0 * found.level:g} %.", _MISFIT]
    notes += [_SMALL] if any(" !" in row[2] for row in told) else []
    notes += [f"Runs {letter}: {', '.join(runs)}." for runs, letter in letters.items()]
    return Grid(
        f"Recommended values: {found.normalisation}", heads, (2, 3, 5), tuple(told), tuple(notes)
    )


def _letters() -> Iterator[str]:
    """Yield A, B ... Z, AA, AB ..."""
    for size in count(1):
        yield from map("".join, product(ascii_uppercase, repeat=size))


def _way(found: CampaignCoefficients, k: int) -> str:
    entry = found.entries[k]
    at = entry.frequency_hz
    forms = [one.fitted for one in found.choices_of(entry.name, entry.runs)
             if one.runs == entry.runs]  # fmt: skip
    return ", ".join((entry.method, *forms, *([f"{frequency(at)} Hz"] if at > 0.0 else [])))


def _misfit(found: CampaignCoefficients, k: int) -> str:
    """Return how far the residuals go beyond scatter; a dash where none are left over."""
    misfit = found.entries[k].misfit
    return _DASH if math.isnan(misfit) else f"{misfit:.3g}"


def value_tables(found: CampaignCoefficients) -> Iterator[Grid]:
    """Yield what else there is of each method: other amplitudes, frequencies and ways."""
    half, first = found.half_widths, set(recommended(found))
    for method in dict.fromkeys(entry.method for entry in found.entries):
        rows = [k for k in found.rows(method=method) if k not in first]
        if not rows:
            continue
        drawn = found.trials.count > 0 and any(math.isfinite(found.trials.low[k]) for k in rows)
        heads = ["coefficient", "unit", "f (Hz)", "U (m/s)", "motion", "value", "runs"]
        numbers: tuple[int, ...] = (2, 3, 4, 5)
        if drawn:
            heads.insert(6, f"Monte Carlo, {found.trials.count}")
            numbers = (*numbers, 6)
        yield Grid(
            f"Alternatives, {method}: {found.normalisation}",
            tuple(heads),
            numbers,
            tuple(_value_row(found, k, float(half[k]), drawn=drawn) for k in rows),
            folded=True,
        )


def _value_row(
    found: CampaignCoefficients, k: int, half_width: float, *, drawn: bool
) -> tuple[str, ...]:
    entry = found.entries[k]
    row = [
        entry.name,
        entry.unit,
        frequency(entry.frequency_hz),
        f"{entry.speed_m_s:g}",
        amplitudes(entry.translation_amplitude_m, entry.rotation_amplitude_rad),
        _value(found, k, half_width),
        shortened(entry.runs),
    ]
    if drawn:
        row.insert(6, _interval(float(found.trials.low[k]), float(found.trials.high[k])))
    return tuple(row)


def _value(found: CampaignCoefficients, k: int, half_width: float) -> str:
    small = " !" if found.entries[k].retained < _FEW_DIGITS else ""
    return rounded(float(found.values[k]), half_width) + small


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
    title = f"Budgets: {found.normalisation}"
    return Grid(title, heads, (1, 2, 4, 5, 6), tuple(rows), (note,), folded=True)


def _freedom(value: float) -> str:
    return f"{value:.0f}" if value < _MANY else f"over {_MANY}"


def _largest(one: CoefficientBudget) -> str:
    return f"{one.lines[0].source} {100.0 * one.lines[0].share:.0f} %" if one.lines else _DASH


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
    """Yield forms, outliers, what is missing, reference tables and checks, where there are any."""
    if found.choices:
        forms = [
            (one.load, one.verdict, one.fitted, ratio(one.evidence_ratio), ", ".join(one.runs),
             one.message)
            for one in found.choices
        ]  # fmt: skip
        heads: tuple[str, ...] = ("load", "verdict", "fitted", "evidence ratio", "runs", "")
        yield Grid("Which form the data support", heads, (3,), tuple(forms))
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
    yield from beside_tables(found)
    yield from _checks(found)


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
        agree = sum(c.agrees for c in found.checks if c.kind == kind)
        title = f"Checks in SI units, {kind}: {agree} of {len(rows)} agree"
        yield Grid(title, heads, (2, 3, 4), tuple(rows), folded=agree == len(rows))


def ratio(value: float) -> str:
    """Return an evidence ratio; what is beyond any doubt is not counted out."""
    return f"{value:.3g}" if value < BEYOND_DOUBT else f"over {BEYOND_DOUBT:g}"


def beside_tables(found: CampaignCoefficients) -> Iterator[Grid]:
    """Yield the values beside other arrangements' and tables' from elsewhere, if there are any."""
    if found.arrangements:
        yield _arrangement_table(found)
    if found.references:
        yield _reference_table(found)


def _arrangement_table(found: CampaignCoefficients) -> Grid:
    rows = [
        (one.key, one.stated, one.other, one.verdict, _number(one.evidence_ratio, ratio),
         _number(one.largest, "{:.3g}".format), ", ".join(one.coefficients) or _DASH)
        for one in found.arrangements
    ]  # fmt: skip
    heads = ("key", "stated", "other", "the other", "evidence ratio", "largest move",
             "moved beyond half-width")  # fmt: skip
    note = (
        "Evidence ratio: likelihood of the recordings under the other over that under what is "
        "stated. Moves are in half-widths."
    )
    return Grid("Other arrangements of the rig", heads, (4, 5), tuple(rows), (note,))


def _number(value: float, written: Callable[[float], str]) -> str:
    return _DASH if math.isnan(value) else written(value)


def _reference_table(found: CampaignCoefficients) -> Grid:
    rows = [
        (one.name, one.unit, frequency(one.frequency_hz), f"{one.speed_m_s:g}",
         rounded(one.measured, one.half_width), f"{one.expected:.5g}", f"{one.difference:+.3g}",
         "within" if one.within else "OUTSIDE", one.reference)
        for one in found.references
    ]  # fmt: skip
    heads = ("coefficient", "unit", "f (Hz)", "U (m/s)", "measured", "table", "off", "", "of")
    return Grid("Beside tables from elsewhere", heads, (2, 3, 4, 5, 6), tuple(rows))


def run_table(outcome: Outcome) -> Grid:
    """Return the runs that were used, with the hash of each recording."""
    cycles = {cycle.name: cycle for cycle in outcome.cycles}
    rows = []
    for one in outcome.runs:
        cycle = cycles.get(one.name) or one.cycle
        way, turn = (0.0, 0.0)
        if cycle is not None and cycle.frequency_hz > 0.0:
            way, turn = (float(abs(value)) for value in cycle.motion)
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
        known = {key: value for key, value in asdict(outcome.body).items() if value is not None}
        rows += [(f"model: {key}", f"{value:.6g}") for key, value in known.items()]
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
