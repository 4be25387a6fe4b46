"""What those who may not command would change of the queue; whoever has control decides."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from pmm.console.limits import MOST_PROPOSALS
from pmm.console.requests import (
    DropPosted,
    EditPosted,
    HoldPosted,
    MovePosted,
    PlanPosted,
    Posted,
    RunPosted,
)
from pmm.console.security import Visitor

PROPOSED: Final[dict[str, type[Posted]]] = {
    "queue": PlanPosted,
    "drop": DropPosted,
    "edit": EditPosted,
    "move": MovePosted,
    "hold": HoldPosted,
}


@dataclass(frozen=True)
class ProposedChange:
    """A change of the queue that waits for whoever has control.

    Attributes
    ----------
    action
        A key of :data:`PROPOSED`.
    plan
        Name of the plan that it is about.
    utc
        When it was made.
    """

    number: int
    action: str
    posted: Posted
    plan: str
    visitor: Visitor
    utc: str

    @property
    def text(self) -> str:
        """What is to be done, in words."""
        posted, plan = self.posted, self.plan
        about = f"{posted.run} of {plan}" if isinstance(posted, RunPosted) and posted.run else plan
        if isinstance(posted, EditPosted):
            given = posted.model_dump(exclude={"number", "run"}, exclude_none=True)
            return f"edit {about}: " + ", ".join(f"{key} {one:g}" for key, one in given.items())
        if isinstance(posted, MovePosted):
            return f"move {about} by {posted.by:+d}"
        if isinstance(posted, HoldPosted):
            return f"{'hold' if posted.held else 'release'} {about}"
        return f"{'take out' if isinstance(posted, DropPosted) else self.action} {about}"

    def picture(self) -> dict[str, Any]:
        """Return what the page shows of the proposal."""
        named = {"number": self.number, "name": self.visitor.name, "utc": self.utc}
        return {**named, "action": self.action, "text": self.text}

    def record(self) -> dict[str, Any]:
        """Return the proposal as the journal of the queue keeps it."""
        return {**self.picture(), "plan": self.plan, "posted": self.posted.model_dump()}


@dataclass
class Proposals:
    """Those that wait, by their numbers, which are never used twice."""

    waiting: dict[int, ProposedChange] = field(default_factory=dict)
    count: int = 0

    def require_room(self) -> None:
        """Refuse more than may wait.

        Raises
        ------
        ConfigurationError
            If there are that many.
        """
        if len(self.waiting) >= MOST_PROPOSALS:
            raise ConfigurationError(
                f"{MOST_PROPOSALS} proposals wait already, which is the limit; withdraw one, or "
                "wait until whoever has control has decided"
            )

    def add(
        self, action: str, posted: Posted, plan: str, visitor: Visitor, utc: str
    ) -> ProposedChange:
        """Keep one more change that waits for approval; raises if there is no room."""
        self.require_room()
        self.count += 1
        found = ProposedChange(self.count, action, posted, plan, visitor, utc)
        self.waiting[found.number] = found
        return found

    def take(self, number: int) -> ProposedChange:
        """Take one out that is decided on.

        Raises
        ------
        ConfigurationError
            If there is none of that number.
        """
        found = self.waiting.pop(number, None)
        if found is None:
            known = ", ".join(map(str, self.waiting)) or "none"
            raise ConfigurationError(f"no proposal {number} waits; there are: {known}")
        return found

    def restore(self, proposals: Iterable[ProposedChange], numbers: Mapping[int, int]) -> None:
        """Take in those of a console before.

        Parameters
        ----------
        numbers
            Of the plans now, by those of before; what is about a plan that is gone is left out.
        """
        for one in proposals:
            number = numbers.get(getattr(one.posted, "number", 0), 0)
            if number:
                posted = one.posted.model_copy(update={"number": number})
                self.waiting[one.number] = replace(one, posted=posted)
            elif isinstance(one.posted, PlanPosted):
                self.waiting[one.number] = one
        self.count = max((self.count, *self.waiting))

    def pictures(self) -> list[dict[str, Any]]:
        """Return what the page shows of the proposals that wait, the oldest first."""
        return [one.picture() for one in self.waiting.values()]
