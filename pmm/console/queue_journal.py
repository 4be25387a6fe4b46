"""The queue on the disk: what waits, what was changed of it and what is proposed.

The file is replaced whole with each change, so that after any end of the console it is that of
before a change or that of after it.
"""

import hashlib
import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from pmm.console.proposals import PROPOSED, ProposedChange
from pmm.console.requests import RunPosted
from pmm.console.security import Visitor, VisitorRole
from pmm.recorder.files import free_name
from pmm.whole_file import write_whole

_SCHEMA: Final = "pmm-console-queue-1"
# Whatever a file that is none of ours may lead to.
_UNREADABLE: Final = (
    OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError,
)  # fmt: skip


@dataclass(frozen=True)
class KeptPlan:
    """A plan of the queue, by its file and what was changed of it since.

    Attributes
    ----------
    sha256
        Of its file, as it was when it was queued.
    changes
        In their order: edits, moves and holds of its runs.
    """

    number: int
    name: str
    sha256: str
    changes: tuple[RunPosted, ...] = ()

    def record(self) -> dict[str, Any]:
        """Return the plan, and what was changed in it, as the journal keeps it."""
        changes = [{"action": _action(change), **change.model_dump()} for change in self.changes]
        named = {"number": self.number, "plan": self.name, "sha256": self.sha256}
        return {**named, "changes": changes}


@dataclass(frozen=True)
class KeptQueue:
    """A queue in its order, and what is proposed."""

    plans: tuple[KeptPlan, ...] = ()
    proposals: tuple[ProposedChange, ...] = ()


class QueueJournal:
    """Keeps the queue of one rig in a folder that several may share."""

    def __init__(self, folder: Path, rig: Path) -> None:
        self._rig = str(rig.resolve())
        digest = hashlib.sha256(self._rig.encode()).hexdigest()[:8]
        self.path = folder / f"queue-{digest}.json"
        self._unread = ""

    def write(self, queue: KeptQueue) -> None:
        """Replace what is kept.

        Raises
        ------
        OSError
            If it cannot be written, or what is there could be neither read nor moved away.
        """
        if self._unread:
            raise OSError(self._unread)
        content = {
            "schema": _SCHEMA,
            "rig": self._rig,
            "plans": [plan.record() for plan in queue.plans],
            "proposals": [proposal.record() for proposal in queue.proposals],
        }
        self.path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(self.path, json.dumps(content, ensure_ascii=False, indent=1) + "\n")

    def read(self) -> KeptQueue:
        """Return what is kept; nothing where there is no file.

        Raises
        ------
        ConfigurationError
            If the file is none of ours; it has another name then, so that none replaces it.
        """
        if not self.path.exists():
            return KeptQueue()
        try:
            content = json.loads(self.path.read_text(encoding="utf-8"))
            return _queue(content)
        except _UNREADABLE as error:
            raise ConfigurationError(
                f"{self.path}: not the queue of a console ({error}); {self._set_aside()}; queue "
                "the plans anew"
            ) from error

    def _set_aside(self) -> str:
        """Give the file another name; say which."""
        aside = free_name(self.path, "unread-")
        try:
            self.path.rename(aside)
        except OSError as error:
            self._unread = f"{self.path} cannot be read, and not be moved away either: {error}"
            return self._unread
        return f"it is kept as {aside.name}"


def _queue(content: dict[str, Any]) -> KeptQueue:
    if content["schema"] != _SCHEMA:
        raise ValueError(f"schema {content['schema']!r}")
    plans, proposals = map(_plan, content["plans"]), map(_proposal, content["proposals"])
    return KeptQueue(tuple(plans), tuple(proposals))


def _action(posted: RunPosted) -> str:
    return next(key for key, kind in PROPOSED.items() if type(posted) is kind)


def _plan(record: dict[str, Any]) -> KeptPlan:
    changes = tuple(map(_change, record["changes"]))
    return KeptPlan(record["number"], record["plan"], record["sha256"], changes)


def _change(record: dict[str, Any]) -> RunPosted:
    posted = _posted(record["action"], {k: v for k, v in record.items() if k != "action"})
    if not isinstance(posted, RunPosted):
        raise TypeError(f"{record['action']} is no change of a plan")
    return posted


def _proposal(record: dict[str, Any]) -> ProposedChange:
    posted = _posted(record["action"], record["posted"])
    visitor = Visitor(VisitorRole.PROPOSE, record["name"])
    return ProposedChange(
        record["number"], record["action"], posted, record["plan"], visitor, record["utc"]
    )


def _posted(action: str, content: dict[str, Any]) -> Any:
    return PROPOSED[action].model_validate(content)
