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
            settings = posted.model_dump(exclude={"number", "run"}, exclude_none=True)
            return f"edit {about}: " + ", ".join(
                f"{key} {value:g}" for key, value in settings.items()
            )
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
        proposal = ProposedChange(self.count, action, posted, plan, visitor, utc)
        self.waiting[proposal.number] = proposal
        return proposal

    def take(self, number: int) -> ProposedChange:
        """Take one out that is decided on.

        Raises
        ------
        ConfigurationError
            If there is none of that number.
        """
        proposal = self.waiting.pop(number, None)
        if proposal is None:
            numbers = ", ".join(map(str, self.waiting)) or "none"
            raise ConfigurationError(f"no proposal {number} waits; there are: {numbers}")
        return proposal

    def restore(self, proposals: Iterable[ProposedChange], numbers: Mapping[int, int]) -> None:
        """Take in those of a console before.

        Parameters
        ----------
        numbers
            Of the plans now, by those of before; what is about a plan that is gone is left out.
        """
        for proposal in proposals:
            number = numbers.get(getattr(proposal.posted, "number", 0), 0)
            if number:
                posted = proposal.posted.model_copy(update={"number": number})
                self.waiting[proposal.number] = replace(proposal, posted=posted)
            elif isinstance(proposal.posted, PlanPosted):
                self.waiting[proposal.number] = proposal
        self.count = max((self.count, *self.waiting))

    def pictures(self) -> list[dict[str, Any]]:
        """Return what the page shows of the proposals that wait, the oldest first."""
        return [proposal.picture() for proposal in self.waiting.values()]
