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
from pmm.whole_file import write_whole

_SCHEMA: Final = "pmm-console-queue-1"


@dataclass(frozen=True)
class KeptPlan:
    """A plan of the queue, by its file and what was changed of it since.

    Attributes
    ----------
    changes
        In their order: edits, moves and holds of its runs.
    """

    number: int
    name: str
    changes: tuple[RunPosted, ...] = ()

    def record(self) -> dict[str, Any]:
        """Return the plan, and what was changed in it, as the journal keeps it."""
        changes = [{"action": _action(change), **change.model_dump()} for change in self.changes]
        return {"number": self.number, "plan": self.name, "changes": changes}


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

    def write(self, queue: KeptQueue) -> None:
        """Replace what is kept.

        Raises
        ------
        OSError
            If it cannot be written.
        """
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
            If the file is none of ours.
        """
        if not self.path.exists():
            return KeptQueue()
        try:
            content = json.loads(self.path.read_text(encoding="utf-8"))
            return _queue(content)
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ConfigurationError(
                f"{self.path}: not the queue of a console ({error}); queue the plans anew"
            ) from error


def _queue(content: dict[str, Any]) -> KeptQueue:
    if content["schema"] != _SCHEMA:
        raise ValueError(f"schema {content['schema']!r}")
    plans, proposals = map(_plan, content["plans"]), map(_proposal, content["proposals"])
    return KeptQueue(tuple(plans), tuple(proposals))


def _action(posted: RunPosted) -> str:
    return next(key for key, kind in PROPOSED.items() if type(posted) is kind)


def _plan(record: dict[str, Any]) -> KeptPlan:
    return KeptPlan(record["number"], record["plan"], tuple(map(_change, record["changes"])))


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
