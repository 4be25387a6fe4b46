"""Demands on the operator, asked one by one while the loop goes on."""

from collections import deque
from collections.abc import Callable, Iterator

from hardware.demand import Demand
from hardware.driver import Prompt

Answered = Callable[[Demand, str], None]


class Questions:
    """Asks demands one by one, once a cycle, so that the loop never waits for a person."""

    def __init__(self, prompt: Prompt, answered: Answered) -> None:
        self._prompt, self._answered = prompt, answered
        self._asked: deque[Iterator[Demand]] = deque()
        self._open: Demand | None = None

    @property
    def present(self) -> str:
        """The question that waits for its answer; empty without one."""
        return "" if self._open is None else str(self._open)

    def ask(self, demands: Iterator[Demand]) -> None:
        """Add demands on the operator, to be asked in turn.

        What comes after a demand in the iterator happens when that is answered, and else never.
        """
        self._asked.append(demands)
        self._go_on()

    def withdraw(self) -> None:
        """Drop all demands that are not answered yet: what they ask for has not been done."""
        self._asked.clear()
        self._open = None

    def ask_on(self) -> bool:
        """Ask on; tell whether everything is answered."""
        while self._open is not None:
            answer = self._prompt(self._open)
            if answer is None:
                return False
            answered, self._open = self._open, None
            self._answered(answered, answer)
            self._go_on()
        return True

    def _go_on(self) -> None:
        """Take the next demand, if none is open."""
        while self._open is None and self._asked:
            self._open = next(self._asked[0], None)
            if self._open is None:
                self._asked.popleft()
