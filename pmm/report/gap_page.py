"""The gap diagnosis as one page: it needs no other file, no network and no script."""

import math
from pathlib import Path
from typing import Final

from pmm.gap.report import GapReport
from pmm.gap.sections import HOW_FAR, REMAINS, WHERE, WHICH, sections
from pmm.report import gap_figures as figures
from pmm.report.parts import Drawing, Head, Part, drawn, write_parts

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
_WITHHELD: Final = (
    "The gap of runs that an answer was not fitted to, without it and with each answer."
)
_MAP: Final = "What no answer explains, as a force over the strut's motion: its form, no cause."


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
    head = Head(
        f"{report.campaign}: rig and simulation",
        report.said,
        report.used,
        (*left_out, *notes),
    )
    parts = [Part(one, _drawings(report, one.title)) for one in sections(report)]
    write_parts(head, parts, path, command=command)


def _drawings(report: GapReport, title: str) -> tuple[Drawing, ...]:
    """Return the figures of a section."""
    if title == WHERE:
        walk = drawn(figures.walk_figure(report), "walk", _WALK)
        return walk, drawn(figures.heat_map(report), "heat", _HEAT)
    if title == WHICH:
        return (drawn(figures.ranking_figure(report), "ranking", _RANKING),)
    if title == HOW_FAR:
        return (drawn(figures.withheld_figure(report), "withheld", _WITHHELD),)
    form = report.description
    if title != REMAINS or form is None:
        return ()
    if all(math.isnan(x) for one in form.maps for x in one.force_n.flat):
        return ()
    return (drawn(figures.force_map_figure(form.maps), "map", _MAP),)
