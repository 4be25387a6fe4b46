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
from pmm.document.style import PALETTE, TRACE, label_decades, new_figure
from pmm.sequential.look import Decision, KnownCause, KnownTarget, Look, in_words, read_decisions

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

SCHEMA: Final = "pmm-sequential-1"
_CAPTION: Final = (
    "Standard uncertainty of each target over what is asked for, as measured after each run, "
    "against tank time; a target is met below 1."
)
_TOGETHER: Final = (
    "A target without frequencies is met by a fit of all runs, of all speeds, to the terms that "
    "the design believes in. Tables of coefficients fit each speed by itself, and may miss there "
    "what the speeds tell together."
)
_STYLES: Final = ("-", "--", ":", "-.")

_TARGETS: Final[tuple[Column[KnownTarget], ...]] = (
    word("target", "name"),
    Column("value", lambda row: _number(row.value), written=written(".4g"), number=True),
    Column(
        "standard uncertainty",
        lambda row: _number(row.standard_uncertainty),
        written=written(".3g"),
        number=True,
    ),
    number("asked for", "wanted", written(".3g")),
    word("unit", "unit"),
    word("most of it from", "mostly"),
    Column("met", lambda row: "yes" if row.met else "no"),
)
_STEPS: Final[tuple[Column[Decision], ...]] = (
    Column("runs", lambda row: len(row.runs), number=True),
    Column("last", lambda row: row.runs[-1] if row.runs else ""),
    number("tank time", "time_s", clock),
    Column("met", lambda row: f"{_met_count(row.known)} of {len(row.known)}" if row.known else ""),
    Column("least known", lambda row: _least_known(row.known)),
    Column("then", lambda row: _next_step(row)),
    word("approved by", "approved"),
)


_CAUSES: Final[tuple[Column[KnownCause], ...]] = (
    word("cause", "name"),
    number("probability", "probability", "{:.3f}".format),
    Column("alike in these runs", lambda row: ", ".join(row.alike)),
    Column("known", lambda row: "yes" if row.met else "no"),
)
_PURSUED: Final[tuple[Column[Decision], ...]] = (
    *_STEPS[:3],
    Column("most probable", lambda row: row.causes[0].name if row.causes else ""),
    Column("probability", lambda row: _probability(row), written=written(".3f"), number=True),
    *_STEPS[-2:],
)


def look_lines(look: Look) -> Iterator[str]:
    """Yield what an operator is told after a run: what is known, and what is to be made."""
    heading = f"after {counted(len(look.runs), 'run')}, {clock(look.time_s)}"
    causes = [f"{cause.name} {cause.probability:.3f}" for cause in look.causes]
    words = "; ".join([*map(_in_words, look.known_targets), *causes]) or "nothing is known yet"
    yield f"{heading}: {words}"
    yield from look.notes
    if look.ending is not None:
        yield f"{look.ending}{f': {look.remark}' if look.remark else ''}"
    elif look.proposed:
        yield f"new plan ({look.remark}), {clock(look.left_s)}:"
        for k, (run, why) in enumerate(zip(look.proposed, look.whys, strict=True), 1):
            yield f"  {k}. {in_words(run)}{f' ({why})' if why else ''}"
    else:
        yield f"as planned: {counted(len(look.kept_runs), 'run')} more, {clock(look.left_s)}"


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
    contents = (
        Text([waiting or _summary(name, last)]),
        *_contents(name, decisions),
        Data("folder", folder),
        Data("ending", "waiting" if waiting else last.ending),
        Data("remark", waiting or last.remark),
        Data("runs", last.runs),
        Data("decisions", decisions),
    )
    return Document("", "a campaign that chose its runs", (Section("", contents),), SCHEMA)


def story(folder: Path, name: str) -> Iterator[Section]:
    """Yield what was known after each run of a folder's campaign, where it chose its runs."""
    decisions = read_decisions(folder)
    if decisions:
        notes = [Note("note", _TOGETHER)] if decisions[-1].known else []
        contents = (Text([_summary(name, decisions[-1])]), *_contents(name, decisions))
        yield Section("Run after run", (*contents, Notes(notes)))


