"""The tables of a campaign's values: those to be used first, all others, and their budgets."""

import math
from collections.abc import Iterator
from itertools import count, product
from string import ascii_uppercase

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.recommendation import recommended
from hardware.description.words import joined
from pmm.document.content import Column, Table
from pmm.document.notation import NOT_KNOWN, percent, rounded, written

_FEW_DIGITS = 0.1
_MANY = 1000  # degrees of freedom beyond which Student's t is the normal distribution
_LITTLE = 0.005
_NOTHING = 0.0005  # 0.0 % as it is written
_MISFIT = "Misfit: residuals over what scatter leads to expect; 1 where the form is the hull's."
_SMALL = "An exclamation mark: a small difference of large loads, see the budget."
_FREEDOM = "u: standard uncertainty; ν: its degrees of freedom; k: coverage factor of the interval."


def _entry(coefficients: CampaignCoefficients) -> dict[str, Column[int]]:
    """Return the columns that tables of values share, by heading; a row is the value's number."""
    entries, half = coefficients.entries, coefficients.half_widths

    def value(k: int) -> str:
        small = " !" if entries[k].retained < _FEW_DIGITS else ""
        return rounded(float(coefficients.values[k]), float(half[k])) + small

    shared: tuple[Column[int], ...] = (
        Column("coefficient", lambda k: entries[k].name),
        Column("unit", lambda k: entries[k].unit),
        Column("f", lambda k: entries[k].frequency_hz, written=frequency, unit="Hz", number=True),
        Column("U", lambda k: entries[k].speed_m_s, written=written("g"), unit="m/s", number=True),
        Column("value", value, number=True),
        Column("method", lambda k: entries[k].method),
    )
    return {str(column.heading): column for column in shared}


def recommended_table(coefficients: CampaignCoefficients) -> Table[int]:
    """Return the values to be used first: one a coefficient, with the runs that it rests on."""
    rows, entries, shared = recommended(coefficients), coefficients.entries, _entry(coefficients)
    letters = dict(zip(dict.fromkeys(entries[k].runs for k in rows), _letters(), strict=False))
    notes = [f"Intervals hold the value with {100.0 * coefficients.level:g} %.", _MISFIT]
    notes += [_SMALL] if any(entries[k].retained < _FEW_DIGITS for k in rows) else []
    notes += [f"Runs {letter}: {', '.join(runs)}." for runs, letter in letters.items()]
    columns = (
        *(shared[name] for name in ("coefficient", "unit", "value", "U")),
        Column[int]("how", lambda k: _way(coefficients, k)),
        Column("misfit", lambda k: entries[k].misfit, written=written(".3g"), number=True),
        Column("runs", lambda k: f"{letters[entries[k].runs]} ({len(entries[k].runs)})"),
        Column("largest input", lambda k: _largest(budget(coefficients, k))),
    )
    name = f"Recommended values: {coefficients.normalisation}"
    return Table(name, columns, rows, titled=True, notes=tuple(notes))


def _letters() -> Iterator[str]:
    """Yield A, B ... Z, AA, AB ..."""
    for size in count(1):
        yield from map("".join, product(ascii_uppercase, repeat=size))


def _way(coefficients: CampaignCoefficients, k: int) -> str:
    entry = coefficients.entries[k]
    frequency_hz = entry.frequency_hz
    choices = coefficients.choices_of(entry.name, entry.runs)
    forms = [choice.fitted for choice in choices if choice.runs == entry.runs]
    return ", ".join(
        (entry.method, *forms, *([f"{frequency(frequency_hz)} Hz"] if frequency_hz > 0.0 else []))
    )


def alternatives_tables(coefficients: CampaignCoefficients) -> Iterator[Table[int]]:
    """Yield what else there is of each method: other amplitudes, frequencies and ways."""
    first, entries, shared, trials = (
        set(recommended(coefficients)),
        coefficients.entries,
        _entry(coefficients),
        coefficients.trials,
    )

    def motion(k: int) -> str:
        return amplitudes(entries[k].translation_amplitude_m, entries[k].rotation_amplitude_rad)

    trial_column = Column[int](
        f"Monte Carlo, {trials.count}",
        lambda k: _interval(float(trials.low[k]), float(trials.high[k])),
        number=True,
    )
    for method in dict.fromkeys(entry.method for entry in entries):
        rows = [k for k in coefficients.rows(method=method) if k not in first]
        if not rows:
            continue
        has_trials = trials.count > 0 and any(math.isfinite(trials.low[k]) for k in rows)
        columns = (
            *(shared[name] for name in ("coefficient", "unit", "f", "U")),
            Column[int]("motion", motion, number=True),
            shared["value"],
            *([trial_column] if has_trials else []),
            Column("runs", lambda k: joined(entries[k].runs, 2)),
        )
        name = f"Alternatives, {method}: {coefficients.normalisation}"
        yield Table(name, columns, rows, titled=True, folded=True)


def budget_table(coefficients: CampaignCoefficients) -> Table[int]:
    """Return the budget of every value, largest input first."""
    shared = _entry(coefficients)
    columns = (
        *(shared[name] for name in ("coefficient", "f", "U", "method")),
        *(
            Column[int](heading, lambda k, key=key: getattr(budget(coefficients, k), key),  # type: ignore[misc]
                        written=form, number=True)
            for heading, key, form in (
                ("u", "standard_uncertainty", written(".2g")),
                ("ν", "degrees_of_freedom", _freedom),
                ("k", "coverage_factor", written(".2f")),
            )
        ),
        Column("share of the variance", lambda k: _shares(budget(coefficients, k))),
    )  # fmt: skip
    name = f"Budgets: {coefficients.normalisation}"
    return Table(
        name, columns, tuple(coefficients.rows()), titled=True, notes=(_FREEDOM,), folded=True
    )


def _freedom(value: float) -> str:
    return f"{value:.0f}" if value < _MANY else f"over {_MANY}"


def _largest(budget: CoefficientBudget) -> str:
    return (
        f"{budget.lines[0].source} {100.0 * budget.lines[0].share:.0f} %"
        if budget.lines and math.isfinite(budget.lines[0].share)
        else NOT_KNOWN
    )


def _shares(budget: CoefficientBudget) -> str:
    """Return what each kind of input adds; those that add next to nothing are put together."""
    lines = [line for line in budget.lines if line.share >= _LITTLE]
    words = [f"{line.source} {_percent(line.share)}" for line in lines]
    remainder = sum(line.share for line in budget.lines) - sum(line.share for line in lines)
    if remainder >= _NOTHING:
        words.append(f"others {_percent(remainder)}")
    return ", ".join(words) + (f". {budget.digits}" if budget.digits else "")


def _percent(share: float) -> str:
    return percent(".1f")(share).replace(" ", "\N{NO-BREAK SPACE}")


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
    return ", ".join(parts) or NOT_KNOWN


def _interval(low: float, high: float) -> str:
    return f"{low:.5g} to {high:.5g}".replace("-", "−") if math.isfinite(low) else NOT_KNOWN
