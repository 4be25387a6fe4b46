"""The drift of a device's clock against the bus: a line through marks of both."""

from collections import deque
from typing import Final

import numpy as np

_MARKS: Final = 240
_ENOUGH: Final = 3


class ClockFit:
    """Turns a device's time into the rig's.

    A mark arrives late by the transmission and by up to one cycle, never early. So the slope comes
    from all recent marks by least squares, and the line is then lowered onto the least delayed one.
    Until there are enough marks the clocks are taken to run equally fast.
    """

    def __init__(self) -> None:
        self._device: deque[float] = deque(maxlen=_MARKS)
        self._rig: deque[float] = deque(maxlen=_MARKS)
        self._slope = 1.0
        self._offset_s = 0.0

    @property
    def drift(self) -> float:
        """How much faster the rig's clock runs: 1e-6 is one microsecond a second."""
        return self._slope - 1.0

    @property
    def marks(self) -> list[tuple[float, float]]:
        """The marks that count now: the device's time and the rig's time when it had arrived."""
        return list(zip(self._device, self._rig, strict=True))

    def add(self, device_s: float, arrived_s: float) -> None:
        """Take a mark: the device's time in it, and the rig's time when it had arrived."""
        self._device.append(device_s)
        self._rig.append(arrived_s)
        device, rig = np.array(self._device), np.array(self._rig)
        if len(device) >= _ENOUGH and device[-1] > device[0]:
            off = device - device.mean()
            self._slope = float(off @ (rig - rig.mean()) / (off @ off))
        self._offset_s = float(np.min(rig - self._slope * device))

    def rig_time_s(self, device_s: float) -> float:
        """Return the rig's time for a time of the device."""
        return self._slope * device_s + self._offset_s
