"""Sealed loops: how soon a gap is known by our proposals, random runs, a plan, and an oracle.

The cases take hours, so they are pursued one by one by ``python -m benchmarks.boards loops``; here
their lines are counted.
"""

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import numpy as np

from benchmarks.boards.loops import CASES, WORLDS
from benchmarks.boards.rows import Line, kept
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.sealed.loops import MOST, WAYS
from tests.sealed.scoring.intervals import wilson

SNR: Final = {"from_10": 10.0, "from_3": 3.0}
AFTER: Final = (0, 1, 2, 3, 5)
_KNOWN, _SURE, _NEVER = 0.9, 0.95, MOST + 1
_DRAWS, _SEED = 2000, 20262

Figure = Callable[[Sequence[Line]], float]


def is_known(line: Line, way: str, runs: int) -> bool:
    """Tell whether the true class was over 0.9 after so many runs, or when the loop ended."""
    stands = line["ways"][way]
    return float(stands[min(runs, len(stands) - 1)]["truth"]) > _KNOWN


def needed(line: Line, way: str) -> int:
    """Return after how many runs the true class was over 0.9 first; 6 where it never was."""
    stands = line["ways"][way]
    return next((k for k, one in enumerate(stands) if one["truth"] > _KNOWN), _NEVER)


def of_oracle(lines: Sequence[Line]) -> float:
    """Return the share that is known after 3 runs, over the oracle's."""
    ours, oracle = (sum(is_known(one, way, 3) for one in lines) for way in ("ours", "oracle"))
    return ours / oracle if oracle else np.nan


def over_random(lines: Sequence[Line]) -> float:
    """Return the mean of the runs that are needed, over that of random ones."""
    ours, random = (sum(needed(one, way) for one in lines) for way in ("ours", "random"))
    return ours / random if random else np.nan


def sure(lines: Sequence[Line], way: str = "ours") -> list[bool]:
    """Return of the loops that ended sure whether what they name is right."""
    last = [one["ways"][way][-1] for one in lines]
    return [bool(one["right"]) for one in last if one["said"] > _SURE]


def wrong(lines: Sequence[Line]) -> float:
    """Return which part of those that ended sure is wrong."""
    ended = sure(lines)
    return 1.0 - sum(ended) / len(ended) if ended else np.nan


FIGURES: Final[dict[str, Figure]] = {
    "of_oracle": of_oracle, "needed_over_random": over_random, "sure_and_wrong": wrong,
}  # fmt: skip


def _interval(lines: Sequence[Line], figure: Figure) -> tuple[float, float]:
    """Return the bootstrap's 95 % interval over cases."""
    rng = np.random.default_rng(_SEED)
    drawn = [
        figure([lines[int(k)] for k in rng.integers(0, len(lines), len(lines))])
        for _ in range(_DRAWS)
    ]
    low, high = np.nanquantile(drawn, (0.025, 0.975))
    return float(low), float(high)


def _shares(lines: Sequence[Line], where: str) -> Iterator[Row]:
    for way in WAYS:
        row: Row = {"cases": where, "n": len(lines), "way": way}
        for runs in AFTER:
            hits = sum(is_known(one, way, runs) for one in lines)
            low, high = wilson(hits, len(lines))
            row[f"after {runs}"] = f"{hits / len(lines):.3f} [{low:.2f}, {high:.2f}]"
        mean = float(np.mean([needed(one, way) for one in lines]))
        low, high = _interval(lines, lambda some, way=way: _mean(some, way))  # type: ignore[misc]
        row["runs needed"] = f"{mean:.2f} [{low:.2f}, {high:.2f}]"
        ended = sure(lines, way)
        row["ended sure, of them wrong"] = f"{len(ended)}, {len(ended) - sum(ended)}"
        yield row


def _mean(lines: Sequence[Line], way: str) -> float:
    return float(np.mean([needed(one, way) for one in lines]))


def _ratios(lines: Sequence[Line], where: str) -> Iterator[Row]:
    for name, figure in FIGURES.items():
        value = figure(lines)
        if np.isfinite(value):
            low, high = _interval(lines, figure)
            yield {
                "cases": where, "n": len(lines), "figure": name.replace("_", " "),
                "measured": f"{value:.3f}", "95 % interval (bootstrap)": f"{low:.3f} to {high:.3f}",
            }  # fmt: skip


def counted(lines: Sequence[Line]) -> Outcome:
    """Return the shares, the means and what the thresholds ask of all lines."""
    shares: list[Row] = []
    ratios: list[Row] = []
    measured: dict[str, float] = {f"cases_{one.lower()}": _count(lines, one) for one in WORLDS}
    for key, least in SNR.items():
        some = [one for one in lines if one["snr"] >= least]
        for world in ("", *WORLDS):
            there = [one for one in some if not world or one["campaign"] == world]
            if there:
                where = f"SNR from {least:g}" + (f", world {world}" if world else "")
                shares += _shares(there, where)
                ratios += _ratios(there, where)
        values = {name: figure(some) for name, figure in FIGURES.items() if some}
        measured |= {f"{name}_{key}": one for name, one in values.items() if np.isfinite(one)}
    tables = {"Known after so many runs": shares, "Held against": ratios}
    return Outcome({name: rows for name, rows in tables.items() if rows}, measured, _notes(lines))


def _count(lines: Sequence[Line], world: str) -> float:
    return float(sum(one["campaign"] == world for one in lines))


def _notes(lines: Sequence[Line]) -> tuple[str, ...]:
    passed: dict[str, int] = {}
    for line in lines:
        for why, number in line["passed"].items():
            passed[why] = passed.get(why, 0) + number
    seconds: list[Any] = [one["cpu_s"] for one in lines]
    told = [
        f"Asked for: {CASES} cases of each world, of at most 12 runs, whose diagnosis is not sure "
        "to begin with (class probability at most 0.95). Known: the true class has more than 0.9, "
        "as all oscillations that the rig can do leave the class. A loop ends when it is sure, "
        "after 5 runs, or when nothing left is worth a run. Behind each share Wilson's 95 % "
        "interval, behind each mean the bootstrap's. `python -m benchmarks.boards loops` goes on "
        "with what is missing.",
    ]
    if passed:
        why = ", ".join(f"{word} {number}" for word, number in sorted(passed.items()))
        told.append(f"Passed over: {why}.")
    if seconds:
        told.append(f"Processor time of a case, those passed over in it: {np.mean(seconds):.0f} s.")
    frozen = dict.fromkeys(str(one["frozen"]) for one in lines)
    return (*told, *(f"Frozen at commit {one}, whose hash is the seed." for one in frozen))


def run(quick: bool, report: Report) -> Outcome:
    """Count what is there; with ``quick`` a few of it."""
    report("counting")
    return counted(kept("loops")[: 4 if quick else None])


BENCHMARK = Benchmark("gap_loop", "Sealed loops: runs that are proposed, one after the other", run)
