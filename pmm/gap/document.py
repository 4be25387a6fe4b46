"""What ``pmm gap`` shows of a campaign: said once, for the terminal, the page and programs."""

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any, Final

from analysis.gap.description import Description
from analysis.gap.marginal import Marginal
from pmm.document.content import (
    Column,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.notation import NOT_KNOWN, percent, written
from pmm.gap import figures
from pmm.gap.coefficients import CoefficientRow
from pmm.gap.conclusion import EFFECT, Conclusion
from pmm.gap.report import GapReport
from pmm.gap.rows import ControlRow, Ranked
from pmm.gap.steps import StepRow
from pmm.gap.words import joined

SCHEMA: Final = "pmm-gap-1"
_TWO: Final = written(".2f")
_FOUR: Final = written(".4f")

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
    "Runs of this rig, by how well they are expected to tell apart: {}. Log odds are the natural "
    "logarithm of the factor by which the right answer gains on the others: 3 is a factor of 20."
)

STEPS: Final[tuple[Column[StepRow], ...]] = (
    Column("verdict", lambda one: one.verdict),
    Column("largest", lambda one: one.largest),
    number("E/u as stated", "stated_u", lambda stated: "" if math.isnan(stated) else _TWO(stated)),
    number("E/u", "gap_u", _TWO),
    number("numbers", "count"),
    *data_only("beyond", "worst", "tells", "strained"),
)
RANKING: Final[tuple[Column[Ranked], ...]] = (
    word("answer", "answer", joined),
    word("stage", "stage"),
    Column("parameters (95 %)", lambda one: "; ".join(parameters(one.effects))),
    number("probability", "probability", _FOUR),
    number("withheld", "withheld_u", _TWO, "u"),
    *data_only("effects", "alike", "measure"),
)
EFFECTS: Final[tuple[Column[Marginal], ...]] = (
    word("effect in any answer", "name"),
    word("stage", "stage"),
    Column("cannot be told from", lambda one: _alike(one)),
    number("probability", "probability", _FOUR),
    number("of its class", "class_probability", _FOUR),
    *data_only("size_sigma", "alike"),
)
CONTROLS: Final[tuple[Column[ControlRow], ...]] = (
    word("answer", "what"),
    number("gap before", "before_u", _TWO, "u"),
    number("after", "after_u", _TWO, "u"),
    Column("shrinks", lambda one: shrinks(one), number=True),
    Column("95 %", lambda one: interval(one), number=True),
    *data_only("share", "low", "high"),
)
REGIMES: Final = (
    word("withheld", "regime"),
    number("before", "before", _TWO, "u"),
    number("after", "after", _TWO, "u"),
    number("second best", "second_best", _TWO, "u"),
    number("polynomial", "polynomial", _TWO, "u"),
)
NEXT: Final[tuple[Column[dict[str, Any]], ...]] = (
    Column("run", lambda one: one["said"], "said"),
    Column("expected log odds", lambda one: one["gain_log_odds"], "gain_log_odds", written(".1f"),
           number=True),
    Column(None, lambda one: one["run"], "run"),
    Column(None, lambda one: one["between"], "between"),
)  # fmt: skip


def document(report: GapReport) -> Document:
    """Return what is shown of a campaign."""
    return Document(report.campaign, "rig and simulation", tuple(_sections(report)), SCHEMA)


def _sections(report: GapReport) -> Iterator[Section]:
    """Yield what there is to show, in the order in which it is read."""
    yield _answer(report)
    yield _where(report)
    yield _which(report)
    yield _how_far(report)
    yield _coefficients(report)
    yield _remains(report)
    yield _next(report)


def _answer(report: GapReport) -> Section:
    found, held = report.conclusion, len(report.held_out)
    withheld = f", {held} withheld" if held else ""
    used = (
        f"{len(report.runs)} runs used{withheld}, {len(report.left_out)} left out. Below, u is the "
        "standard uncertainty of a number: a difference of 1 u is noise."
    )
    left_out = [Note("left out", f"{name}: {why}") for name, why in report.left_out.items()]
    told = ("campaign", "runs", "held_out", "left_out", "how_large", "stages", "hidden",
            "convention", "description")  # fmt: skip
    return Section(
        "",
        (
            Text(report.said, "said", strong=True),
            Text((used,)),
            Notes(left_out),
            Notes([Note("note", one) for one in report.notes], "notes"),
            *(Data(key, getattr(report, key)) for key in told),
            Data("verdict", found.verdict),
            Data("class_probability", found.probability),
            Data("takes", found.weighing.takes),
        ),
    )


def steps(name: str, heading: str, rows: Sequence[StepRow], key: str) -> Table[StepRow]:
    """Return a table of steps of the walk, or of contrasts."""
    return Table(name, (word(heading, "what"), *STEPS), rows, key, filled=True)


