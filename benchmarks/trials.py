"""Random trials, each made from its seed: counted in slices, gone on with where they were left."""

import argparse
import json
import sys
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final

from benchmarks.machine import ROOT, with_machine
from pmm.parallel import open_executor
from pmm.whole_file import write_whole

RESULTS: Final = ROOT / "benchmarks" / "results"


@dataclass
class Found:
    """What trials showed.

    Attributes
    ----------
    wrong
        Sentences, each with its seed; none is how it should be.
    counts
        Of what happened.
    """

    wrong: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)


@dataclass(frozen=True)
class Trials:
    """Trials of one kind.

    Attributes
    ----------
    name, unit
        Of the file that keeps what was found; of what is counted.
    asked
        How many there are to be.
    piece
        Seeds that one call of ``carry_out`` takes.
    pieces
        Calls after which what was found is kept.
    carry_out
        A function of a module: workers call it.
    """

    name: str
    unit: str
    asked: int
    piece: int
    pieces: int
    carry_out: Callable[[range], Found]

    @property
    def file(self) -> Path:
        """Where what was found is kept."""
        return RESULTS / f"{self.name}.json"

    def main(self, arguments: Sequence[str], description: str | None) -> int:
        """Carry trials out up to a seed; return 1 if any was wrong."""
        parser = argparse.ArgumentParser(
            prog=f"python -m benchmarks.{self.name}", description=description
        )
        parser.add_argument("--to", type=int, default=self.asked, help="first seed that is left")
        parser.add_argument("--file", type=Path, default=self.file, help="where counts are kept")
        parser.add_argument("--workers", type=int, default=2, help="processes that work")
        request = parser.parse_args(arguments)
        kept = self.read(request.file)
        if kept[self.unit] < request.to:
            kept = with_machine(kept)
        with open_executor(request.workers) as executor:
            while kept[self.unit] < request.to:
                first = kept[self.unit]
                end = min(first + self.piece * self.pieces, request.to)
                found = executor.map(self.carry_out, self._cut(range(first, end)))
                kept = self._with(kept, end, found)
                write_whole(request.file, json.dumps(kept, indent=1) + "\n")
        sys.stdout.write(f"{kept[self.unit]} {self.unit}, {len(kept['wrong'])} wrong\n")
        return int(bool(kept["wrong"]))

    def read(self, file: Path) -> dict[str, Any]:
        """Return what was found so far."""
        if file.exists():
            found: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
            return found
        return {self.unit: 0, "wrong": [], "counts": {}}

    def few(self, count: int) -> dict[str, Any]:
        """Carry a few out, here and now, and keep nothing."""
        pieces = map(self.carry_out, self._cut(range(count)))
        return self._with(self.read(Path("nowhere")), count, pieces)

    def _cut(self, seeds: range) -> list[range]:
        return [seeds[at : at + self.piece] for at in range(0, len(seeds), self.piece)]

    def _with(self, kept: dict[str, Any], end: int, pieces: Any) -> dict[str, Any]:
        counts, wrong = Counter(kept["counts"]), list(kept["wrong"])
        for found in pieces:
            counts += found.counts
            wrong += found.wrong
        after = {self.unit: end, "wrong": wrong, "counts": dict(sorted(counts.items()))}
        return kept | after
