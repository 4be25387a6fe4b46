"""The quick stop's own way to the loop: two counters in memory that both processes share.

Nothing waits before it and nothing can hold it up: no queue, no lock, no pipe that is full of
pictures. Each counter has one writer and is one word, which the processor writes whole.
"""

import asyncio
from ctypes import c_uint64
from multiprocessing.sharedctypes import RawValue
from typing import Final

from hardware.description.errors import PmmError

PATIENCE_S: Final = 5.0  # for the loop's answer: 500 cycles
_LOOK_S: Final = 0.005  # between two looks at the answer: half a cycle


class NotStoppedError(PmmError):
    """The loop has not taken a quick stop: nobody knows what the rig does."""


class QuickStop:
    """Counts quick stops: the server presses, the loop looks first of all in each cycle.

    It is handed to the server's process when that is started.
    """

    def __init__(self) -> None:
        self._pressed = RawValue(c_uint64, 0)
        self._taken = RawValue(c_uint64, 0)

    @property
    def pressed(self) -> int:
        """How many quick stops there were since the start."""
        return int(self._pressed.value)

    def press(self) -> int:
        """Ask for a quick stop; return its number. Only the server's event loop does."""
        number = self.pressed + 1
        self._pressed.value = number
        return number

    def take(self) -> bool:
        """Whether one was asked for since the last look. Only the loop looks."""
        pressed = self.pressed
        is_new = pressed != self._taken.value
        self._taken.value = pressed
        return is_new

    async def wait_taken(self, number: int) -> None:
        """Wait until the loop has taken one.

        Raises
        ------
        NotStoppedError
            If it does not within 5 s.
        """
        loop = asyncio.get_running_loop()
        end_s = loop.time() + PATIENCE_S
        while self._taken.value < number:
            if loop.time() > end_s:
                raise NotStoppedError(
                    f"the control loop has not taken the quick stop within {PATIENCE_S:g} s; use "
                    "the wired emergency stop"
                )
            await asyncio.sleep(_LOOK_S)
