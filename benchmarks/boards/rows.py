"""What is measured, slice by slice: jobs, the lines that are kept, and which are there already."""

import json
import lzma
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

from benchmarks.boards import beside, friction, learned, loops, seen, weighings
from benchmarks.boards.campaigns import NULLS
from benchmarks.boards.worlds import CASES, WORLDS
from benchmarks.machine import ROOT

RESULTS: Final = ROOT / "benchmarks" / "results" / "boards"
FOLDERS: Final = 10_000  # mutated folders that go through the door
TYPED: Final = 300  # of them through whole commands
_SLICES: Final[Mapping[str, tuple[int, int]]] = {"mutations": (FOLDERS, 50), "commands": (TYPED, 5)}
_WORLDS, _BESIDE, _LOOPS, _WEIGHINGS = "worlds", "beside", "loops", "weighings"
SEEN: Final = "seen"
LEARNED: Final = "learned"
SEALED: Final = (_WORLDS, _LOOPS)
TRAINING: Final = "training.jsonl.xz"
SEEDED_BY: Final = {_BESIDE: _WORLDS, SEEN: _WORLDS, LEARNED: SEEN}  # whose cases these are
BOARDS: Final = ("nulls", "friction", *_SLICES)
EVERY: Final = (*BOARDS, *SEALED, *SEEDED_BY, _WEIGHINGS)

Line = dict[str, Any]


@dataclass(frozen=True)
class Job:
    """A case of a board, or a slice of mutated folders: seeds ``first`` to before ``stop``.

    ``frozen`` is the commit whose hash is the seed of sealed cases; ``training`` is the file of
    the campaigns that rows learn from, ``folder`` where lines are kept.
    """

    board: str
    campaign: str
    first: int
    stop: int
    frozen: str = ""
    training: str = ""
    folder: Path = RESULTS

    @property
    def key(self) -> tuple[str, int]:
        """What tells its line from the others of its board."""
        return self.campaign, self.first


def jobs_of(board: str, campaigns: Sequence[str], seeds: tuple[int, int] | None) -> list[Job]:
    """Return what a board asks for; seed 0 of every campaign before seed 1 of any.

    Parameters
    ----------
    campaigns
        Names of some; all if empty.
    seeds
        Only from the first up to before the second.
    """
    if board in _SLICES:
        most, step = _SLICES[board]
        every = [Job(board, "mutated", at, min(at + step, most)) for at in range(0, most, step)]
    else:
        counts = _counts(board)
        every = [
            Job(board, name, seed, seed + 1)
            for seed in range(max(counts.values()))
            for name, count in counts.items()
            if seed < count
        ]
    low, high = seeds or (0, FOLDERS)
    return [
        job
        for job in every
        if low <= job.first < high and (not campaigns or job.campaign in campaigns)
    ]


def _counts(board: str) -> Mapping[str, int]:
    """Return how many seeds of each campaign, or cases of each world, are asked for."""
    if board == _WORLDS:
        return dict.fromkeys(WORLDS, 2 * CASES)
    if board in SEEDED_BY:
        return dict.fromkeys(WORLDS, beside.CASES)
    if board == _LOOPS:
        return dict.fromkeys(loops.WORLDS, loops.CASES)
    if board == _WEIGHINGS:
        return dict.fromkeys(weighings.WORLDS, weighings.CASES)
    return friction.SEEDS if board == "friction" else {n: one.seeds for n, one in NULLS.items()}


def measured(job: Job) -> Line:
    """Measure one; in whichever process."""
    if job.board in _SLICES:
        from benchmarks.boards.mutated import counted

        return {"campaign": job.campaign, **counted(job.board, job.first, job.stop)}
    if job.board == _WORLDS:
        from benchmarks.boards.worlds import marked

        return marked(job.campaign, job.first, job.frozen)
    if job.board == _BESIDE:
        return beside.compared(job.campaign, job.first, job.frozen, CASES)
    if job.board == SEEN:
        return seen.seen(job.campaign, job.first, job.frozen, CASES)
    if job.board == LEARNED:
        return learned.answered(_seen(job.folder)[job.key], Path(job.training))
    if job.board == _LOOPS:
        return loops.pursued(job.campaign, job.first, job.frozen)
    if job.board == _WEIGHINGS:
        return weighings.weighed(job.campaign, job.first)
    from benchmarks.boards.judged import null, planted

    judge = null if job.board == "nulls" else planted
    return judge(job.campaign, job.first)


@cache
def _seen(folder: Path) -> Mapping[tuple[str, int], Line]:
    return {case_of(line): line for line in kept(SEEN, folder)}


def case_of(line: Line) -> tuple[str, int]:
    """Return what tells a line from the others of its board, as :attr:`Job.key` does."""
    return line["campaign"], line["seed"]


def file_of(board: str, folder: Path = RESULTS) -> Path:
    """Return where a board's lines are kept."""
    return folder / f"{board}.jsonl"


def kept(board: str, folder: Path = RESULTS) -> list[Line]:
    """Return the lines that are there, compressed ones first; of two of one case the later."""
    file = file_of(board, folder)
    packed = file.with_name(f"{file.name}.xz")
    text = lzma.decompress(packed.read_bytes()).decode() if packed.exists() else ""
    text += file.read_text(encoding="utf-8") if file.exists() else ""
    rows = [json.loads(line) for line in text.splitlines() if line]
    return list({case_of(line): line for line in rows}.values())


def missing(jobs: Sequence[Job], rows: Sequence[Line], commit: str | None) -> Iterator[Job]:
    """Yield the jobs that have no line, or none of this commit if one is given."""
    there = {case_of(line) for line in rows if commit is None or line["commit"] == commit}
    yield from (job for job in jobs if job.key not in there)


def keep(board: str, row: Line, folder: Path = RESULTS) -> None:
    """Add a line; processes that measure at the same time may do so too."""
    folder.mkdir(parents=True, exist_ok=True)
    with file_of(board, folder).open("a", encoding="utf-8") as file:
        file.write(json.dumps(row) + "\n")
