"""The gap diagnosis as one page: it needs no other file, no network and no script."""

import math
from pathlib import Path
from typing import Final

from pmm.gap.coefficients import headings
from pmm.gap.describing import described
from pmm.gap.report import GapReport, joined
from pmm.gap.rows import said_of
from pmm.report import gap_figures as figures
from pmm.report.parts import Drawing, Head, Part, Table, drawn, write_parts

_WALK: Final = (
    "The walk along the chain: a gap lies where it first appears. Motion and forces are shown with "
    "the simulated input and, where the shaft or the struts have sensors, with the measured one in "
    "its place."
)
_NOTE: Final = (
    "Measured minus simulated, E, against its standard uncertainty u. What the free coefficients "
    "(added mass, damping, restoring, mass) and the settings may explain within their tolerances "
    "is taken off first: 1 is noise alone."
)
_HEAT: Final = (
    "E/u over stage, channel, harmonic and run, before and after the best answer; below, what the "
    "forces show beside the harmonics. Light is noise."
)


def write_gap_page(report: GapReport, path: Path, *, command: str) -> None:
    """Write a diagnosis as one HTML page.

    Parameters
    ----------
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it.
    """
    left_out = [(f"{name} left out", why) for name, why in report.left_out.items()]
    notes = [("note", one) for one in report.notes]
    held = f", {len(report.held_out)} withheld" if report.held_out else ""
    head = Head(
        f"{report.campaign}: rig and simulation",
        (report.sentence,),
        f"{_NOTE} {len(report.runs)} runs used{held}.",
        (*left_out, *notes),
    )
    write_parts(head, _parts(report), path, command=command)


def _parts(report: GapReport) -> tuple[Part | None, ...]:
    return (
        _where(report),
        _which(report),
        _how_far(report),
        _coefficients(report),
        _remainder(report),
        _next(report),
    )


def _where(report: GapReport) -> Part:
    shares = [f"{name} {share:.2f}" for name, share in report.stages.items() if share > 0.005]
    named = report.verdict in ("effect", "unknown")
    steps = tuple(
        (one.what, one.verdict, one.worst, *one.said) for one in (*report.walk, *report.contrasts)
    )
    headings = ("step, or kind of run", "verdict", "largest", "E/u as stated", "E/u", "numbers")
    return Part(
        "Where",
        (f"Stage, by the answers' probabilities: {', '.join(shares)}.",) if named else (),
        (
            drawn(figures.walk_figure(report), "walk", _WALK),
            drawn(figures.heat_map(report), "heat", _HEAT),
        ),
        (Table("Walk", headings, steps, 3),),
    )


def _which(report: GapReport) -> Part:
    rows = tuple(
        (
            joined(one.answer),
            one.stage,
            "; ".join(one.parameters),
            *one.said,
        )
        for one in report.ranking
    )
    headings = ("answer", "stage", "parameters (95 %)", "probability", "withheld gap [u]")
    first = report.ranking[0].measure if report.ranking else []
    said = [f"What would tell the class apart: {one}." for one in first]
    if report.hidden:
        said.append(f"Cannot be seen in these runs: {', '.join(report.hidden)}.")
    drawing = drawn(
        figures.ranking_figure(report),
        "ranking",
        "Answers by probability: named effects, pairs, something unknown, no gap.",
    )
    tables = (Table("Ranking", headings, rows, 3), _effects(report))
    return Part("Which", tuple(said), (drawing,), tables if report.effects else tables[:1])


def _effects(report: GapReport) -> Table:
    rows = tuple((one.name, one.stage, *said_of(one)) for one in report.effects)
    headings = (
        "effect in any answer", "stage", "cannot be told from", "probability",
        "probability of its class",
    )  # fmt: skip
    return Table("Effects", headings, rows, 3)


def _how_far(report: GapReport) -> Part | None:
    if not report.regimes:
        return None
    rows = tuple((one.what, *one.said) for one in report.controls)
    said = (
        "The withheld runs, which nobody looked at before."
        if report.held_out
        else "Each regime, predicted from all other runs."
    )
    headings = ("answer", "gap before, in u", "after", "shrinks by", "95 %")
    drawing = drawn(figures.withheld_figure(report), "withheld", said)
    return Part("How far", (), (drawing,), (Table("Controls", headings, rows),))


def _coefficients(report: GapReport) -> Part:
    rows = tuple(one.said for one in report.coefficients)
    lines = [
        f"Derivatives: {report.convention}.",
        "Fits start from the stated tolerances; ± is two standard uncertainties.",
    ]
    if report.verdict == "effect":
        lines.append(
            "Bias: by how many standard uncertainties the coefficient is off where the best answer "
            "is not modelled."
        )
    table = Table("Coefficients", headings(report.coefficients), rows, 2)
    return Part("Coefficients", tuple(lines), (), (table,))


def _remainder(report: GapReport) -> Part:
    rows = tuple((one.what, one.verdict, one.worst, f"{one.gap_u:.2f}") for one in report.remains)
    table = Table("Remainder", ("step", "verdict", "largest", "E/u"), rows, 3)
    lines = tuple(f"{line[0].upper()}{line[1:]}." for line in described(report))
    form = report.description
    drawings: tuple[Drawing, ...] = ()
    if form is not None and not all(math.isnan(x) for one in form.maps for x in one.force_n.flat):
        caption = "What no answer explains, as a force over the strut's motion: its form, no cause."
        drawings = (drawn(figures.force_map_figure(form.maps), "map", caption),)
    return Part("What remains", lines, drawings, (table,))


def _next(report: GapReport) -> Part | None:
    if not report.next_runs:
        return None
    rows = tuple((one["said"], f"{one['gain_log_odds']:.1f}") for one in report.next_runs)
    answers = ", ".join(report.next_runs[0]["between"])
    line = f"Runs of this rig, by how well they are expected to tell apart: {answers}."
    table = Table("Next", ("run", "expected log odds"), rows)
    return Part("Next", (line,), (), (table,))
