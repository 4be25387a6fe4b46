"""Who writes into a campaign's folder: one process at a time, the others are told which."""

import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from hardware.ownership import PATIENCE_S, Owner, Ownership, own_together, owner_of

LOCK: Final = ".pmm-lock"
_HEADERS: Final = "*/header.json"  # of the runs, tries that were moved aside among them


@dataclass
class CampaignOwnership(Ownership):
    """The right to write into a campaign, and the numbers of its runs."""

    _last: int | None = None
    _counting: threading.Lock = field(default_factory=threading.Lock, repr=False)

    def count(self) -> int:
        """Return the last number that a run has; read from the folder the first time."""
        with self._counting:
            return self._counted()

    def next_number(self) -> int:
        """Return a run's number: one more than any run of the folder has, whatever clocks say."""
        with self._counting:
            self._last = self._counted() + 1
            return self._last

    def _counted(self) -> int:
        if self._last is None:
            numbers = list(_numbers(self.path.parent))
            # Runs of before had none: they count as if numbered in their order.
            self._last = max([len(numbers), *numbers])
        return self._last


def own_campaign(folder: Path, *, patience_s: float = PATIENCE_S) -> CampaignOwnership:
    """Own a campaign's folder, which is made if it is not there, to write into it.

    Parts of one process own it together: its loop, its recorder, its writer of the campaign file.

    Raises
    ------
    OwnedElsewhereError
        If another process is writing into it; the message names it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    message = f"{folder}: is being written"
    return own_together(folder / LOCK, message, CampaignOwnership, patience_s=patience_s)


@contextmanager
def own_new_campaign(folder: Path) -> Iterator[CampaignOwnership]:
    """Own a campaign's folder as :func:`own_campaign` does; where nothing comes into it, undo it.

    Folders that were made for it are removed if the block fails before it has written anything.
    """
    made = [path for path in (folder, *folder.parents) if not path.exists()]
    try:
        with own_campaign(folder) as ownership:
            yield ownership
    except BaseException:
        if made and [path.name for path in folder.iterdir()] == [LOCK]:
            (folder / LOCK).unlink()
            for path in made:
                path.rmdir()
        raise


def writer_of(folder: Path) -> Owner | None:
    """Return the other process that is writing into a campaign's folder, if there is one."""
    return owner_of(folder / LOCK)


def _numbers(folder: Path) -> Iterator[int]:
    """Yield the number of each run, 0 for one without."""
    for path in folder.glob(_HEADERS):
        try:
            number = json.loads(path.read_text(encoding="utf-8")).get("number", 0)
        except (OSError, ValueError, AttributeError):
            number = 0
        yield number if isinstance(number, int) else 0