def _where(report: GapReport) -> Section:
    shares = [f"{name} {share:.2f}" for name, share in report.stages.items() if share > 0.005]
    stage = f"Stage, by the answers' probabilities: {', '.join(shares)}."
    found = report.conclusion
    return Section(
        "Where",
        (
            Text((_E, stage) if found.gap and shares else (_E,)),
            Figure("walk", _WALK, partial(figures.walk_figure, report)),
            Figure("heat", _HEAT, partial(figures.heat_map, report), "cells", report.cells),
            steps("Walk", "along the chain", found.walk, "walk"),
            steps("Contrasts", "forces, by kind of run", report.contrasts, "contrasts"),
        ),
    )


def _which(report: GapReport) -> Section:
    lines = [_ANSWERS]
    lines += [
        f"What would tell {joined(row.answer)} from what looks the same: {one}."
        for row in report.ranking
        for one in row.measure
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


def parameters(effects: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return each parameter of an answer's effects with its interval, as people read it."""
    return [
        f"{name} = {_with_interval(value)}"
        for effect in effects
        for name, value in effect["parameters"].items()
    ]


def _with_interval(one: Mapping[str, float]) -> str:
    if one["low"] == one["high"]:  # not fitted
        return f"{one['value']:.4g}"
    return f"{one['value']:.4g} ({one['low']:.4g} to {one['high']:.4g})"


def _alike(one: Marginal) -> str:
    if math.isnan(one.class_probability):
        return "its absence"
    return ", ".join(f"{name} ({left:.1f} sigma left)" for name, left in one.alike.items())


def shrinks(one: ControlRow) -> str:
    """Return by how much a gap shrinks; a dash where there was none."""
    return percent("z.0f")(one.share if one.before_u > 0.0 else math.nan)


def interval(one: ControlRow) -> str:
    """Return the interval of that; a dash where nobody knows it."""
    if one.before_u <= 0.0 or math.isnan(one.low):
        return NOT_KNOWN
    return f"{100.0 * one.low:z.0f} to {percent('z.0f')(one.high)}"


def _how_far(report: GapReport) -> Section:
    said = (
        "The withheld runs, which nobody looked at before"
        if report.held_out
        else "Each regime, predicted from all other runs"
    )
    told = Text((f"{said}: the gap in u, noise taken off.",))
    drawn = Figure("withheld", _WITHHELD, partial(figures.withheld_figure, report))
    return Section(
        "How far",
        (
            *((told, drawn) if report.regimes else ()),
            Table("Controls", CONTROLS, report.controls, "controls"),
            Table("Regimes", REGIMES, report.regimes, "regimes"),
        ),
    )


def _coefficients(report: GapReport) -> Section:
    lines = [f"Derivatives: {report.convention}. ± is two standard uncertainties."]
    lines = [*unexplained(report.conclusion), *lines]
    if report.conclusion.verdict == EFFECT:
        lines.append(_BIAS)
    columns = coefficient_columns(compared=any(one.compared for one in report.coefficients))
    table = Table("Coefficients", columns, report.coefficients, "coefficients")
    return Section("Coefficients", (Text(lines), table))


def coefficient_columns(*, compared: bool) -> tuple[Column[CoefficientRow], ...]:
    """Return the columns of the coefficients; ``compared`` if they were fitted with an effect."""
    fitted: tuple[Column[CoefficientRow], ...] = (
        Column(
            "fitted without effect" if compared else "fitted",
            lambda one: f"{one.without:.6g} ± {2.0 * one.u_without:.2g}",
            number=True,
        ),
    )
    with_it: tuple[Column[CoefficientRow], ...] = (
        Column("with it", lambda one: f"{one.with_effect:.6g} ± {2.0 * one.u_with:.2g}",
               number=True),
        number("bias", "bias_u", written("+z.1f"), "u"),
    )  # fmt: skip
    return (
        Column("coefficient", lambda one: one.where),
        word("unit", "unit"),
        number("stated", "stated", written(".6g")),
        *fitted,
        *(with_it if compared else data_only("bias_u")),
        *data_only("name", "without", "u_without", "with_effect", "u_with", "speed_m_s",
                   "frequency_hz"),
    )  # fmt: skip


def unexplained(found: Conclusion) -> Iterator[str]:
    """Yield what the head of a table of coefficients has to say of a gap that nothing explains."""
    if found.unexplained:
        left = ", ".join(f"{one.what} {one.gap_u:.1f} u" for one in found.unexplained)
        yield (
            f"CAUTION: much is left unexplained ({left}). What it does to these values is not in "
            "their ±."
        )


def _remains(report: GapReport) -> Section:
    form = report.description
    maps = () if form is None else form.maps
    known = any(not math.isnan(x) for one in maps for x in one.force_n.flat)
    drawn = [Figure("map", _MAP, partial(figures.force_map_figure, maps))] if known else []
    lines = [f"{line[0].upper()}{line[1:]}." for line in described(form)]
    table = steps("Remainder", "step", report.conclusion.remains, "remains")
    return Section("What remains", (Text(lines), *drawn, table))


def _next(report: GapReport) -> Section:
    lines = [_ODDS.format(", ".join(one["between"])) for one in report.next_runs[:1]]
    return Section("Next", (Text(lines), Table("Next", NEXT, report.next_runs, "next_runs")))


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
