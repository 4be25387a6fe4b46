"""Files of the photocell's times beside recordings: ``run_edges.csv`` beside ``run.csv``."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from analysis.readers.photocell import read_edges
from analysis.readers.reader import text_endings
from hardware.description.errors import PmmError
from pmm.start.shared_line import SAME_TIME

STEM = "{stem}"


def stem_of(path: Path) -> str:
    """Return a file's name without its endings."""
    return Path(path.name.removesuffix(".gz")).stem


def pulse_files(paths: Sequence[Path]) -> str:
    """Return how the files of pulses beside recordings are called, ``{stem}`` for the recording.

    It is empty where most recordings have none beside them that holds increasing times and no more.

    Parameters
    ----------
    paths
        Recordings, files of pulses among them or not.
    """
    tails = sorted({tail for path in paths for tail in _tails(path)})
    for tail in tails:
        having = [path for path in paths if not path.name.endswith(tail)]
        held = [path for path in having if edges_beside(path, STEM + tail) is not None]
        if held and 2 * len(held) > len(having):
            return STEM + tail
    return ""


def edges_beside(path: Path, called: str) -> tuple[float, ...] | None:
    """Return the times in a recording's file of pulses, in seconds; ``None`` where it is none."""
    beside = path.parent / called.replace(STEM, stem_of(path))
    try:
        return tuple(read_edges(beside).tolist()) if beside.is_file() else None
    except PmmError:
        return None


def once_a_period(edges_s: Sequence[float], frequency_hz: float) -> bool:
    """Tell whether pulses come once in each period of a line."""
    if len(edges_s) < 3:
        return False
    return bool(abs(float(np.median(np.diff(edges_s))) * frequency_hz - 1.0) < SAME_TIME)


def _tails(path: Path) -> Iterator[str]:
    """Yield what the names of text files beside a recording have behind its stem."""
    stem = stem_of(path)
    for sibling in path.parent.glob(f"{_literal(stem)}?*"):
        tail = sibling.name[len(stem) :]
        if sibling != path and tail[0] not in ".0123456789" and tail.endswith(text_endings()):
            yield tail


def _literal(text: str) -> str:
    return "".join(f"[{character}]" if character in "*?[" else character for character in text)
