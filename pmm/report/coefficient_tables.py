"""The tables of a campaign's values: those to be used first, all others, and their budgets."""

import math
from collections.abc import Iterator
from itertools import count, product
from string import ascii_uppercase

from analysis.coefficients.campaign_budget import CoefficientBudget, budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.recommendation import recommended
from pmm.document.content import Column, Table
from pmm.document.notation import NOT_KNOWN, joined, percent, rounded, written

_FEW_DIGITS = 0.1
_MANY = 1000  # degrees of freedom beyond which Student's t is the normal distribution
_LITTLE = 0.005
_NOTHING = 0.0005  # 0.0 % as it is written
_MISFIT = "Misfit: residuals over what scatter leads to expect; 1 where the form is the hull's."
_SMALL = "An exclamation mark: a small difference of large loads, see the budget."
_FREEDOM = "u: standard uncertainty; ν: its degrees of freedom; k: coverage factor of the interval."


def _entry(found: CampaignCoefficients) -> dict[str, Column[int]]:
    """Return the columns that tables of values share, by heading; a row is the value's number."""
    entries, half = found.entries, found.half_widths

    def value(k: int) -> str:
        small = " !" if entries[k].retained < _FEW_DIGITS else ""
        return rounded(float(found.values[k]), float(half[k])) + small

    shared: tuple[Column[int], ...] = (
        Column("coefficient", lambda k: entries[k].name),
        Column("unit", lambda k: entries[k].unit),
        Column("f", lambda k: entries[k].frequency_hz, written=frequency, unit="Hz", number=True),
        Column("U", lambda k: entries[k].speed_m_s, written=written("g"), unit="m/s", number=True),
        Column("value", value, number=True),
        Column("method", lambda k: entries[k].method),
    )
    return {str(one.heading): one for one in shared}


def recommended_table(found: CampaignCoefficients) -> Table[int]:
    """Return the values to be used first: one a coefficient, with the runs that it rests on."""
    rows, entries, shared = recommended(found), found.entries, _entry(found)
    letters = dict(zip(dict.fromkeys(entries[k].runs for k in rows), _letters(), strict=False))
    notes = [f"Intervals hold the value with {100.0 * found.level:g} %.", _MISFIT]
    notes += [_SMALL] if any(entries[k].retained < _FEW_DIGITS for k in rows) else []
    notes += [f"Runs {letter}: {', '.join(runs)}." for runs, letter in letters.items()]
    columns = (
        *(shared[name] for name in ("coefficient", "unit", "value", "U")),
        Column[int]("how", lambda k: _way(found, k)),
        Column("misfit", lambda k: entries[k].misfit, written=written(".3g"), number=True),
        Column("runs", lambda k: f"{letters[entries[k].runs]} ({len(entries[k].runs)})"),
        Column("largest input", lambda k: _largest(budget(found, k))),
    )
    name = f"Recommended values: {found.normalisation}"
    return Table(name, columns, rows, titled=True, notes=tuple(notes))


def _letters() -> Iterator[str]:
    """Yield A, B ... Z, AA, AB ..."""
    for size in count(1):
        yield from map("".join, product(ascii_uppercase, repeat=size))


def _way(found: CampaignCoefficients, k: int) -> str:
    entry = found.entries[k]
    at = entry.frequency_hz
    choices = found.choices_of(entry.name, entry.runs)
    forms = [choice.fitted for choice in choices if choice.runs == entry.runs]
    return ", ".join((entry.method, *forms, *([f"{frequency(at)} Hz"] if at > 0.0 else [])))


def alternatives_tables(found: CampaignCoefficients) -> Iterator[Table[int]]:
    """Yield what else there is of each method: other amplitudes, frequencies and ways."""
    first, entries, shared, trials = (
        set(recommended(found)),
        found.entries,
        _entry(found),
        found.trials,
    )

    def motion(k: int) -> str:
        return amplitudes(entries[k].translation_amplitude_m, entries[k].rotation_amplitude_rad)

    drawn = Column[int](
        f"Monte Carlo, {trials.count}",
        lambda k: _interval(float(trials.low[k]), float(trials.high[k])),
        number=True,
    )
    for method in dict.fromkeys(entry.method for entry in entries):
        rows = [k for k in found.rows(method=method) if k not in first]
        if not rows:
            continue
        seen = trials.count > 0 and any(math.isfinite(trials.low[k]) for k in rows)
        columns = (
            *(shared[name] for name in ("coefficient", "unit", "f", "U")),
            Column[int]("motion", motion, number=True),
            shared["value"],
            *([drawn] if seen else []),
            Column("runs", lambda k: joined(entries[k].runs, 2)),
        )
        name = f"Alternatives, {method}: {found.normalisation}"
        yield Table(name, columns, rows, titled=True, folded=True)


def budget_table(found: CampaignCoefficients) -> Table[int]:
    """Return the budget of every value, largest input first."""
    shared = _entry(found)
    columns = (
        *(shared[name] for name in ("coefficient", "f", "U", "method")),
        *(
            Column[int](heading, lambda k, key=key: getattr(budget(found, k), key),  # type: ignore[misc]
                        written=form, number=True)
            for heading, key, form in (
                ("u", "standard_uncertainty", written(".2g")),
                ("ν", "degrees_of_freedom", _freedom),
                ("k", "coverage_factor", written(".2f")),
            )
        ),
        Column("share of the variance", lambda k: _shares(budget(found, k))),
    )  # fmt: skip
    name = f"Budgets: {found.normalisation}"
    return Table(name, columns, tuple(found.rows()), titled=True, notes=(_FREEDOM,), folded=True)


def _freedom(value: float) -> str:
    return f"{value:.0f}" if value < _MANY else f"over {_MANY}"


def _largest(one: CoefficientBudget) -> str:
    return f"{one.lines[0].source} {100.0 * one.lines[0].share:.0f} %" if one.lines else NOT_KNOWN


def _shares(one: CoefficientBudget) -> str:
    """Return what each kind of input adds; those that add next to nothing are put together."""
    told = [line for line in one.lines if line.share >= _LITTLE]
    words = [f"{line.source} {_percent(line.share)}" for line in told]
    left = sum(line.share for line in one.lines) - sum(line.share for line in told)
    if left >= _NOTHING:
        words.append(f"others {_percent(left)}")
    return ", ".join(words) + (f". {one.digits}" if one.digits else "")


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
