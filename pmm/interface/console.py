"""The console from Python: what its page shows and does, without a browser."""

import json
import queue
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, suppress
from getpass import getuser
from pathlib import Path
from typing import Any, Final, Self

from websockets.exceptions import WebSocketException
from websockets.sync.client import ClientConnection

from hardware.description.errors import PmmError
from pmm.interface.arguments import checked
from pmm.interface.console_queue import QueueCalls
from pmm.interface.console_requests import ConsoleRefusalError, ConsoleRequests, Message
from pmm.interface.console_run import FollowedPlan, rests

_STREAM_S: Final = 60.0  # until the console answers: it may have just been started
_LISTS: Final = {
    "finished": ("finished", "entry"),
    "notice": ("notices", None),
    "audit": ("audit", "entry"),
}
_PARTS: Final = ("plans", "figures", "campaign", "live", "proposals")
_UNDER_WAY: Final = 3  # frames that may be of before a command's answer


@checked
def connect(
    url: str, token: str = "", *, name: str = "", certificate: str | Path | None = None
) -> "ConsoleClient":
    """Open a console from Python: watch, queue, approve, run, stop.

    Parameters
    ----------
    url
        As ``pmm console`` prints it.
    token
        Where the console asks for one.
    name
        For the log of who did what, where there is a token; by default that of the user.
    certificate
        The file of a certificate that the console signed itself.

    Raises
    ------
    ConfigurationError
        If no console answers there, or the token is wrong.
    ConsoleRefusalError
        If it takes no more.
    """
    return ConsoleClient(url, token, certificate, name)


