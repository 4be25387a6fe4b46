"""What ``pmm gap`` shows of a campaign: said once, for the terminal, the page and programs."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Final

from analysis.gap.judge.description import Description
from pmm.document.content import Data, Document, Figure, Note, Notes, Section, Table, Text
from pmm.gap import figures
from pmm.gap.conclusion import EFFECT, Conclusion
from pmm.gap.report import GapReport
from pmm.gap.tables import CONTROLS, EFFECTS, NEXT, RANKING, REGIMES, coefficient_columns, steps
from pmm.gap.words import joined

SCHEMA: Final = "pmm-gap-1"

_E: Final = (
    "E is measured minus simulated, u its standard uncertainty; E/u is their ratio, root mean "
    "square: 1 is noise alone. What the free coefficients (added mass, damping, restoring, mass) "
    "and the settings may explain within their tolerances is taken off; as stated is before that."
)
_WALK: Final = (
    "The walk along the chain: a gap lies where it first appears. Motion and forces are shown with "
    "the simulated input and, where the shaft or the struts have sensors, with the measured one in "
    "its place."
)
_HEAT: Final = (
    "E/u over stage, channel, harmonic and run, before and after the answer; below, what the "
    "forces show beside the harmonics. Light is noise."
)
_RANKING: Final = "Answers by probability: named effects, pairs, something unknown, no gap."
_ANSWERS: Final = (
    "Answers by their probability, all numbers of the campaign weighed together. Withheld: the "
    "gap that is left of runs that an answer was not fitted to."
)
_WITHHELD: Final = (
    "The gap of runs that an answer was not fitted to, without it and with each answer."
)
_BIAS: Final = (
    "Bias: by how many standard uncertainties the coefficient is off where the effect is not "
    "modelled."
)
_MAP: Final = "What no answer explains, as a force over the strut's motion: its form, no cause."
_ODDS: Final = (
    "Runs of this rig, by how well they are expected to tell apart for their tank time: {}. Log "
    "odds are the natural logarithm of the factor by which the right answer gains on the others: "
    "3 is a factor of 20."
)


def document(report: GapReport) -> Document:
    """Return what is shown of a campaign."""
    return Document(report.campaign, "rig and simulation", tuple(_sections(report)), SCHEMA)


def _sections(report: GapReport) -> Iterator[Section]:
    """Yield what there is to show, in the order in which it is read."""
    yield _answer(report)
    yield _stage_section(report)
    yield _answer_section(report)
    yield _how_far(report)
    yield _coefficients(report)
    yield _remains(report)
    yield _next_section(report)


def _answer(report: GapReport) -> Section:
    conclusion, held = report.conclusion, len(report.held_out)
    withheld = f", {held} withheld" if held else ""
    used = (
        f"{len(report.runs)} runs used{withheld}, {len(report.left_out)} left out. Below, u is the "
        "standard uncertainty of a number: a difference of 1 u is noise."
    )
    left_out = [Note("left out", f"{name}: {why}") for name, why in report.left_out.items()]
    keys = ("campaign", "runs", "held_out", "left_out", "how_large", "stages", "hidden",
            "convention", "description")  # fmt: skip
    return Section(
        "",
        (
            Text(report.said, "said", strong=True),
            Text((used,)),
            Notes(left_out),
            Notes([Note("note", note) for note in report.notes], "notes"),
            *(Data(key, getattr(report, key)) for key in keys),
            Data("verdict", conclusion.verdict),
            Data("class_probability", conclusion.probability),
            Data("takes", conclusion.weighing.takes),
        ),
    )


def _stage_section(report: GapReport) -> Section:
    shares = [f"{name} {share:.2f}" for name, share in report.stages.items() if share > 0.005]
    stage = f"Stage, by the answers' probabilities: {', '.join(shares)}."
    conclusion = report.conclusion
    return Section(
        "Where",
        (
            Text((_E, stage) if conclusion.gap and shares else (_E,)),
            Figure("walk", _WALK, partial(figures.walk_figure, report)),
            Figure("heat", _HEAT, partial(figures.heat_map, report), "cells", report.cells),
            steps("Walk", "along the chain", conclusion.walk, "walk"),
            steps("Contrasts", "forces, by kind of run", report.contrasts, "contrasts"),
        ),
    )


def _answer_section(report: GapReport) -> Section:
    lines = [_ANSWERS]
    lines += [
        f"What would tell {joined(row.answer)} from what looks the same: {measure}."
        for row in report.ranking
        for measure in row.measure
    ]
    if report.hidden:
        lines.append(f"Cannot be seen in these runs: {', '.join(report.hidden)}.")
    return Section(
        "Which",
        (
            Text(lines),
            Figure("ranking", _RANKING, partial(figures.ranking_figure, report)),
            Table("Ranking", RANKING, report.ranking, "ranking"),
            Table("Effects", EFFECTS, report.effects, "effects"),
        ),
    )


def _how_far(report: GapReport) -> Section:
    said = (
        "The withheld runs, which nobody looked at before"
        if report.held_out
        else "Each regime, predicted from all other runs"
    )
    text = Text((f"{said}: the gap in u, noise taken off.",))
    drawn = Figure("withheld", _WITHHELD, partial(figures.withheld_figure, report))
    return Section(
        "How far",
        (
            *((text, drawn) if report.regimes else ()),
            Table("Controls", CONTROLS, report.controls, "controls"),
            Table("Regimes", REGIMES, report.regimes, "regimes"),
        ),
    )


def _coefficients(report: GapReport) -> Section:
    lines = [f"Derivatives: {report.convention}. ± is two standard uncertainties."]
    lines = [*unexplained(report.conclusion), *lines]
    if report.conclusion.verdict == EFFECT:
        lines.append(_BIAS)
    columns = coefficient_columns(compared=any(row.compared for row in report.coefficients))
    table = Table("Coefficients", columns, report.coefficients, "coefficients")
    return Section("Coefficients", (Text(lines), table))


def unexplained(conclusion: Conclusion) -> Iterator[str]:
    """Yield what the head of a table of coefficients has to say of a gap that nothing explains."""
    if conclusion.unexplained:
        gaps = ", ".join(f"{step.what} {step.gap_u:.1f} u" for step in conclusion.unexplained)
        yield (
            f"CAUTION: much is left unexplained ({gaps}). What it does to these values is not in "
            "their ±."
        )


def _remains(report: GapReport) -> Section:
    form = report.description
    maps = () if form is None else form.maps
    has_values = any(not math.isnan(x) for force_map in maps for x in force_map.force_n.flat)
    drawn = [Figure("map", _MAP, partial(figures.force_map_figure, maps))] if has_values else []
    lines = [f"{line[0].upper()}{line[1:]}." for line in described(form)]
    table = steps("Remainder", "step", report.conclusion.remains, "remains")
    return Section("What remains", (Text(lines), *drawn, table))


def _next_section(report: GapReport) -> Section:
    lines = [_ODDS.format(", ".join(run["between"])) for run in report.next_runs[:1]]
    return Section("Next", (Text(lines), Table("Next", NEXT, report.next_runs, "next_runs")))


def described(description: Description | None) -> Sequence[str]:
    """Return the description of a remainder, a sentence each; it names no cause."""
    if description is None:
        return ()
    orders = sorted(description.orders.items(), key=lambda pair: -pair[1])[:3]
    lines = [
        "its form, not its cause: harmonics "
        + ", ".join(f"{n} ({100.0 * share:.0f} %)" for n, share in orders),
        "a curve over one quantity carries "
        + ", ".join(
            f"{100.0 * share:z.0f} % ({name})" for name, share in description.follows.items()
        ),
    ]
    laws = [("frequency", description.frequency_power), ("amplitude", description.amplitude_power)]
    powers = [f"{name}^{power:z.1f}" for name, power in laws if math.isfinite(power)]
    if powers:
        lines.append(f"it grows as {', '.join(powers)}")
    if math.isfinite(description.air_over_water):
        lines.append(f"in air it is {description.air_over_water:.2f} times as large as in water")
    if description.law.terms:
        terms = ", ".join(
            f"{channel}: {n:+.3g} N {term}" for channel, term, n in description.law.terms
        )
        lines.append(
            f"few terms that carry {100.0 * description.law.explained:.0f} % of it: {terms}"
        )
    return lines
