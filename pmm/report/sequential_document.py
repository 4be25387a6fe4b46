"""What a campaign that chose its runs knew after each: lines, a table and a figure."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    number,
    word,
)
from pmm.document.notation import clock, counted, written
from pmm.document.style import PALETTE, TRACE, drawn
from pmm.sequential.look import Decision, KnownCause, KnownTarget, Look, in_words, read_decisions

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

SCHEMA: Final = "pmm-sequential-1"
_CAPTION: Final = (
    "Standard uncertainty of each target over what is asked for, as measured after each run, "
    "against tank time; a target is met below 1."
)
_STYLES: Final = ("-", "--", ":", "-.")

_TARGETS: Final[tuple[Column[KnownTarget], ...]] = (
    word("target", "name"),
    Column("value", lambda one: _number(one.value), written=written(".4g"), number=True),
    Column(
        "standard uncertainty",
        lambda one: _number(one.standard_uncertainty),
        written=written(".3g"),
        number=True,
    ),
    number("asked for", "wanted", written(".3g")),
    word("unit", "unit"),
    word("most of it from", "mostly"),
    Column("met", lambda one: "yes" if one.met else "no"),
)
_STEPS: Final[tuple[Column[Decision], ...]] = (
    Column("runs", lambda one: len(one.runs), number=True),
    Column("last", lambda one: one.runs[-1] if one.runs else ""),
    number("tank time", "time_s", clock),
    Column("met", lambda one: f"{_met(one.known)} of {len(one.known)}" if one.known else ""),
    Column("least known", lambda one: _least(one.known)),
    Column("then", lambda one: _then(one)),
    word("approved by", "approved"),
)


_CAUSES: Final[tuple[Column[KnownCause], ...]] = (
    word("cause", "name"),
    number("probability", "probability", "{:.3f}".format),
    Column("alike in these runs", lambda one: ", ".join(one.alike)),
    Column("known", lambda one: "yes" if one.met else "no"),
)
_PURSUED: Final[tuple[Column[Decision], ...]] = (
    *_STEPS[:3],
    Column("most probable", lambda one: one.causes[0].name if one.causes else ""),
    Column("probability", lambda one: _probability(one), written="{:.3f}".format, number=True),
    *_STEPS[-2:],
)


def look_lines(look: Look) -> Iterator[str]:
    """Yield what an operator is told after a run: what is known, and what is to be made."""
    made = f"after {counted(len(look.runs), 'run')}, {clock(look.time_s)}"
    causes = [f"{one.name} {one.probability:.3f}" for one in look.causes]
    known = "; ".join([*map(_in_words, look.known), *causes]) or "nothing is known yet"
    yield f"{made}: {known}"
    yield from look.notes
    if look.ending is not None:
        yield f"{look.ending}{f': {look.remark}' if look.remark else ''}"
    elif look.proposed:
        yield f"new plan ({look.remark}), {clock(look.left_s)}:"
        for k, (one, why) in enumerate(zip(look.proposed, look.whys, strict=True), 1):
            yield f"  {k}. {in_words(one)}{f' ({why})' if why else ''}"
    else:
        yield f"as planned: {counted(len(look.kept), 'run')} more, {clock(look.left_s)}"


def sequential_document(
    name: str, folder: Path, decisions: Sequence[Decision], waiting: str = ""
) -> Document:
    """Return what was known after each run of a campaign; ``docs/run-control.md`` has the keys.

    Parameters
    ----------
    waiting
        What recordings are waited for, in a sentence; empty where none are.
    """
    last = decisions[-1]
    told = (
        Text([waiting or _said(name, last)]),
        *_contents(name, decisions),
        Data("folder", folder),
        Data("ending", "waiting" if waiting else last.ending),
        Data("remark", waiting or last.remark),
        Data("runs", last.runs),
        Data("decisions", decisions),
    )
    return Document("", "a campaign that chose its runs", (Section("", told),), SCHEMA)


def story(folder: Path, name: str) -> Iterator[Section]:
    """Yield what was known after each run of a folder's campaign, where it chose its runs."""
    decisions = read_decisions(folder)
    if decisions:
        contents = (Text([_said(name, decisions[-1])]), *_contents(name, decisions))
        yield Section("Run after run", contents)


