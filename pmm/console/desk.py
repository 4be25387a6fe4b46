"""Who has control: one session at a time; all others watch."""

from enum import StrEnum

from pmm.console.request_body import Requester
from pmm.console.security import NotInControlError


class Holder(StrEnum):
    """Who has control, seen from one session."""

    YOU = "you"
    OTHER = "other"
    NOBODY = "nobody"


class Desk:
    """Gives control to one session.

    It stays there when that session's page is closed, until that session gives it back, another
    one takes it over, or it lapses: what a reload or a lost network interrupts is not given away.

    Attributes
    ----------
    holder
        Who has control; ``None`` for nobody.
    """

    def __init__(self) -> None:
        self.holder: Requester | None = None

    def seen_from(self, session: str) -> Holder:
        """Return who has control, as a session sees it: itself, another, nobody."""
        if self.holder is None:
            return Holder.NOBODY
        return Holder.YOU if session == self.holder.session else Holder.OTHER

    def arrive(self, who: Requester) -> None:
        """Let a session come; the first one gets control."""
        self.holder = self.holder or who

    def take_over(self, who: Requester) -> None:
        """Give control to a session, on its explicit wish."""
        self.holder = who

    def give_back(self, session: str) -> None:
        """Take control from a session that has done; raises as :meth:`require` does."""
        self.require(session)
        self.holder = None

    def require(self, session: str) -> None:
        """Refuse a session that only watches.

        Raises
        ------
        NotInControlError
            If it has no control.
        """
        if self.seen_from(session) is not Holder.YOU:
            raise NotInControlError(
                "this browser only watches; take control first (quick stop is always possible)"
            )
