"""A pendulum's gap diagnosis as one page: it needs no other file, no network and no script."""

from pathlib import Path
from typing import Final

from analysis.gap.pendulum.diagnose import Diagnosis
from analysis.gap.pendulum.said import said
from pmm.gap import pendulum_tables as tables
from pmm.gap.pendulum_examine import Examined
from pmm.report import pendulum_figures as figures
from pmm.report.parts import Head, Part, Table, drawn, write_parts

_NOTE: Final = (
    "Measured minus simulated, E, against its standard uncertainty u, in windows of whole swings: "
    "amplitude (decay), phase (period), mean, third harmonic. As stated, the releases alone are "
    "fitted; what is known within tolerances is fitted too after that. 1 is noise alone."
)
_HEAT: Final = (
    "E/u of each record and kind of observable, window by window: as stated, and with the best "
    "answer. Light is noise."
)


def write_pendulum_page(examined: Examined, name: str, path: Path, *, command: str) -> None:
    """Write a diagnosis as one HTML page.

    Parameters
    ----------
    name
        What the records are of.
    path
        The file to write; its folder is made if it is not there.
    command
        What was run to make it.
    """
    found = examined.diagnosis
    lines = tuple(map(_sentence, said(found)))
    notices = tuple(("note", one) for one in examined.notes)
    head = Head(f"{name}: measured and simulated", lines, _NOTE, notices)
    parts = (
        _where(found),
        _which(found),
        _laws(found),
        _how_far(found),
        _records(found),
        _remains(found),
        _next(found),
    )
    write_parts(head, parts, path, command=command)


def _sentence(line: str) -> str:
    return f"{line[0].upper()}{line[1:]}."


def _table(rows: tables.Rows) -> Table:
    return Table(rows.title, rows.headings, rows.rows, rows.words)


def _where(found: Diagnosis) -> Part:
    heat = drawn(figures.heat_map(found), "heat", _HEAT)
    return Part("Where", (), (heat,), (_table(tables.where_rows(found)),))


def _which(found: Diagnosis) -> Part:
    caption = "Answers by probability: sets of causes, something unknown, no gap."
    drawing = drawn(figures.ranking_figure(found), "ranking", caption)
    shown = (tables.answer_rows(found), tables.class_rows(found), tables.alternative_rows(found))
    return Part("Which", (), (drawing,), tuple(_table(one) for one in shown if one.rows))


def _laws(found: Diagnosis) -> Part | None:
    rows = tables.law_rows(found)
    line = (
        "Each law beside what else the answer holds. One is told from the best only if the whole "
        "record prefers the best by a factor of 20, and the other foretells no withheld swings "
        "better by more than 0.2 u."
    )
    return Part("Laws of damping", (line,), (), (_table(rows),)) if rows.rows else None


def _how_far(found: Diagnosis) -> Part | None:
    if not found.regimes:
        return None
    caption = "The gap of swings that the fit has not seen, with the answer and a wrong cause."
    drawing = drawn(figures.withheld_figure(found), "withheld", caption)
    shown = tuple(_table(one) for one in tables.regime_rows(found))
    return Part("How far", (), (drawing,), shown)


def _records(found: Diagnosis) -> Part:
    caption = "Amplitude and phase, measured and simulated; both simulations are fitted freely."
    return Part(
        "Records",
        (),
        tuple(
            drawn(figures.swings_figure(found, at), f"record{at + 1}", f"{trial.name}. {caption}")
            for at, trial in enumerate(found.problem.trials)
        ),
    )


def _remains(found: Diagnosis) -> Part:
    rows = tuple(
        (one.kind, "gap" if one.beyond else "no gap", f"{one.after:.2f}") for one in found.where
    )
    wide = found.verdict.inflation
    line = (
        f"All evidence is weakened by {wide:.2f}, the chi-square per degree of freedom that the "
        "search's best fit leaves."
    )
    table = Table("Remainder", ("where", "verdict", "E/u"), rows, 2)
    return Part("What remains", (line,) if wide > 1.0 else (), (), (table,))


def _next(found: Diagnosis) -> Part | None:
    rows = tables.next_rows(found)
    if not rows.rows or found.rivals is None:
        return None
    one, other = (" + ".join(rival.names) for rival in found.rivals)
    line = (
        "Records that a further test can make, by the ln evidence that the right one of two "
        f"answers is expected to gain at least, whichever is right: {one}, or {other}."
    )
    return Part("Next", (line,), (), (_table(rows),))
