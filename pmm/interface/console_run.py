"""A plan that a program has queued, from there to its end, by what the console tells."""

from collections.abc import Mapping
from typing import Any, Final

from pmm.interface.console_requests import ConsoleRefusalError, Message

_RESTING: Final = ("idle", "stopped", "fault")  # nothing goes on by itself


class FollowedPlan:
    """Tells from :attr:`ConsoleClient.known` where a queued plan stands.

    Parameters
    ----------
    entry
        As :meth:`QueueCalls.queue` returns it.
    before
        What was known before it was queued.

    Raises
    ------
    ConsoleRefusalError
        If the plan is only proposed.
    """

    def __init__(self, entry: Message, before: Mapping[str, Any]) -> None:
        self.name: str = entry["name"]
        if "number" not in entry:
            raise ConsoleRefusalError(f"{self.name} is proposed; whoever has control decides on it")
        self.number: int = entry["number"]
        self._folder, self._chooses = entry["folder"], entry["chooses"]
        self._finished = len(before["finished"])
        self._notice = max((notice["id"] for notice in before["notices"]), default=0)

    def runs(self, state: Mapping[str, Any]) -> list[Message]:
        """Return the runs of its folder that have ended since it was queued."""
        finished = state["finished"][self._finished :]
        return [entry for entry in finished if entry["folder"] == self._folder]

    def told(self, state: Mapping[str, Any]) -> bool:
        """Whether the console tells of it by now."""
        return self._at_hand(state) and str(self.number) in state["plans"]

    def begun(self, state: Mapping[str, Any]) -> bool:
        """Whether it has had its turn."""
        moved = state["frame"]["state"] != "idle" or bool(self.runs(state))
        return bool(state["frame"]["plan"] == self.number and moved)

    def left_behind(self, state: Mapping[str, Any]) -> str:
        """Return what becomes of it, once it has begun, when nobody follows it any more."""
        if rests(state) or self.over(state):
            return f"{self.name} has begun and is left as it is"
        return (
            f"{self.name} has begun and goes on; command('stop') of a client that has control "
            "stops it, as Stop on the console's page does"
        )

    def over(self, state: Mapping[str, Any]) -> bool:
        """Whether it has ended by itself, or is in the queue no more."""
        if not self._at_hand(state):
            return True
        if self._chooses:  # how many runs there will be is not known
            return any(
                notice["id"] > self._notice
                and notice["kind"] != "queue"
                and notice["text"].startswith(f"{self.name}: ")
                for notice in state["notices"]
            )
        frame = state["frame"]
        is_last = frame["state"] == "done" and frame["plan"] == self.number and not frame["next"]
        return is_last and any(entry["run"] == frame["run"] for entry in self.runs(state))

    def _at_hand(self, state: Mapping[str, Any]) -> bool:
        return self.number in (state["frame"]["plan"], *state["frame"]["queue"])


def rests(state: Mapping[str, Any]) -> bool:
    """Whether nothing goes on before a command; a campaign that chooses its runs asks instead."""
    frame = state["frame"]
    plan = state["plans"].get(str(frame["plan"]))
    is_choosing = frame["state"] == "idle" and plan is not None and plan["chooses"]
    return frame["state"] in _RESTING and not is_choosing
