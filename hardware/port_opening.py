"""A port that is being opened while the loop goes on: to connect to a server may take seconds."""

import threading
from collections.abc import Callable
from typing import Final, Generic, TypeVar

T = TypeVar("T")
_PATIENCE_S: Final = 0.02
"""So long the first look waits: a local port is open by then. Two cycles of 100 Hz, a fifteenth of
the heartbeat that drives wait for; half misses slow adapters, twice costs struts a set-point."""


class PortOpening(Generic[T]):
    """Opens in a thread of its own, which ends with the program.

    Parameters
    ----------
    opened
        Opens, and returns what is open.
    let_go
        Closes what is open, where nobody wants it any more.
    """

    def __init__(self, opened: Callable[[], T], let_go: Callable[[T], None]) -> None:
        self._opened, self._let_go = opened, let_go
        self._lock = threading.Lock()
        self._abandoned = False
        self._result: list[T] = []
        self._error: Exception | None = None
        self._patience_s = _PATIENCE_S
        self._thread = threading.Thread(target=self._open, name="opens a port", daemon=True)
        self._thread.start()

    def is_over(self) -> bool:
        """Whether it is open, or cannot be opened."""
        self._thread.join(self._patience_s)
        self._patience_s = 0.0
        return not self._thread.is_alive()

    def result(self) -> T:
        """Return what is open, once it is over; raises what opening raised."""
        if self._error is not None:
            raise self._error
        return self._result.pop()

    def abandon(self) -> None:
        """Want it no more: what is open, or will be, is closed."""
        with self._lock:
            self._abandoned = True
            while self._result:
                self._let_go(self._result.pop())

    def _open(self) -> None:
        try:
            opened = self._opened()
        except Exception as error:  # raised again by who asks for the result
            self._error = error
            return
        with self._lock:
            if self._abandoned:
                self._let_go(opened)
            else:
                self._result.append(opened)
