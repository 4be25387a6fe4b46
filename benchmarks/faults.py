"""Random faults, mutated inputs and power cuts: what was counted of them.

They take hours, so they are measured in slices by ``python -m benchmarks.storms``, ``.fuzz`` and
``.cuts``; here their counts are held against the thresholds. ``--quick`` measures a few.
"""

import json
from collections.abc import Mapping
from typing import Any, Final

from benchmarks import cuts, storms
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from benchmarks.trials import RESULTS

_BROKEN: Final = {
    "uncaught": "uncaught",
    "hangs over 5 s": "hangs",
    "over 1 GB": "large",
    "silent NaN": "silent",
}
_FUZZ: Final = RESULTS / "fuzz.json"


def run(quick: bool, report: Report) -> Outcome:
    """Count what is there; with ``quick`` measure a few instead."""
    if quick:
        report("a few of each")
        return _counted(storms.TRIALS.few(2), cuts.TRIALS.few(20), None)
    report("counting")
    fuzz = json.loads(_FUZZ.read_text(encoding="utf-8"))
    sequences, power = (one.TRIALS.read(one.TRIALS.file) for one in (storms, cuts))
    return _counted(sequences, power, fuzz)


def _counted(
    sequences: Mapping[str, Any], cuts: Mapping[str, Any], fuzz: Mapping[str, Any] | None
) -> Outcome:
    measured = {
        "sequences": float(sequences["sequences"]),
        "sequences_wrong": float(len(sequences["wrong"])),
        "cuts": float(cuts["cuts"]),
        "cuts_wrong": float(len(cuts["wrong"])),
    }
    tables: dict[str, list[Row]] = {
        "Sequences of commands and faults": _rows(sequences["counts"]),
        "Power cuts": _rows(cuts["counts"]),
    }
    notes = [*_on("sequences", sequences), *_on("cuts", cuts)]
    if fuzz is not None:
        measured["inputs"] = float(fuzz["inputs"])
        measured |= {f"inputs_{key}": float(fuzz["broken"][one]) for one, key in _BROKEN.items()}
        tables["Mutated inputs"] = [_reader(one) for one in fuzz["readers"]]
        notes += _on("inputs", fuzz)
    return Outcome(tables, measured, tuple(notes))


def _rows(counts: Mapping[str, int]) -> list[Row]:
    return [{"what": what, "times": times} for what, times in counts.items()]


def _reader(one: Mapping[str, Any]) -> Row:
    return {
        "reader": one["reader"],
        "inputs": one["done"],
        "taken": one["taken"],
        "refused with a sentence": one["refused"],
        "promises broken": sum(one["broken"].values()),
        "slowest, s": one["slowest_s"],
    }


def _on(what: str, kept: Mapping[str, Any]) -> list[str]:
    """Say where and of what they were counted; a few are counted here and now."""
    machine = kept.get("machine")
    if machine is None:
        return []
    commits = ", ".join(kept.get("commits", [machine["commit"]]))
    return [f"{what}: counted until {machine['date']} at {commits} on {machine['cpu']}."]


BENCHMARK = Benchmark("faults", "Random faults, mutated inputs, power cuts", run)
