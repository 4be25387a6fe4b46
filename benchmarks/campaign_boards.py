"""The diagnosis on campaigns that were made, and bad input: what the boards measured, counted.

The boards take hours, so they are measured in slices by ``python -m benchmarks.boards``; here their
lines are counted and held against the thresholds. ``--quick`` measures a case of each kind.
"""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from benchmarks.boards import friction
from benchmarks.boards.campaigns import MANY, NULLS
from benchmarks.boards.outside import FRICTION
from benchmarks.boards.rows import BOARDS, FOLDERS, TYPED, Line, kept
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from tests.sealed.scoring.intervals import wilson

_BROKEN: Final = ("traceback", "failed")
_ALL: Final = "all"


@dataclass(frozen=True)
class Tally:
    """What came out of one campaign's seeds; ``asked`` says how many of them are asked for."""

    name: str
    asked: int
    counts: Mapping[str, int]

    def of(self, *outcomes: str) -> int:
        """Return how many came out so."""
        return sum(self.counts.get(one, 0) for one in outcomes)

    @property
    def judged(self) -> int:
        """Those that were not refused: what breaks down is as wrong as what is wrong."""
        return sum(self.counts.values()) - self.of("refused")

    @property
    def share_wrong(self) -> float:
        """Of those that were judged, one or more."""
        return (self.judged - self.of("right")) / self.judged

    def row(self, what: str, good: str) -> Row:
        """Return the row of the table; the share is that of ``what``, with its interval."""
        wrong = self.judged - self.of("right")
        hits = wrong if good == "few" else self.of("right")
        low, high = wilson(hits, self.judged) if self.judged else (0.0, 1.0)
        return {
            "campaign": self.name,
            "seeds": sum(self.counts.values()),
            "asked for": self.asked,
            "right": self.of("right"),
            "wrong": self.of("alarm", "missed"),
            "refused": self.of("refused"),
            "broken down": self.of(*_BROKEN),
            what: f"{hits / self.judged:.3f}" if self.judged else "-",
            "95 % interval (Wilson)": f"{low:.3f} to {high:.3f}",
        }


def tallies(lines: Sequence[Line], asked: Mapping[str, int]) -> list[Tally]:
    """Return a tally of each campaign, and of all of them at the end."""
    found = {name: Counter[str]() for name in asked}
    for line in lines:
        found[line["campaign"]][line["outcome"]] += 1
    each = [Tally(name, asked[name], counts) for name, counts in found.items()]
    whole = sum(found.values(), Counter[str]())
    return [*each, Tally(_ALL, sum(asked.values()), whole)]


def counted(lines: Mapping[str, Sequence[Line]]) -> Outcome:
    """Count the boards' lines, by board."""
    nulls = tallies(lines["nulls"], {name: one.seeds for name, one in NULLS.items()})
    planted = tallies(lines["friction"], friction.SEEDS)
    spoiled = [
        _spoiled("the door and the quality checks", lines["mutations"], FOLDERS),
        _spoiled("analyse, coefficients, report and gap", lines["commands"], TYPED),
    ]
    tables = {
        "Nulls": [one.row("false alarms", "few") for one in nulls],
        "Coulomb friction below the dynamometers, SNR of 10 to 100": [
            one.row("named", "many") for one in planted
        ],
        "Mutated campaign folders": spoiled,
    }
    measured = {**_of_nulls(nulls), **_of_planted(planted), **_of_spoiled(spoiled)}
    return Outcome(tables, measured, tuple(_notes(lines)))


def _of_nulls(found: Sequence[Tally]) -> dict[str, float]:
    *each, whole = found
    if not whole.judged:
        return {}
    shares = [one.share_wrong for one in each if one.asked == MANY and one.judged]
    worst = {"false_alarms_worst": max(shares)} if shares else {}
    made = float(sum(whole.counts.values()))
    return {"nulls": made, "false_alarms": whole.share_wrong, **worst}