class ConsoleClient(QueueCalls):
    """A console that is driven from Python; :func:`connect` opens it.

    It is one more browser to the console: the first that comes has control, another may take it,
    and closing gives it back.
    A thread of its own takes what the console tells, whatever the program does meanwhile.

    Raises
    ------
    ConsoleRefusalError
        By every call that the console refuses: no control, no such plan, a wrong state.
    """

    def __init__(
        self, url: str, token: str, certificate: str | Path | None, name: str = ""
    ) -> None:
        super().__init__(ConsoleRequests(url.rstrip("/"), certificate))
        self._url = self._requests.url
        self._known: dict[str, Any] = {}
        self._news, self._gone = threading.Condition(), ""
        self._listeners: list[queue.SimpleQueue[Message | None]] = []
        if token:
            self._requests.ask("/login", {"token": token, "name": name or getuser()})
        with ExitStack() as held:
            stream = held.enter_context(self._requests.stream(_STREAM_S))
            reader = threading.Thread(target=self._read, args=(stream,), name="console stream")
            held.callback(reader.join)
            held.callback(stream.close)
            reader.start()
            self.wait(lambda state: "session" in state, _STREAM_S)
            self._held = held.pop_all()

    def __enter__(self) -> Self:
        """Return the client; it is closed at the end."""
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Give control back and leave the console; the rig goes on with what it does."""
        with suppress(PmmError):  # a console that has gone has no control to take
            if self._has_control(self.known):
                self._post("/api/give-control", {})
        self._held.close()

    @property
    def known(self) -> Mapping[str, Any]:
        """All that the console has told, by the names of its messages (``docs/console-api.md``).

        They are ``hello``, ``frame``, ``finished``, ``notices``, ``plans``, ``figures``,
        ``campaign``, ``audit`` and ``desk``. What is returned does not change any more.
        """
        return self._known

    @property
    def frame(self) -> Message:
        """The latest tick: state, run, gate, periods, set-point, axes, bus, question."""
        frame: Message = self._known.get("frame") or {}
        return frame

    def command(self, name: str) -> str:
        """Command ``start``, ``next``, ``hold``, ``reset``, ``stop`` or ``quick stop``."""
        return self._post("/api/command", {"command": name})

    def answer(self, text: str) -> str:
        """Answer the question that the rig asks its operator."""
        question = self.frame.get("question", "")
        if not question:
            raise ConsoleRefusalError("nothing is asked")
        return self._post("/api/answer", {"question": question, "answer": text})

    def audit(self) -> list[Message]:
        """Return who did what with the present campaign, from its folder, the latest last."""
        entries: list[Message] = self._requests.ask("/api/audit")["audit"]
        return entries

    def take_control(self) -> str:
        """Take control from whoever has it."""
        said = self._post("/api/take-control", {"confirm": True})
        self.wait(self._has_control, _STREAM_S)
        return said

    def messages(self) -> Iterator[Message]:
        """Yield each message as it comes, until the console goes."""
        inbox: queue.SimpleQueue[Message | None] = queue.SimpleQueue()
        with self._news:
            self._listeners.append(inbox)
        try:
            while (message := inbox.get(timeout=_STREAM_S)) is not None:
                yield message
        finally:
            self._listeners.remove(inbox)

    def wait(self, until: Callable[[Mapping[str, Any]], bool], timeout_s: float) -> None:
        """Wait until what is :attr:`known` fulfils a condition.

        Raises
        ------
        ConsoleRefusalError
            If it does not within the time, or the console goes.
        """
        with self._news:
            if not self._news.wait_for(lambda: self._gone or until(self._known), timeout_s):
                raise ConsoleRefusalError(f"what was waited for did not come in {timeout_s:g} s")
        if self._gone:
            raise ConsoleRefusalError(
                f"{self._url}: the console has gone ({self._gone}); connect again"
            )

    def run(
        self,
        plan: str | Path,
        timeout_s: float,
        answers: Callable[[str], str] | None = None,
    ) -> list[Message]:
        """Queue a plan, wait for its turn and its end, and return its runs as they ended.

        Where the rig rests it is started; a plan that is under way ends first. Runs that the folder
        holds complete are not made again. After a stop a run may be missing that is still being
        written.

        Parameters
        ----------
        timeout_s
            By the clock, for all of it.
        answers
            Answers the rig's questions to its operator.

        Raises
        ------
        ConsoleRefusalError
            If it is refused or not done in time, if the rig asks and nobody answers, or if it ends
            in a fault or rests before the plan has begun.

        Whatever ends it early, Ctrl-C and an error of ``answers`` too, a plan that has not begun is
        taken out of the queue again; one that has begun is left as it is, but for the fault's own
        stop. The text says which, for the errors of others as a note.
        """
        before = self.known
        with ThreadPoolExecutor(1, "console queue") as beside:  # Ctrl-C does not lose its number
            queued = beside.submit(lambda: FollowedPlan(self.queue(plan), before))
            try:
                followed = queued.result()
                self._follow(followed, time.monotonic() + timeout_s, answers)
            except BaseException as error:
                if queued.exception() is not None:
                    raise
                said = self._without(queued.result())
                if isinstance(error, ConsoleRefusalError):
                    raise ConsoleRefusalError(f"{error}; {said}") from None
                error.add_note(said)
                raise
        return followed.runs(self.known)

    def _follow(
        self, plan: FollowedPlan, end_s: float, answers: Callable[[str], str] | None
    ) -> None:
        """Start a queued plan where the rig rests, and wait until it has ended."""
        self._wait_until(plan.told, end_s)
        start_number = self.frame["n"]
        if rests(self.known):
            self.command("start")
            start_number = self.frame["n"] + _UNDER_WAY

        def ended(state: Mapping[str, Any]) -> bool:
            broken = state["frame"]["n"] >= start_number and rests(state)
            return plan.over(state) or broken or bool(state["frame"]["question"])

        self._wait_until(ended, end_s)
        while question := self.frame["question"]:
            if answers is None:
                raise ConsoleRefusalError(f"the rig asks {question!r}; give answers")
            self.answer(answers(question))
            self.wait(lambda state, asked=question: state["frame"]["question"] != asked, _STREAM_S)  # type: ignore[misc]
            self._wait_until(ended, end_s)
        if self.frame["state"] == "fault":
            raise ConsoleRefusalError("the rig is in a fault: " + self.known["notices"][-1]["text"])
        if not (plan.over(self.known) or plan.begun(self.known)):
            raise ConsoleRefusalError(f"the rig was stopped before {plan.name} had begun")

    def _without(self, plan: FollowedPlan) -> str:
        """Take a plan that has not begun out of the queue; return what became of it."""
        frame_number = self.frame["n"] + _UNDER_WAY
        with suppress(ConsoleRefusalError):  # what was commanded last shows by then
            self.wait(lambda state: state["frame"]["n"] >= frame_number, _STREAM_S)
        if plan.begun(self.known):
            return plan.left_behind(self.known)
        try:
            self.drop(plan.number)
        except PmmError as error:
            return f"{plan.name} may still be in the queue: {error}"
        return f"{plan.name} is taken out of the queue"

    def _wait_until(self, until: Callable[[Mapping[str, Any]], bool], end_s: float) -> None:
        self.wait(until, round(max(0.0, end_s - time.monotonic()), 1))

    @staticmethod
    def _has_control(state: Mapping[str, Any]) -> bool:
        return bool(state["desk"]["holder"] == "you")

    def _read(self, stream: ClientConnection) -> None:
        try:
            for text in stream:
                message = json.loads(text)
                with self._news:
                    self._known = self._with(message)
                    self._news.notify_all()
                    for listener in self._listeners:
                        listener.put(message)
            self._gone = "it has closed the stream"
        except (WebSocketException, ValueError) as error:
            self._gone = str(error)
        with self._news:
            self._news.notify_all()
            for listener in self._listeners:
                listener.put(None)

    def _with(self, message: Message) -> dict[str, Any]:
        kind, state = message["type"], self._known
        if kind == "snapshot":
            self._requests.session = message["session"]
            return message
        if kind in _LISTS:
            name, part = _LISTS[kind]
            return {**state, name: [*state[name], message if part is None else message[part]]}
        return {**state, kind: message[kind] if kind in _PARTS else message}
