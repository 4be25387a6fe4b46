"""The console's queue from Python: plans and their runs, before they are made."""

from getpass import getuser
from pathlib import Path

from pmm.interface.console_requests import ConsoleRequests, Message


class QueueCalls:
    """What a client asks of the queue.

    Raises
    ------
    ConsoleRefusalError
        By every call that the console refuses.
    """

    def __init__(self, requests: ConsoleRequests) -> None:
        self._requests = requests

    def plans(self) -> list[str]:
        """Return the names of the plans that the console offers."""
        names: list[str] = self._requests.ask("/api/plans")["names"]
        return names

    def check(self, plan: str | Path) -> Message:
        """Return a plan's runs and what the checks find; nothing is changed.

        Parameters
        ----------
        plan
            One of :meth:`plans`; the text of one; or the ``Path`` of a file here.
        """
        plan_entry: Message = self._requests.ask("/api/plans/check", _plan(plan))["plan"]
        return plan_entry

    def queue(self, plan: str | Path) -> Message:
        """Queue a plan, and return it as :meth:`check` does; at rest nothing moves before a start.

        Its ``number`` is there where it was not only proposed.
        """
        answer = self._requests.ask("/api/plans/queue", _plan(plan))
        number = {"number": answer["number"]} if "number" in answer else {}
        return {**answer["plan"], **number}

    def drop(self, number: int) -> str:
        """Take a plan out of the queue by its number, a key of ``known["plans"]``."""
        return self._post("/api/plans/drop", {"number": number})

    def edit(self, number: int, run: str, **settings: float) -> Message:
        """Change settings of a planned run; the plan is returned as :meth:`check` does.

        Parameters
        ----------
        number
            Of its plan, a key of ``known["plans"]``.
        settings
            ``frequency_hz``, ``eccentricity_m`` (amplitude of each strut), ``strut_phase_rad``,
            ``carriage_speed_m_s``, ``drift_rad``, ``periods``; what is not given stays.
        """
        body = {"number": number, "run": run, **settings}
        plan_entry: Message = self._requests.ask("/api/plans/edit", body)["plan"]
        return plan_entry

    def move(self, number: int, by: int, run: str = "") -> str:
        """Move a planned run, or a plan that waits, by so many places; earlier if negative."""
        return self._post("/api/plans/move", {"number": number, "run": run, "by": by})

    def hold(self, number: int, run: str = "") -> str:
        """Pass a planned run, or all of a plan, over until it is released."""
        return self._post("/api/plans/hold", {"number": number, "run": run, "held": True})

    def note(self, number: int, text: str, run: str = "", author: str = "") -> str:
        """Keep a line on a run, or on the campaign, in its folder: the archive and reports show it.

        Parameters
        ----------
        number
            Of the plan, a key of ``known["plans"]``.
        author
            Whose it is; by default the name under which the program runs.
        """
        body = {"number": number, "run": run, "text": text, "author": author or getuser()}
        return self._post("/api/plans/note", body)

    def release(self, number: int, run: str = "") -> str:
        """Release what is held; at rest nothing moves before a start."""
        return self._post("/api/plans/hold", {"number": number, "run": run, "held": False})

    def approve(self, number: int) -> str:
        """Carry out what somebody has proposed, one of ``known["proposals"]`` by its number."""
        return self._post("/api/proposals/approve", {"number": number})

    def refuse(self, number: int) -> str:
        """Do not carry out what somebody has proposed; whoever has proposed it withdraws it so."""
        return self._post("/api/proposals/refuse", {"number": number})

    def _post(self, path: str, body: Message) -> str:
        return str(self._requests.ask(path, body)["said"])


def _plan(plan: str | Path) -> dict[str, str]:
    if isinstance(plan, Path):
        return {"text": plan.read_text(encoding="utf-8")}
    return {"text": plan} if "\n" in plan else {"name": plan}
