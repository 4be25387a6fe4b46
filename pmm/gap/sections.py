"""The sections of a gap report, the same ones for the terminal and for the page."""

import math
from collections.abc import Iterator, Sequence
from typing import Final

from analysis.gap.description import Description
from pmm.gap.coefficients import headings
from pmm.gap.conclusion import EFFECT, Conclusion
from pmm.gap.report import GapReport
from pmm.gap.rows import said_of
from pmm.gap.words import joined
from pmm.report.table import Section, Table

WHERE: Final = "Where"
WHICH: Final = "Which"
HOW_FAR: Final = "How far"
COEFFICIENTS: Final = "Coefficients"
REMAINS: Final = "What remains"
NEXT: Final = "Next"

_E: Final = (
    "E is measured minus simulated, u its standard uncertainty; E/u is their ratio, root mean "
    "square: 1 is noise alone. What the free coefficients (added mass, damping, restoring, mass) "
    "and the settings may explain within their tolerances is taken off; as stated is before that."
)
_BIAS: Final = (
    "Bias: by how many standard uncertainties the coefficient is off where the effect is not "
    "modelled."
)
_ODDS: Final = (
    "Runs of this rig, by how well they are expected to tell apart: {}. Log odds are the natural "
    "logarithm of the factor by which the right answer gains on the others: 3 is a factor of 20."
)


def sections(report: GapReport) -> Iterator[Section]:
    """Yield what there is to show, in the order in which it is read."""
    yield _where(report)
    yield _which(report)
    if report.regimes:
        yield _how_far(report)
    yield _coefficients(report)
    yield _remains(report)
    if report.next_runs:
        yield _next(report)


def _where(report: GapReport) -> Section:
    shares = [f"{name} {share:.2f}" for name, share in report.stages.items() if share > 0.005]
    stage = f"Stage, by the answers' probabilities: {', '.join(shares)}."
    found = report.conclusion
    rows = [
        tuple((one.what, one.verdict, one.largest, *one.said) for one in part)
        for part in (found.walk, report.contrasts)
    ]
    heads = ("verdict", "largest", "E/u as stated", "E/u", "numbers")
    walk = Table("Walk", ("along the chain", *heads), rows[0], 3)
    kinds = Table("Contrasts", ("forces, by kind of run", *heads), rows[1], 3)
    named = found.gap and shares
    return Section(WHERE, (_E, stage) if named else (_E,), (walk, kinds))


def _which(report: GapReport) -> Section:
    ranking = tuple(
        (joined(one.answer), one.stage, "; ".join(one.parameters), *one.said)
        for one in report.ranking
    )
    effects = tuple((one.name, one.stage, *said_of(one)) for one in report.effects)
    lines = [
        "Answers by their probability, all numbers of the campaign weighed together. Withheld: the "
        "gap that is left of runs that an answer was not fitted to."
    ]
    lines += [
        f"What would tell {joined(row.answer)} from what looks the same: {one}."
        for row in report.ranking
        for one in row.measure
    ]
    if report.hidden:
        lines.append(f"Cannot be seen in these runs: {', '.join(report.hidden)}.")
    heads = ("answer", "stage", "parameters (95 %)", "probability", "withheld [u]")
    each = ("effect in any answer", "stage", "cannot be told from", "probability", "of its class")
    tables = (Table("Ranking", heads, ranking, 3), Table("Effects", each, effects, 3))
    return Section(WHICH, tuple(lines), tables)


def _how_far(report: GapReport) -> Section:
    said = (
        "The withheld runs, which nobody looked at before"
        if report.held_out
        else "Each regime, predicted from all other runs"
    )
    controls = tuple((one.what, *one.said) for one in report.controls)
    regimes = tuple(
        (one.regime, *map(_u, (one.before, one.after, one.second_best, one.polynomial)))
        for one in report.regimes
    )
    heads = ("answer", "gap before [u]", "after [u]", "shrinks", "95 %")
    each = ("withheld", "before [u]", "after [u]", "second best [u]", "polynomial [u]")
    tables = (Table("Controls", heads, controls), Table("Regimes", each, regimes))
    return Section(HOW_FAR, (f"{said}: the gap in u, noise taken off.",), tables)


def _u(value: float) -> str:
    return "-" if math.isnan(value) else f"{value:.2f}"


def _coefficients(report: GapReport) -> Section:
    lines = [f"Derivatives: {report.convention}. ± is two standard uncertainties."]
    lines = [*unexplained(report.conclusion), *lines]
    if report.conclusion.verdict == EFFECT:
        lines.append(_BIAS)
    rows = tuple(one.said for one in report.coefficients)
    return Section(
        COEFFICIENTS,
        tuple(lines),
        (Table("Coefficients", headings(report.coefficients), rows, 2),),
    )


def unexplained(found: Conclusion) -> Iterator[str]:
    """Yield what the head of a table of coefficients has to say of a gap that nothing explains."""
    if found.unexplained:
        left = ", ".join(f"{one.what} {one.gap_u:.1f} u" for one in found.unexplained)
        yield (
            f"CAUTION: much is left unexplained ({left}). What it does to these values is not in "
            "their ±."
        )


def _remains(report: GapReport) -> Section:
    rows = tuple(
        (one.what, one.verdict, one.largest, f"{one.gap_u:.2f}")
        for one in report.conclusion.remains
    )
    lines = tuple(f"{line[0].upper()}{line[1:]}." for line in described(report.description))
    return Section(
        REMAINS, lines, (Table("Remainder", ("step", "verdict", "largest", "E/u"), rows, 3),)
    )


def _next(report: GapReport) -> Section:
    rows = tuple((one["said"], f"{one['gain_log_odds']:.1f}") for one in report.next_runs)
    line = _ODDS.format(", ".join(report.next_runs[0]["between"]))
    return Section(NEXT, (line,), (Table("Next", ("run", "expected log odds"), rows),))


def described(one: Description | None) -> Sequence[str]:
    """Return the description of a remainder, a sentence each; it names no cause."""
    if one is None:
        return ()
    orders = sorted(one.orders.items(), key=lambda pair: -pair[1])[:3]
    lines = [
        "its form, not its cause: harmonics "
        + ", ".join(f"{n} ({100.0 * share:.0f} %)" for n, share in orders),
        "a curve over one quantity carries "
        + ", ".join(f"{100.0 * share:z.0f} % ({name})" for name, share in one.follows.items()),
    ]
    laws = [("frequency", one.frequency_power), ("amplitude", one.amplitude_power)]
    powers = [f"{name}^{power:z.1f}" for name, power in laws if math.isfinite(power)]
    if powers:
        lines.append(f"it grows as {', '.join(powers)}")
    if math.isfinite(one.air_over_water):
        lines.append(f"in air it is {one.air_over_water:.2f} times as large as in water")
    if one.law.terms:
        terms = ", ".join(f"{channel}: {n:+.3g} N {term}" for channel, term, n in one.law.terms)
        lines.append(f"few terms that carry {100.0 * one.law.explained:.0f} % of it: {terms}")
    return lines
