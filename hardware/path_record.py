"""What two led struts record: master angle, displacements by their encoders, and commands."""

import math
from collections.abc import Sequence
from typing import Final

from hardware.description.arrays import FloatArray
from hardware.path_strut import PathStrut
from hardware.roles import Sample, SampleBlock, blocks

_KEPT_CYCLES: Final = 20  # for samples of a strut that come late


class PathRecord:
    """Samples of the SYNCs that both struts have told of.

    Parameters
    ----------
    encoders
        Whether the struts' displacements are among them.
    """

    def __init__(self, struts: Sequence[PathStrut], *, encoders: bool) -> None:
        self._struts, self._encoders = struts, encoders
        self._led: dict[int, tuple[float, ...]] = {}
        self._seen: tuple[dict[int, float], ...] = ({}, {})
        self._samples: list[Sample] = []

    def led(self, number: int, angle_rad: float, points_m: FloatArray) -> None:
        """Keep the master angle and the set-points of a SYNC to come."""
        self._led[number] = (angle_rad, *map(float, points_m))

    def angle_at(self, number: int) -> float:
        """Return the master angle at a SYNC of the latest; NaN at one that it knows nothing of."""
        return self._led[number][0] if number in self._led else math.nan

    def tick(self, now: int, angle_rad: float) -> None:
        """Make samples of what both struts have told of a SYNC.

        Parameters
        ----------
        now
            The SYNC.
        angle_rad
            The master angle, of SYNCs from before the struts were led.
        """
        for strut, seen in zip(self._struts, self._seen, strict=True):
            seen |= {n: counts / strut.settings.counts_per_unit for n, counts in strut.positions}
        aft, fore = self._seen
        for number in sorted(aft.keys() & fore.keys()):
            places = (aft.pop(number), fore.pop(number))
            angle, *points = self._led.get(number, (angle_rad, *places))
            own = places if self._encoders else ()
            self._samples.append((number, (angle, *own, *points)))
        for kept in (aft, fore, self._led):
            for number in [one for one in kept if one < now - _KEPT_CYCLES]:
                del kept[number]

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call."""
        taken, self._samples = self._samples, []
        return blocks(taken)
