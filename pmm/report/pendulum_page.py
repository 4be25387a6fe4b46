"""A pendulum's gap diagnosis as one page: it needs no other file, no network and no script."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from analysis.gap.pendulum.diagnose import Diagnosis
from pmm.gap.pendulum_examine import Examined
from pmm.gap.pendulum_sections import HOW_FAR, RECORDS, WHERE, WHICH, sections
from pmm.gap.pendulum_words import sentences
from pmm.report import pendulum_figures as figures
from pmm.report.parts import Drawing, Head, Part, drawn, write_parts

_HEAT: Final = (
    "E/u of each record and kind of observable, window by window: as stated, and with the best "
    "answer. Light is noise."
)
_NOTE: Final = "Below, u is the standard uncertainty of a number: a difference of 1 u is noise."
_RANKING: Final = "Answers by probability: sets of causes, something unknown, no gap."
_WITHHELD: Final = "The gap of swings that the fit has not seen, with the answer and a wrong cause."
_SWINGS: Final = "Amplitude and phase, measured and simulated; both simulations are fitted freely."


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
    notices = tuple(("note", one) for one in examined.notes)
    head = Head(f"{name}: measured and simulated", sentences(found), _NOTE, notices)
    parts = [Part(one, tuple(_drawings(found, one.title))) for one in sections(found)]
    write_parts(head, parts, path, command=command)


def _drawings(found: Diagnosis, title: str) -> Iterator[Drawing]:
    """Yield the figures of a section."""
    if title == WHERE:
        yield drawn(figures.heat_map(found), "heat", _HEAT)
    if title == WHICH:
        yield drawn(figures.ranking_figure(found), "ranking", _RANKING)
    if title == HOW_FAR:
        yield drawn(figures.withheld_figure(found), "withheld", _WITHHELD)
    for at, trial in enumerate(found.problem.trials if title == RECORDS else ()):
        caption = f"{trial.name}. {_SWINGS}"
        yield drawn(figures.swings_figure(found, at), f"record{at + 1}", caption)
