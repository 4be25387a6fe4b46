"""The frozen diagnosis on sealed cases of worlds A to D: marks that were kept, against limits.

The cases take hours, so they are measured one by one by ``python -m benchmarks.boards worlds``;
here their lines are counted and held to the limits of ``tests/sealed/worlds.toml``.
"""

from collections.abc import Iterator, Sequence

from benchmarks.boards.beside import CASES as FEW
from benchmarks.boards.beside import figures_beside
from benchmarks.boards.rows import Line, kept
from benchmarks.boards.worlds import CASES, WORLDS, marks_in
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.sealed.scoring.by_world import Held, figures_of, held_to


def _rows(lines: Sequence[Line], beside: Sequence[Line]) -> Iterator[Row]:
    for world in WORLDS:
        figures = figures_of(marks_in(lines, world))
        figures |= figures_beside([one for one in beside if one["campaign"] == world])
        yield from (_row(world, one) for one in held_to(figures, world) if one.count)


def _row(world: str, one: Held) -> Row:
    least = "" if one.at_least is None else f"at least {one.at_least:g}"
    most = "" if one.at_most is None else f"at most {one.at_most:g}"
    return {
        "world": world,
        "figure": one.what,
        "limit": ", ".join(text for text in (least, most) if text),
        "measured": f"{one.value:.3f}",
        "95 % interval (bootstrap)": f"{one.low:.3f} to {one.high:.3f}",
        "n": one.count,
        "": one.word.replace("missed", "MISSED"),
    }


def counted(lines: Sequence[Line], beside: Sequence[Line] = ()) -> Outcome:
    """Hold the figures of all lines to the limits of their worlds.

    Parameters
    ----------
    beside
        Lines of the first cases with the oracle's answers, other rows' and those to other records.
    """
    there = {world: sum(one["campaign"] == world for one in lines) for world in WORLDS}
    notes = [
        f"Cases in each world: {CASES} with something wrong and as many nulls, mixed by the seed, "
        "case 1 of every world before case 2 of any; figures are of nulls and of SNR from 10 on. "
        "Close: the interval's better end meets the limit. `python -m benchmarks.boards worlds` "
        "goes on with what is missing.",
        f"Figures beside the oracle's, beside other rows, and of invariance are of the first {FEW} "
        "cases of each world: `python -m benchmarks.boards beside` goes on with them.",
        *(f"Frozen at commit {one}, whose hash is the seed." for one in _frozen(lines)),
    ]
    rows = list(_rows(lines, beside))
    measured = {f"cases_{world.lower()}": float(count) for world, count in there.items() if count}
    return Outcome({"Figures by world": rows} if rows else {}, measured, tuple(notes))


def _frozen(lines: Sequence[Line]) -> list[str]:
    return list(dict.fromkeys(str(one["frozen"]) for one in lines))


def run(quick: bool, report: Report) -> Outcome:
    """Count what is there; with ``quick`` a few of it."""
    report("counting")
    few = 40 if quick else None
    return counted(kept("worlds")[:few], kept("beside")[:few])


BENCHMARK = Benchmark("gap_worlds", "Diagnosis of sealed cases, world by world", run)
