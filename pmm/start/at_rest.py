"""Which of the recordings are runs, and which show a rig at rest."""

from collections.abc import Sequence
from typing import Final

from pmm.start.behaviour import RecordingBehaviour

_STANDS: Final = 0.02  # of a run's amplitude: what moves no more in any column stands
_TIMELESS: Final = 0.2  # the same where nothing keeps time either


def at_rest(watched: Sequence[RecordingBehaviour]) -> list[bool]:
    """Tell of each recording whether it is one at rest.

    Judged by the columns that carry the line of the recording with the cleanest one: at rest none
    of them moves by more than a small part of its amplitude there.
    """
    timed = [one for one in watched if one.line is not None and not one.line.doubt]
    if not timed:
        return [False] * len(watched)
    cleanest = min(timed, key=lambda one: one.line.beside if one.line else 1.0)
    amplitudes = {
        name: abs(column.part.first)
        for name, column in cleanest.columns.items()
        if column.part.carried
    }
    return [_stands(one, amplitudes, in_time=one in timed) for one in watched]


def _stands(one: RecordingBehaviour, amplitudes: dict[str, float], *, in_time: bool) -> bool:
    moved = [
        one.columns[name].spread / amplitude
        for name, amplitude in amplitudes.items()
        if name in one.columns
    ]
    return bool(moved) and max(moved) < (_STANDS if in_time else _TIMELESS)
