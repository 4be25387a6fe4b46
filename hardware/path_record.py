"""What two led struts record: master angle, displacements by their encoders, and commands.

What the struts are led to goes through a port that loops back, so that the raw log has it as it has
the lines of every serial device, and a replay reads it there.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from hardware.description.arrays import FloatArray
from hardware.path_strut import PathStrut
from hardware.roles import Sample, SampleBlock, blocks
from hardware.serial_port import Port

_KEPT_CYCLES: Final = 20  # for samples of a strut that come late
Led = tuple[float, ...]  # master angle and set-points


class PathRecord:
    """Samples of the SYNCs that both struts have told of.

    Parameters
    ----------
    port
        Says again what is written to it.
    encoders
        Whether the struts' displacements are among them.
    """

    def __init__(self, struts: Sequence[PathStrut], port: Port, *, encoders: bool) -> None:
        self._struts, self._port, self._encoders = struts, port, encoders
        self._written: Led = ()
        self._led: dict[int, Led] = {}  # by the SYNC from which on it holds
        self._seen: tuple[dict[int, float], ...] = ({}, {})
        self._samples: list[Sample] = []

    def led(self, number: int, angle_rad: float, points_m: FloatArray) -> None:
        """Write down the master angle and the set-points of a SYNC to come, where they are new."""
        row = (float(angle_rad), *map(float, points_m))
        if row != self._written:
            self._written = row
            self._port.write(" ".join(map(repr, (number, *row))).encode() + b"\n")

    def angle_at(self, number: int) -> float:
        """Return the master angle at a SYNC of the latest; NaN at one that it knows nothing of."""
        led = self._at(number)
        return math.nan if led is None else led[0]

    def tick(self, now: int, angle_rad: float) -> None:
        """Make samples of what both struts have told of a SYNC.

        Parameters
        ----------
        now
            The SYNC.
        angle_rad
            The master angle, of SYNCs from before the struts were led.
        """
        for line in self._port.lines():
            at, *numbers = line.split()
            self._led[int(at)] = tuple(map(float, numbers))
        for strut, strut_positions in zip(self._struts, self._seen, strict=True):
            strut_positions |= {
                n: counts / strut.settings.counts_per_unit for n, counts in strut.positions
            }
        aft, fore = self._seen
        for number in sorted(aft.keys() & fore.keys()):
            places = (aft.pop(number), fore.pop(number))
            angle, *points = self._at(number) or (angle_rad, *places)
            measured = places if self._encoders else ()
            self._samples.append((number, (angle, *measured, *points)))
        for positions in (aft, fore):
            for number in [number for number in positions if number < now - _KEPT_CYCLES]:
                del positions[number]
        old = sorted(number for number in self._led if number < now - _KEPT_CYCLES)
        for number in old[:-1]:  # the last one may hold still
            del self._led[number]

    def take(self) -> tuple[SampleBlock, ...]:
        """Return the samples since the last call."""
        taken, self._samples = self._samples, []
        return blocks(taken)

    def carried(self) -> dict[str, Any]:
        """Return what holds now and at the SYNCs to come; see :mod:`hardware.carry_over`."""
        return {"led": [[number, *row] for number, row in self._led.items()]}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Go on from there."""
        self._led = {int(number): tuple(row) for number, *row in carried["led"]}

    def close(self) -> None:
        """Close the port."""
        self._port.close()

    def _at(self, number: int) -> Led | None:
        """Return what holds at a SYNC; ``None`` before the struts were led."""
        since = [sync for sync in self._led if sync <= number]
        return self._led[max(since)] if since else None
