"""The texts that browsers get, each made once however many it goes to."""

from collections import deque
from dataclasses import dataclass

from pmm.console.encoding import encode, frame_picture, trace_picture
from pmm.console.messages import Frame, SignalTrace
from pmm.console.traces import POINTS


@dataclass(frozen=True)
class _Piece:
    points: int
    text: str


class Pictures:
    """Keeps the latest frame, and the traces of the last 20 s in pieces as they came.

    A browser that missed frames gets the latest one with all the pieces it lacks.

    Attributes
    ----------
    number
        Of the latest frame; 0 before the first.
    next_piece
        Number of the piece that will come next: a browser that has everything waits for it.
    """

    def __init__(self) -> None:
        self.number = self.next_piece = 0
        self._frame: Frame | None = None
        self._pieces: deque[_Piece] = deque()
        self._points = 0
        self._made: dict[int, str] = {}

    def take(self, frame: Frame) -> None:
        """Take the next frame; pictures of the frame before are dropped."""
        self.number, self._frame = frame.number, frame
        self._made.clear()
        self._keep(frame.trace)

    def frame(self, since: int) -> str:
        """Return the latest frame with the pieces from that number on."""
        made = self._made.get(since)
        if made is None and self._frame is not None:
            text = encode(frame_picture(self._frame))
            made = self._made[since] = f'{text[:-1]},"traces":{self.traces(since)}}}'
        return made or "null"

    def traces(self, since: int) -> str:
        """Return the pieces from that number on, or all that there are."""
        first = self.next_piece - len(self._pieces)
        texts = [piece.text for piece in self._pieces]
        return f"[{','.join(texts[max(since - first, 0) :])}]"

    def _keep(self, trace: SignalTrace) -> None:
        points = trace.values.shape[1] if trace.values.size else 0
        if not points:
            return
        self._pieces.append(_Piece(points, encode(trace_picture(trace))))
        self._points += points
        self.next_piece += 1
        while self._points - self._pieces[0].points >= POINTS:
            self._points -= self._pieces.popleft().points
