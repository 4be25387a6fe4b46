"""The readers, each with good inputs, how many mutated ones it gets, and how it reads one."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Final

from benchmarks.fuzz import live, recordings, texts

Read = Callable[[bytes], object]


@dataclass(frozen=True)
class Target:
    """One reader.

    Attributes
    ----------
    inputs
        How many mutated ones the whole board has.
    seeds
        Makes the good inputs; given a folder of its own.
    reading
        Gives, for as long as its context lasts, what reads an input; given a folder of its own.
    """

    name: str
    inputs: int
    seeds: Callable[[Path], list[bytes]]
    reading: Callable[[Path, ExitStack], Read]


_OWN: Final = 20_000  # of each format of ours
_CHILD: Final = 3_000  # of each format that a child reads

TARGETS: Final = (
    Target("serial lines", 400_000, lambda _: texts.LINES, lambda *_: texts.read_line),
    Target("CAN frames", 250_000, lambda _: live.FRAMES, live.frames),
    Target("console messages", 100_000, lambda _: texts.POSTED, lambda *_: texts.read_posted),
    Target("CSV text", 100_000, recordings.csv, recordings.reading("fuzzed.csv")),
    *(
        Target(f"TOML: {kind}", 10_000, partial(texts.tables, kind), partial(texts.reading, kind))
        for kind in texts.TABLES
    ),
    Target("run.nc", _OWN, recordings.netcdf, recordings.reading("fuzzed.nc")),
    *(
        Target(name, _OWN, partial(recordings.journal, name), partial(recordings.run, name))
        for name in recordings.JOURNALS
    ),
    Target("MAT 5", _CHILD, recordings.mat_5, recordings.reading("fuzzed.mat")),
    Target("MAT 7.3", _CHILD, recordings.mat_73, recordings.reading("fuzzed.mat")),
    Target("TDMS", _CHILD, recordings.tdms, recordings.reading("fuzzed.tdms")),
)


@contextmanager
def opened(target: Target, folder: Path) -> Iterator[tuple[list[bytes], Read]]:
    """Give a target's good inputs and its reader."""
    with ExitStack() as stack:
        yield target.seeds(folder), target.reading(folder, stack)
