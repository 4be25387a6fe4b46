"""What of a recording's file is not what was written: said, and counted as missing."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from analysis.readers.checksums import (
    BLOCK_SAMPLES,
    RUN,
    Sums,
    attribute_sums,
    block_of,
    changed_attributes,
    has_sums,
    read_sums,
)
from analysis.recording import Recording
from hardware.description import dataset as schema
from hardware.description.arrays import BoolArray
from hardware.description.errors import DataError
from hardware.description.flags import DAMAGED, Flag, Severity

_READ: Final = 128 * BLOCK_SAMPLES  # values looked at in one go: a megabyte
_NAMED: Final = 3  # stretches of a variable; the others are counted
_REMEDY: Final = "copy the file again, or move it away and have pmm recover make it again"


@dataclass(frozen=True, eq=False)
class Damage:
    """What is not what was written.

    Attributes
    ----------
    blocks
        Variable to whether each of its blocks is damaged; only of variables that have such.
    flags
        Those that need no time to be said: of attributes, and of the file as a whole.
    """

    blocks: Mapping[str, BoolArray]
    flags: tuple[Flag, ...]

    def good(self, name: str, count: int) -> list[tuple[int, int]]:
        """Return first value and end of each stretch of a variable that is what was written."""
        bad = self.blocks.get(name)
        return [(0, count)] if bad is None else stretches(~bad, block_of(name), count)

    def all_flags(self, recording: Recording, edges: int) -> Iterator[Flag]:
        """Yield what is to be said: a flag for each variable with damaged blocks, and the others.

        Parameters
        ----------
        edges
            How many pulses were written.
        """
        for name, bad in self.blocks.items():
            count = edges if name == schema.EDGE_TIME else recording.sample_count
            damaged = stretches(bad, block_of(name), count)
            stretch_words = [
                _stretch_text(name, *stretch, recording) for stretch in damaged[:_NAMED]
            ]
            unnamed = len(damaged) - len(stretch_words)
            places = ", ".join(stretch_words) + (
                f" and {unnamed} more stretches" if unnamed else ""
            )
            message = (
                f"{places} are not what was written; {_INSTEAD.get(name, _MISSING)}; {_REMEDY}"
            )
            yield _flag(message, None if name in _INSTEAD else name)
        yield from self.flags


_MISSING: Final = "they count as missing"
_INSTEAD: Final = {
    schema.TIME: "the even grid of the others stands in their place",
    schema.EDGE_TIME: "they are left out",
}


def find_damage(path: Path, names: Sequence[str]) -> Damage:
    """Compare a file with its checksums, if it has them.

    Parameters
    ----------
    names
        Its channels.

    Raises
    ------
    DataError
        If a variable has not the length that was written.
    """
    import h5py

    with h5py.File(path, "r") as file:
        if not has_sums(file):
            return Damage({}, ())
        sums = read_sums(file)
        if sums is None:
            text = f"its checksums are lost, so that nothing tells what else was changed; {_REMEDY}"
            return Damage({}, (_flag(text),))
        return _compared(file, sums, names)


def _compared(file: Any, sums: Sums, names: Sequence[str]) -> Damage:
    blocks, where = {}, file.filename
    for name in sums.blocks:
        if name not in file:
            continue
        count, written = file[name].shape[0], sums.counts[name]
        if count != written:
            raise DataError(
                f"{where}: the variable {name!r} has {count} values, {written} were written; "
                f"{_REMEDY}"
            )
        bad = _bad_blocks(file[name], name, sums)
        if bad.any():
            blocks[name] = bad
    if schema.TIME in blocks and blocks[schema.TIME].all():
        raise DataError(f"{where}: no time is what was written; {_REMEDY}")
    return Damage(blocks, (*_variable_flags(sums, names), *_attribute_flags(file, sums)))


def carries_checksums(path: Path) -> bool:
    """Tell whether a change in a file would be seen; those of other programs have no checksums."""
    import h5py

    try:
        with h5py.File(path, "r") as file:
            return has_sums(file)
    except OSError:  # no HDF5
        return False


def check_whole(recording: Recording) -> Recording:
    """Return a recording, for what cannot do with a part of it.

    Raises
    ------
    DataError
        If it is not what was written.
    """
    damaged = [flag.message for flag in recording.flags if flag.damaged]
    if damaged:
        raise DataError(f"{recording.name}: {'; '.join(damaged)}")
    return recording


def stretches(bad: BoolArray, block: int, count: int) -> list[tuple[int, int]]:
    """Return first value and end of each row of damaged blocks."""
    edges = np.flatnonzero(np.diff(bad, prepend=False, append=False)) * block
    return [(int(a), min(int(b), count)) for a, b in zip(edges[::2], edges[1::2], strict=True)]


def _bad_blocks(variable: Any, name: str, sums: Sums) -> BoolArray:
    """Tell of each block whether it is damaged; what cannot be read at all is."""
    block, count = block_of(name), sums.counts[name]
    bad = np.ones(sums.blocks[name].size, bool)
    for start in range(0, count, _READ):
        stop = min(start + _READ, count)
        try:
            values = np.asarray(variable[start:stop], np.float64)
        except (OSError, RuntimeError, TypeError, ValueError):
            continue
        bad[start // block : -(-stop // block)] = ~sums.is_same(name, values, start)
    return bad


def _variable_flags(sums: Sums, names: Sequence[str]) -> Iterator[Flag]:
    written = [name for name in sums.blocks if name not in (schema.TIME, schema.EDGE_TIME)]
    for name in written:
        if name not in names:
            yield _flag(f"the channel {name} was written and is not there; {_REMEDY}")
    for name in names:
        if name not in written:
            yield _flag(f"the channel was not there when the file was written; {_REMEDY}", name)


def _attribute_flags(file: Any, sums: Sums) -> Iterator[Flag]:
    sums_now = {RUN: attribute_sums(file.attrs)}
    for name in [name for name in sums.attributes if name in file and name != RUN]:
        sums_now[name] = attribute_sums(file[name].attrs)
    for name, key in changed_attributes(sums, sums_now):
        if name in sums_now:
            of = f" of {name}" if name else ""
            text = f"the attribute {key!r}{of} is not what was written; it is taken as it stands"
            yield _flag(f"{text}; {_REMEDY}", None if name in (RUN, *_INSTEAD) else name)


def _stretch_text(name: str, start: int, stop: int, recording: Recording) -> str:
    if name == schema.EDGE_TIME:
        return f"photocell pulses {start + 1} to {stop}"
    first_s, last_s = recording.time_s(start, start + 1)[0], recording.time_s(stop - 1, stop)[0]
    subject = "times of samples" if name == schema.TIME else "samples"
    return f"{subject} {start} to {stop - 1} ({first_s:.3f} s to {last_s:.3f} s)"


def _flag(message: str, channel: str | None = None) -> Flag:
    return Flag(DAMAGED, Severity.VOID, f"{channel}: {message}" if channel else message, channel)
