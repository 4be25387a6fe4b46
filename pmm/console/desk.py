"""Who has control: one session at a time; all others watch."""

from enum import StrEnum

from hardware.description.errors import PmmError


class Holder(StrEnum):
    """Who has control, seen from one session."""

    YOU = "you"
    OTHER = "other"
    NOBODY = "nobody"


class NotInControlError(PmmError):
    """A session that only watches wants to act."""


class Desk:
    """Gives control to one session.

    It stays there when that session's page is closed, until that session gives it back or another
    one takes it over: what a reload or a lost network interrupts is not given away.
    """

    def __init__(self) -> None:
        self._holder = ""

    @property
    def holder(self) -> str:
        """The session that has control; empty for none."""
        return self._holder

    def seen_from(self, session: str) -> Holder:
        """Return who has control, as a session sees it: itself, another, nobody."""
        if not self._holder:
            return Holder.NOBODY
        return Holder.YOU if session == self._holder else Holder.OTHER

    def arrive(self, session: str) -> None:
        """Let a session come; the first one gets control."""
        self._holder = self._holder or session

    def take_over(self, session: str) -> None:
        """Give control to a session, on its explicit wish."""
        self._holder = session

    def give_back(self, session: str) -> None:
        """Take control from a session that has done; raises as :meth:`require` does."""
        self.require(session)
        self._holder = ""

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
