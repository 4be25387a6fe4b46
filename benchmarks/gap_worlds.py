"""The frozen diagnosis on sealed cases of worlds A to D: marks that were kept, against limits.

The cases take hours, so they are measured one by one by ``python -m benchmarks.boards worlds``;
here their lines are counted and held to the limits of ``tests/sealed/worlds.toml``.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from benchmarks.boards.beside import CASES as FEW
from benchmarks.boards.learned import CALIBRATED, figures_by_row
from benchmarks.boards.row_figures import SHOWN, figures_beside, rows_beside
from benchmarks.boards.rows import Line, kept
from benchmarks.boards.worlds import CASES, WORLDS, marks_in
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.sealed.answering import DIAGNOSIS
from tests.sealed.scoring.by_world import Figure, Held, figures_of, held_to

_BESIDE: Final = {
    "top_1_by_class": "top-1 by class",
    "stage": "stage",
    "unknown_or_like": "unknown, or what says the same",
}
_LEARNED: Final = {
    "class": "top-1 by class",
    "stage": "stage",
    "sure_and_wrong": "wrong at 0.9",
    "calibration_excess": "calibration error in excess",
}


def _rows(lines: Sequence[Line], beside: Sequence[Line], learned: Sequence[Line]) -> Iterator[Row]:
    for world in WORLDS:
        figures = figures_of(marks_in(lines, world))
        own, learning = ([x for x in some if x["campaign"] == world] for some in (beside, learned))
        figures |= figures_beside(own, learning)
        yield from (_row(world, one) for one in held_to(figures, world) if one.count)


def _row(world: str, one: Held) -> Row:
    least = "" if one.at_least is None else f"at least {one.at_least:g}"
    most = "" if one.at_most is None else f"at most {one.at_most:g}"
    return {
        "world": world,
        "figure": one.what,
        "limit": ", ".join(text for text in (least, most) if text),
        "measured": f"{one.value:.3f}",
        "95 % interval": f"{one.low:.3f} to {one.high:.3f}",
        "n": one.count,
        "": one.word.replace("missed", "MISSED"),
    }


def _learned_rows(lines: Sequence[Line]) -> Iterator[Row]:
    for world in WORLDS:
        there = [line for line in lines if line["campaign"] == world]
        for name, figures, mean in figures_by_row(there):
            shown = {what: _with_count(figures[key]) for key, what in _LEARNED.items()}
            whole = f"{mean:.3f}"
            if name in CALIBRATED:
                shown[_LEARNED["stage"]] = whole = "-"
            yield {"world": world, "row": name, **shown, "mean of columns": whole}


def _with_count(figure: Figure) -> str:
    value, low, high, count = figure
    return "-" if value is None else f"{value:.2f} ({low:.2f} to {high:.2f}) of {count}"


def _beside_rows(lines: Sequence[Line]) -> Iterator[Row]:
    for world in WORLDS:
        there = [line for line in lines if line["campaign"] == world]
        for name, figures, mean in rows_beside(there):
            shown = {_BESIDE[key]: _with_count(figures[key]) for key in SHOWN}
            whole = "-" if mean is None else f"{mean:.3f}"
            yield {"world": world, "row": name, **shown, "mean of columns": whole}


def _same(lines: Sequence[Line], again: Sequence[Line]) -> str:
    """Say in how many cases another board's diagnosis has the marks of the worlds' lines.

    How probable its answer is may differ a little: another machine sums in another order.
    """
    there = {(one["campaign"], one["seed"]): one for one in lines}
    keys = [(one["campaign"], one["seed"]) for one in again]
    pairs = [
        (there[key], one["rows"][DIAGNOSIS])
        for key, one in zip(keys, again, strict=True)
        if key in there
    ]
    same = sum(
        all(np.array_equal(whole["values"][key], other["values"][key]) for key in whole["values"])
        for whole, other in pairs
    )
    apart = max(
        (
            abs(one - two)
            for whole, other in pairs
            for one, two in zip(whole["stated"] or (), other["stated"] or (), strict=True)
        ),
        default=0.0,
    )
    return (
        f"The diagnosis has the marks of the worlds' lines in {same} of {len(pairs)} cases, "
        f"its probabilities within {apart:.1g}."
    )


def _trained(learned: Sequence[Line]) -> str:
    trained = ", ".join(sorted({str(one["trained_on"]) for one in learned}))
    return (
        f"Rows that learn: boosted ones trained on {trained} campaigns of worlds A and B, "
        "calibrated ones fitted to the cases of the prior odds."
    )


def counted(
    lines: Sequence[Line], beside: Sequence[Line] = (), learned: Sequence[Line] = ()
) -> Outcome:
    """Hold the figures of all lines to the limits of their worlds.

    Parameters
    ----------
    beside
        Lines of the first cases with the oracle's answers, other rows' and those to other records.
    learned
        Lines of the first cases with the answers of rows that learn.
    """
    there = {world: sum(one["campaign"] == world for one in lines) for world in WORLDS}
    notes = [
        f"Cases in each world: {CASES} with something wrong and as many nulls, mixed by the seed, "
        "case 1 of every world before case 2 of any; figures are of all without a gap and of SNR "
        "from 10 on. Intervals are Wilson's of a share, else the bootstrap's; close: the "
        "interval's better end meets the limit. `python -m benchmarks.boards worlds` "
        "goes on with what is missing.",
        f"Figures beside the oracle's, beside other rows, and of invariance are of the first {FEW} "
        f"cases of each world, so far {len(beside)} of {FEW * len(WORLDS)}: "
        "`python -m benchmarks.boards beside` goes on with them.",
        *(f"Frozen at commit {one}, whose hash is the seed." for one in _frozen(lines)),
        "Stages are the frozen diagnosis's, which gave what is unknown to all stages alike where "
        "nothing tells them apart; since then they count by the effects known of each.",
    ]
    if beside:
        notes.append(
            "Rows beside, SNR from 10: the oracle is told the form and the size of what is there, "
            "should a hypothesis name it; cases state the tolerances of their world to all. The "
            f"linear matcher, whose share is expected, knows the key. {_same(lines, beside)}"
        )
    if learned:
        notes.append(f"{_trained(learned)} {_same(lines, learned)}")
    tables = {
        "Figures by world": list(_rows(lines, beside, learned)),
        "Rows beside": list(_beside_rows(beside)),
        "Rows that learn": list(_learned_rows(learned)),
    }
    measured = {f"cases_{world.lower()}": float(count) for world, count in there.items() if count}
    if lines:
        missed = [row for row in tables["Figures by world"] if row[""] == "MISSED"]
        measured["limits_missed"] = float(len(missed))
    return Outcome({name: rows for name, rows in tables.items() if rows}, measured, tuple(notes))


def _frozen(lines: Sequence[Line]) -> list[str]:
    return list(dict.fromkeys(str(one["frozen"]) for one in lines))


def run(quick: bool, report: Report) -> Outcome:
    """Count what is there; with ``quick`` a few of it."""
    report("counting")
    few = 40 if quick else None
    return counted(kept("worlds")[:few], kept("beside")[:few], kept("learned")[:few])


BENCHMARK = Benchmark("gap_worlds", "Diagnosis of sealed cases, world by world", run)