def _of_planted(found: Sequence[Tally]) -> dict[str, float]:
    outside = [one for one in found if one.name == friction.OUTSIDE]
    own = [one for one in found if one.name in friction.PLANTED]
    made = sum(found[-1].counts.values())
    measured = {"planted": float(made)} if made else {}
    for key, ones in (("friction_named", own), ("friction_named_outside", outside)):
        count = sum(one.judged for one in ones)
        if count:
            measured[key] = sum(one.of("right") for one in ones) / count
    return measured


def _spoiled(what: str, lines: Sequence[Line], asked: int) -> Row:
    outcomes: Counter[str] = Counter()
    for line in lines:
        for name, count in line.get("outcomes", {}).items():
            outcomes[name.rpartition(": ")[2]] += count
    broken = sum(len(line.get("tracebacks", ())) for line in lines)
    return {
        "through": what,
        "folders": sum(line["stop"] - line["seed"] for line in lines if "stop" in line),
        "asked for": asked,
        "done": outcomes["done"],
        "refused with a sentence": outcomes["refused"],
        "tracebacks": outcomes["traceback"],
        "folders with one": broken,
    }


def _of_spoiled(rows: Sequence[Row]) -> dict[str, float]:
    found: dict[str, float] = {}
    for key, row in zip(("door", "commands"), rows, strict=True):
        if row["folders"]:
            found[f"folders_{key}"] = float(row["folders"])
            found[f"tracebacks_{key}"] = float(row["tracebacks"])
    return found


def _notes(lines: Mapping[str, Sequence[Line]]) -> Iterator[str]:
    yield (
        "Seeds are 0 and up for every campaign, of noise and, with the sealed generator, of rig, "
        "hull and runs too. `python -m benchmarks.boards BOARD` measures what is missing."
    )
    yield (
        "Through whole commands, gap looks for three effects; a warning of the libraries counts as "
        "a traceback. examples/horizontal and demo/horizontal have two runs and are refused."
    )
    yield (
        "The recordings of examples/foreign drift by 0.004 N/s at the aft gauge (truth.toml); the "
        "campaign file does not state it: naming zero-drift is right there, alone or beside the "
        "friction (decided after the first seed was seen)."
    )
    for board in BOARDS:
        commits = Counter(line["commit"] for line in lines[board])
        if commits:
            said = ", ".join(f"{name} ({count})" for name, count in commits.items())
            yield f"{board}: lines by commit: {said}."
    for board in ("nulls", "friction"):
        wrong = Counter(
            f"{line['campaign']}: {line.get('answer', line.get('said'))}"
            for line in lines[board]
            if line["outcome"] != "right"
        )
        for said, count in sorted(wrong.items()):
            yield f"{board}, not right, {count} times {said}"
    for line in (*lines["mutations"], *lines["commands"]):
        for one in line.get("tracebacks", ()):
            for way, said in one["tracebacks"].items():
                yield f"seed {one['seed']}, {' + '.join(one['mutations'])}: {way}: {said}"


def run(quick: bool, report: Report) -> Outcome:
    """Count what is there; with ``quick`` measure a case of each kind instead."""
    from benchmarks.boards.judged import null, with_outcome
    from benchmarks.boards.mutated import counted as spoiled
    from pmm.gap.examination import Options

    if not quick:
        report("counting")
        return counted(
            {board: [with_outcome(board, one) for one in kept(board)] for board in BOARDS}
        )
    report("a case of each kind")
    few = Options(effects=(FRICTION, "gain-error"))
    made = {
        "nulls": [null("examples/gap", 0, few)],
        "friction": [],
        "mutations": [{"campaign": "mutated", **spoiled("mutations", 0, 1)}],
        "commands": [{"campaign": "mutated", **spoiled("commands", 0, 1)}],
    }
    return counted(
        {board: [{**one, "commit": "quick"} for one in rows] for board, rows in made.items()}
    )


BENCHMARK = Benchmark("campaign_boards", "Diagnosis of made campaigns, and bad input", run)
