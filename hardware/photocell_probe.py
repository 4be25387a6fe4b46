"""The photocell on the shaft drive's touch probe: latched position and edge counter, no clock."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, has
from hardware.driver import Driver, Services
from hardware.errors import PhotocellDeadError, PhotocellExtraError, PhotocellMissedError
from hardware.lines import Unwrapped
from hardware.roles import Cycle, Pulse, Role
from hardware.shaft import DriveShaft

_FUNCTION, _SOURCE = Entry(0x60B8), Entry(0x60D0, 1)
# Touch probe 1 on, every event, input of touch probe 1, positive edge. A drive looks at 60D0 only
# with bits 3 and 2 of the function at 10.
ARMED: Final = 0x0013
SOURCE_BY_60D0: Final = 0x0008
_INPUT_1: Final = 1
_MISSED_TURNS, _DEAD_TURNS, _EXTRA_TURNS = 1.5, 3.5, 0.5


@dataclass(frozen=True)
class ProbeSettings:
    """Settings of a photocell on the touch probe.

    Attributes
    ----------
    source
        As in object 60D0: 1 to 4 the drive's touch probe inputs, other numbers as its manual says.
        At 1 the object is left alone, because not every drive has it.
    """

    source: int = _INPUT_1


class ProbePhotocell:
    """A :class:`hardware.roles.Photocell` that knows the shaft's position at each pulse."""

    def __init__(self, name: str, settings: ProbeSettings, services: Services) -> None:
        if not isinstance(services.shaft, DriveShaft) or not services.shaft.settings.touch_probe:
            raise ConfigurationError(
                f"{name}: a touch probe needs a shaft on a CiA 402 drive with touch_probe = true"
            )
        self.name = name
        self._shaft = services.shaft
        self._settings = settings
        self._period_s = 1.0 / services.sample_rate_hz
        self._edges: int | None = None
        self._count = Unwrapped(2**16)
        self._pulse: int | None = None  # where the last pulse of this motion was
        self._since: int | None = None  # from where turns without a pulse are counted
        self._told: type | None = None
        self._pulses: list[Pulse] = []

    def prepare(self) -> None:
        """Arm the probe; a drive takes a new function only after a zero.

        Raises
        ------
        ConfigurationError
            If a source is asked for that the drive cannot be told.
        """
        node = self._shaft.drive.node
        node.sdo.write(_FUNCTION, 0)
        if self._settings.source == _INPUT_1:
            node.sdo.write(_FUNCTION, ARMED)
            return
        if not has(node.dictionary, _SOURCE):
            raise ConfigurationError(
                f"{self.name}.source = {self._settings.source}: the drive's EDS has no object "
                f"{_SOURCE} to choose a source by; leave source out and use touch probe input 1"
            )
        node.sdo.write(_SOURCE, self._settings.source)
        node.sdo.write(_FUNCTION, ARMED | SOURCE_BY_60D0)

    def expect(self, frequency_hz: float | None) -> None:
        """Begin to count turns anew; the shaft's own position says how far it turned."""
        if frequency_hz is None:
            self._begin_anew()

    def tick(self, cycle: Cycle) -> None:
        """Take the edges of the cycle.

        Raises
        ------
        PhotocellMissedError
            If the shaft has turned one and a half times without a pulse.
        PhotocellDeadError
            If it has turned three and a half times.
        PhotocellExtraError
            If a pulse comes before half a turn.
        """
        for number, (latched, edges, _status) in self._shaft.drive.node.streams[2].samples:
            self._look(number, int(latched), int(edges))

    def take(self) -> tuple[Pulse, ...]:
        """Return the pulses since the last call."""
        taken, self._pulses = tuple(self._pulses), []
        return taken

    def carried(self) -> dict[str, Any]:
        """Return the edges so far, where the last was, and since where turns are counted."""
        return {"edges": self._edges, "last": self._pulse, "since": self._since}

    def carry_on(self, carried: Mapping[str, Any]) -> None:
        """Count on from there."""
        self._edges = self._count.value = carried["edges"]
        self._pulse = carried["last"]
        self._since = carried.get("since", self._pulse)

    def reset_fault(self) -> None:
        """Count turns from here."""
        self._begin_anew()

    def close(self) -> None:
        """Nothing to let go of: the bus is the master's."""

    def _look(self, number: int, latched: int, edges: int) -> None:
        before, self._edges = self._edges, self._count.take(edges)
        if self._since is None:
            self._since = self._shaft.counts
        if before is None or before == self._edges:
            self._missing_faults(self._since)
            return
        at, last = self._shaft.position_near(latched), self._pulse
        self._pulse = self._since = at
        angle = 2.0 * math.pi * at / self._shaft.settings.counts_per_turn
        self._pulses.append(Pulse(self._edges, self._time_s(number, at), angle))
        missed, self._told = self._told, None
        # The shaft may have stood anywhere: the first pulse of a motion has no neighbour.
        if last is not None:
            self._compare(self._turns(at - last), self._edges - before, is_told=missed is not None)

    def _begin_anew(self) -> None:
        self._pulse = self._since = self._told = None

    def _turns(self, counts: int) -> float:
        return abs(counts / self._shaft.settings.counts_per_turn)

    def _missing_faults(self, since: int) -> None:
        turns = self._turns(self._shaft.counts - since)
        if turns > _DEAD_TURNS and self._told is not PhotocellDeadError:
            self._told = PhotocellDeadError
            raise PhotocellDeadError(
                self.name, f"no pulse for {turns:.2f} turns (limit {_DEAD_TURNS}); check the lamp"
            )
        if turns > _MISSED_TURNS and self._told is None:
            self._told = PhotocellMissedError
            raise PhotocellMissedError(
                self.name, f"no pulse for {turns:.2f} turns (limit {_MISSED_TURNS})"
            )

    def _compare(self, turns: float, edges: int, *, is_told: bool) -> None:
        if edges > 1 or turns < _EXTRA_TURNS:
            raise PhotocellExtraError(
                self.name, f"{edges} pulses within {turns:.3f} turns (one in about 1 expected)"
            )
        if turns > _MISSED_TURNS and not is_told:
            raise PhotocellMissedError(
                self.name, f"{turns:.3f} turns between pulses (limit {_MISSED_TURNS})"
            )

    def _time_s(self, number: int, at: int) -> float:
        """Return when the shaft was at ``at``: between this SYNC and the one before."""
        (earlier, start), (later, end) = self._shaft.last_two(number)
        if end == start:
            return number * self._period_s
        share = min(max((end - at) / (end - start), 0.0), 1.0)
        return (later - share * (later - earlier)) * self._period_s


DRIVER = Driver(Role.PHOTOCELL, ProbeSettings, ProbePhotocell)