def _contents(name: str, decisions: Sequence[Decision]) -> tuple[Content, ...]:
    """Return tables and figure of what was known after each run."""
    last = decisions[-1]
    if any(one.causes for one in decisions):
        return (
            Table("Causes", _CAUSES, last.causes, titled=True),
            Table("What was known after each run", _PURSUED, decisions, titled=True),
            Notes([Note("note", one) for one in last.notes]),
        )
    return (
        Table("Targets", _TARGETS, last.known, titled=True),
        Table("What was known after each run", _STEPS, decisions, titled=True),
        Notes([Note("note", one) for one in last.notes]),
        Figure(f"{name}-run-after-run", _CAPTION, partial(sequential_figure, name, decisions)),
    )


def sequential_figure(name: str, decisions: Sequence[Decision]) -> "Drawing":
    """Draw a line for each target: uncertainty over what is asked for, run by run."""
    with drawn(7.2, 4.2) as figure:
        axes = figure.subplots()
        hours = [one.time_s / 3600.0 for one in decisions]
        names = dict.fromkeys(target.name for one in decisions for target in one.known)
        for k, target in enumerate(names):
            ratios = [_ratio(one.known, target) for one in decisions]
            colour, style = PALETTE[k % len(PALETTE)], _STYLES[k // len(PALETTE) % len(_STYLES)]
            axes.plot(hours, ratios, style, color=colour, marker="o", markersize=3.5, label=target)
        axes.axhline(1.0, color=TRACE, linewidth=1.4)
        axes.set_yscale("log")
        axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        axes.yaxis.set_minor_formatter(lambda value, _: f"{value:g}")
        axes.set_xlabel("tank time [h]")
        axes.set_ylabel("standard uncertainty over what is asked for")
        if names:
            figure.legend(loc="outside right upper", ncols=1 + len(names) // 17)
        figure.suptitle(f"{name}: what was known after each run")
    return figure


def _said(name: str, last: Decision) -> str:
    ending = last.ending or "not at its end; --resume goes on"
    remark = f" ({last.remark})" if last.ending and last.remark else ""
    return f"{name}: {counted(len(last.runs), 'run')}, {clock(last.time_s)}; {ending}{remark}"


def _in_words(one: KnownTarget) -> str:
    if one.standard_uncertainty is None:
        return f"{one.name} unknown"
    told = "met" if one.met else f"{one.wanted:.3g} asked"
    return f"{one.name} {one.value:.4g} ± {one.standard_uncertainty:.3g} {one.unit} ({told})"


def _met(known: Sequence[KnownTarget]) -> int:
    return sum(one.met for one in known)


def _least(known: Sequence[KnownTarget]) -> str:
    short = [one for one in known if not one.met]
    if not short:
        return ""
    ratios = {one.name: _number(one.standard_uncertainty) / one.wanted for one in short}
    worst = max(ratios, key=lambda one: math.inf if math.isnan(ratios[one]) else ratios[one])
    if math.isnan(ratios[worst]):
        return f"{worst}: unknown"
    return f"{worst}: {ratios[worst]:.3g} times what is asked"


def _then(one: Decision) -> str:
    if one.ending:
        return one.ending
    if one.added:
        return f"{counted(len(one.added), 'run')} planned ({one.remark})"
    return f"as planned, {counted(len(one.kept), 'run')} more"


def _ratio(known: Sequence[KnownTarget], name: str) -> float:
    found = next((one for one in known if one.name == name), None)
    return math.nan if found is None else _number(found.standard_uncertainty) / found.wanted


def _probability(one: Decision) -> float:
    return one.causes[0].probability if one.causes else math.nan


def _number(value: float | None) -> float:
    return math.nan if value is None else value
