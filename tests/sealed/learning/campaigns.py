"""Training campaigns of worlds A and B: what a peer sees of each, and what is right.

A campaign is made, written as a case without key, looked at and thrown away; one file of numbers
stays of it. A folder that was broken off, or is asked for more, goes on where it was.
"""

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

from tests.sealed.learning.seen import as_table, seen_of
from tests.sealed.learning.weighed import weighed_of
from tests.sealed.pool import each

SEED: Final = 60
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
    """A campaign to be made, and what is kept of it."""

    folder: Path
    index: int
    look: str

    @property
    def target(self) -> Path:
        """Its file."""
        return self.folder / f"{self.look}-{self.index:05d}.json"


@dataclass(frozen=True)
class Example:
    """A campaign that was made.

    Attributes
    ----------
    right
        The key's first right answer, or its verdict where no name is right.
    stages
        The key's right stages.
    """

    index: int
    right: tuple[str, ...]
    stages: tuple[str, ...]
    numbers: Numbers


def make_one(asked: Asked) -> str:
    """Make a campaign and keep what is asked of it; return its file's name."""
    from tests.sealed.generator.case import make
    from tests.sealed.generator.files import write_open

    world, null = WORLDS[asked.index % len(WORLDS)], asked.index // 2 % NULL_EACH == 0
    case = make(SEED, asked.index, null=null, where=world)
    with TemporaryDirectory() as room:
        write_open(case, Path(room))
        numbers = LOOKS[asked.look](Path(room) / case.name)
    verdict = case.content.verdict
    right = case.content.right[0] if verdict == "gap" else (verdict,)
    kept = {"index": asked.index, "right": right, "stages": case.content.stages, "numbers": numbers}
    part = asked.target.with_suffix(".part")
    part.write_text(json.dumps(kept))
    part.replace(asked.target)
    return asked.target.name


def made(folder: Path, count: int, look: str, workers: int) -> Iterator[str]:
    """Make what is missing of the first ``count`` campaigns; yield a line on each.

    A campaign that fails is named and left out; it is tried again when called again.
    """
    folder.mkdir(parents=True, exist_ok=True)
    jobs = [Asked(folder.absolute(), index, look) for index in range(1, count + 1)]
    for done in each(make_one, [one for one in jobs if not one.target.exists()], workers):
        yield done.value or f"campaign {done.job.index}: {done.failed}"


def examples(folder: Path, look: str) -> list[Example]:
    """Return the campaigns that were made, in their order."""
    found = []
    for path in sorted(folder.glob(f"{look}-*.json")):
        kept = json.loads(path.read_text())
        found.append(
            Example(kept["index"], tuple(kept["right"]), tuple(kept["stages"]), kept["numbers"])
        )
    return found
