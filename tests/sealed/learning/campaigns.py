"""Training campaigns of worlds A and B: what a peer sees of each, and what is right.

A campaign is made, written as a case without key, looked at in every way and thrown away; one file
of numbers stays of it. A folder that was broken off, or is asked for more, goes on where it was.
"""

import json
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from tests.sealed.learning.seen import as_table, seen_of
from tests.sealed.learning.weighed import weighed_of
from tests.sealed.pool import each

SEED: Final = 60
_LIMIT_S: Final = 600.0  # of one campaign
WORLDS: Final = ("A", "B")
NULL_EACH: Final = 3
"""One campaign in so many is a null."""

Numbers = Mapping[str, Any]
LOOKS: Final[Mapping[str, Callable[[Path], Numbers]]] = {
    "components": lambda case: as_table(seen_of(case)),
    "hypotheses": weighed_of,
}
"""What is kept of a campaign, by name: its remainder, or our diagnosis' own hypotheses."""


@dataclass(frozen=True)
class Asked:
    """A campaign to be made."""

    folder: Path
    index: int

    @property
    def target(self) -> Path:
        """The file of what is kept of it."""
        return self.folder / f"{self.index:05d}.json"


def make_one(asked: Asked) -> str:
    """Make a campaign and keep what each look says of it; return its file's name."""
    from tests.sealed.generator.case import make
    from tests.sealed.generator.files import write_open

    world, null = WORLDS[asked.index % len(WORLDS)], asked.index // 2 % NULL_EACH == 0
    case = make(SEED, asked.index, null=null, where=world)
    with TemporaryDirectory() as room:
        write_open(case, Path(room))
        numbers = {name: look(Path(room) / case.name) for name, look in LOOKS.items()}
    verdict = case.content.verdict
    right = case.content.right[0] if verdict == "gap" else (verdict,)
    kept = {"index": asked.index, "right": right, "stages": case.content.stages, "numbers": numbers}
    part = asked.target.with_suffix(".part")
    part.write_text(json.dumps(kept))
    part.replace(asked.target)
    return asked.target.name


def missing(folder: Path, count: int, kept: Collection[int] = ()) -> list[Asked]:
    """Return what is not there of the first ``count`` campaigns, nor kept elsewhere."""
    jobs = [Asked(folder.absolute(), index) for index in range(1, count + 1)]
    return [one for one in jobs if one.index not in kept and not one.target.exists()]


def made(missing: Sequence[Asked], workers: int) -> Iterator[str]:
    """Make campaigns; yield a line on each.

    A campaign that fails is named and left out; it is tried again when called again.
    """
    for one in missing:
        one.folder.mkdir(parents=True, exist_ok=True)
    for done in each(make_one, missing, workers, _LIMIT_S if workers > 1 else None):
        yield done.value or f"campaign {done.job.index}: {done.failed}"