def _contents(name: str, decisions: Sequence[Decision]) -> tuple[Content, ...]:
    """Return tables and figure of what was known after each run."""
    last = decisions[-1]
    if any(decision.causes for decision in decisions):
        return (
            Table("Causes", _CAUSES, last.causes, titled=True),
            Table("What was known after each run", _PURSUED, decisions, titled=True),
            Notes([Note("note", note) for note in last.notes]),
        )
    return (
        Table("Targets", _TARGETS, last.known, titled=True),
        Table("What was known after each run", _STEPS, decisions, titled=True),
        Notes([Note("note", note) for note in last.notes]),
        Figure(f"{name}-run-after-run", _CAPTION, partial(sequential_figure, name, decisions)),
    )


def sequential_figure(name: str, decisions: Sequence[Decision]) -> "Drawing":
    """Draw a line for each target: uncertainty over what is asked for, run by run."""
    with new_figure(7.2, 4.2) as figure:
        axes = figure.subplots()
        hours = [decision.time_s / 3600.0 for decision in decisions]
        names = dict.fromkeys(target.name for decision in decisions for target in decision.known)
        for k, target in enumerate(names):
            ratios = [_ratio(decision.known, target) for decision in decisions]
            colour, style = PALETTE[k % len(PALETTE)], _STYLES[k // len(PALETTE) % len(_STYLES)]
            axes.plot(hours, ratios, style, color=colour, marker="o", markersize=3.5, label=target)
        axes.axhline(1.0, color=TRACE, linewidth=1.4)
        axes.set_yscale("log")
        label_decades(axes.yaxis)
        axes.set_xlabel("tank time [h]")
        axes.set_ylabel("standard uncertainty over what is asked for")
        if names:
            figure.legend(loc="outside right upper", ncols=1 + len(names) // 17)
        figure.suptitle(f"{name}: what was known after each run")
    return figure


def _summary(name: str, last: Decision) -> str:
    ending = last.ending or "not at its end; --resume goes on"
    remark = f" ({last.remark})" if last.ending and last.remark else ""
    return f"{name}: {counted(len(last.runs), 'run')}, {clock(last.time_s)}; {ending}{remark}"


def _in_words(target: KnownTarget) -> str:
    if target.standard_uncertainty is None:
        return f"{target.name} unknown"
    verdict = "met" if target.met else f"{target.wanted:.3g} asked"
    return (
        f"{target.name} {target.value:.4g} ± {target.standard_uncertainty:.3g} {target.unit} "
        f"({verdict})"
    )


def _met_count(targets: Sequence[KnownTarget]) -> int:
    return sum(target.met for target in targets)


def _least_known(targets: Sequence[KnownTarget]) -> str:
    unmet = [target for target in targets if not target.met]
    if not unmet:
        return ""
    ratios = {target.name: _number(target.standard_uncertainty) / target.wanted for target in unmet}
    worst = max(ratios, key=lambda name: math.inf if math.isnan(ratios[name]) else ratios[name])
    if math.isnan(ratios[worst]):
        return f"{worst}: unknown"
    return f"{worst}: {ratios[worst]:.3g} times what is asked"


def _next_step(decision: Decision) -> str:
    if decision.ending:
        return decision.ending
    if not decision.is_decided:
        return f"{counted(len(decision.added), 'run')} proposed, not answered"
    if decision.added:
        return f"{counted(len(decision.added), 'run')} planned ({decision.remark})"
    return f"as planned, {counted(len(decision.kept), 'run')} more"


def _ratio(targets: Sequence[KnownTarget], name: str) -> float:
    target = next((target for target in targets if target.name == name), None)
    return math.nan if target is None else _number(target.standard_uncertainty) / target.wanted


def _probability(decision: Decision) -> float:
    return decision.causes[0].probability if decision.causes else math.nan


def _number(value: float | None) -> float:
    return math.nan if value is None else value
