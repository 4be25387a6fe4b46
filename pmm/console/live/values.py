"""The table of live values: names, units and alarms, the same for every protocol."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Final, NamedTuple

from pmm.console.messages import ChannelInfo, Frame, Hello
from pmm.run.states import State

# Of the free space in bytes: below it the page is red, too. At 2 MB a run of ten minutes half of it
# is 250 runs, twice as much 1000.
LEAST_FREE: Final = 1e9
_FOREIGN: Final = re.compile(r"[^A-Za-z0-9_]")
_UNITS: Final = {  # of the rig and the run; counts and texts have none
    "set_frequency": "Hz", "set_eccentricity": "m", "set_phase": "rad", "set_speed": "m/s",
    "time": "s", "shaft": "Hz", "free_space": "byte",
}  # fmt: skip


class Alarm(IntEnum):
    """How bad a value is; numbers as EPICS has them."""

    FINE = 0
    MINOR = 1
    MAJOR = 2
    INVALID = 3  # not known


class ValueFacts(NamedTuple):
    """What of a value stays from tick to tick.

    Attributes
    ----------
    full_scale
        What its sensor bears to either side; NaN where nobody knows it.
    """

    unit: str = ""
    full_scale: float = math.nan


@dataclass(frozen=True)
class Tick:
    """The values of one tick: numbers, counts and texts by their names.

    Attributes
    ----------
    number
        Counts the loop's ticks; one that is missing was dropped.
    utc_s
        When it came, in seconds since 1970.
    values
        A number that is not known is NaN.
    alarms
        Of the values that are not fine.
    facts
        Of all values; the same object as long as nothing of it changes.
    """

    number: int
    utc_s: float
    values: dict[str, float | int | str]
    alarms: dict[str, Alarm]
    facts: dict[str, ValueFacts]

    def unknown(self) -> "Tick":
        """Return the same values as those that nobody vouches for any more."""
        return replace(self, alarms=dict.fromkeys(self.values, Alarm.INVALID))


class LiveTable:
    """Makes the table of each frame; a channel keeps its latest sample until the next."""

    def __init__(self, hello: Hello) -> None:
        self._channels = hello.channels
        self._samples = [math.nan] * len(hello.channels)
        self._names = [_names(channel, hello.harmonics) for channel in hello.channels]
        self._unread = [math.nan] * (2 * hello.harmonics + 1)
        self._axes: tuple[tuple[str, str], ...] | None = None
        self._facts: dict[str, ValueFacts] = {}

    def tick(self, frame: Frame, utc_s: float) -> Tick:
        """Return all live values of a frame, measured at ``utc_s``, seconds since 1970."""
        if frame.trace.values.size:
            self._samples = frame.trace.values[:, -1].tolist()
        values, alarms = _of_the_run(frame), _alarms(frame)
        values |= _of_the_rig(frame)
        self._add_channels(frame, values, alarms)
        unknown = [k for k, v in values.items() if isinstance(v, float) and not math.isfinite(v)]
        values |= dict.fromkeys(unknown, math.nan)
        alarms |= dict.fromkeys(unknown, Alarm.INVALID)
        return Tick(frame.number, utc_s, values, alarms, self._facts_of(frame, values))

    def _add_channels(
        self, frame: Frame, values: dict[str, float | int | str], alarms: dict[str, Alarm]
    ) -> None:
        """Add the latest samples and the needles: mean, harmonics, half-width of the first one."""
        needles = frame.needles
        rows = [self._unread] * len(self._names)
        read = rows if needles is None else needles.coefficients.tolist()
        widths = rows if needles is None else needles.half_widths.tolist()
        for channel, names, sample, row, width in zip(
            self._channels, self._names, self._samples, read, widths, strict=True
        ):
            if abs(sample) > channel.full_scale:
                alarms[names[0]] = Alarm.MAJOR
            values.update(zip(names, (sample, *row, max(width[1:3])), strict=True))

    def _facts_of(self, frame: Frame, names: Iterable[str]) -> dict[str, ValueFacts]:
        """Return units and full scales; only axes may come and go while a rig is open."""
        axes = tuple((name, unit) for name, unit, _ in frame.axes)
        if axes != self._axes:
            self._axes = axes
            stated = {name: ValueFacts(unit) for name, unit in _UNITS.items()}
            stated |= {_plain(name): ValueFacts(unit) for name, unit in axes}
            for channel, own in zip(self._channels, self._names, strict=True):
                stated |= dict.fromkeys(own, ValueFacts(channel.unit, channel.full_scale))
                stated[own[-1]] = ValueFacts(channel.unit)
            self._facts = {name: stated.get(name, ValueFacts()) for name in names}
        return self._facts


def _names(channel: ChannelInfo, harmonics: int) -> list[str]:
    """Return the names of a channel's values: sample, mean, harmonics, half-width."""
    parts = ["mean", "in_phase", "quadrature"]
    for order in range(2, harmonics + 1):
        parts += [f"in_phase_{order}", f"quadrature_{order}"]
    name = _plain(channel.name)
    return [name, *(f"{name}:{part}" for part in (*parts, "half_width"))]


def _plain(name: str) -> str:
    return _FOREIGN.sub("_", name)


def _of_the_run(frame: Frame) -> dict[str, float | int | str]:
    status, point = frame.status, frame.set_point
    return {
        "state": str(status.state),
        "run": status.run,
        "run_number": status.run_number,
        "run_count": status.run_count,
        "gate": str(status.gate),
        "periods": status.periods,
        "periods_wanted": status.wanted_periods,
        "final": int(frame.needles is not None and frame.needles.final),
        "question": frame.question,
        "set_frequency": math.nan if point is None else point.frequency_hz,
        "set_eccentricity": math.nan if point is None else point.eccentricity_m,
        "set_phase": math.nan if point is None else point.strut_phase_rad,
        "set_speed": math.nan if point is None else point.carriage_speed_m_s,
    }


def _of_the_rig(frame: Frame) -> dict[str, float | int | str]:
    free_bytes = frame.status.free_bytes
    return {
        "time": frame.status.time_s,
        "shaft": frame.shaft_hz,
        **{_plain(name): value for name, _, value in frame.axes},
        "bus": int(frame.bus.ok),
        "fault": "; ".join(frame.bus.faults),
        "late_cycles": frame.loop.late,
        "free_space": math.nan if free_bytes is None else float(free_bytes),
    }


def _alarms(frame: Frame) -> dict[str, Alarm]:
    """Return the alarms of run and rig; those of numbers that are not known come besides."""
    free_bytes = frame.status.free_bytes
    alarms = {}
    if frame.status.state is State.FAULT:
        alarms["state"] = Alarm.MAJOR
    if frame.question:
        alarms["question"] = Alarm.MINOR
    if not frame.bus.ok:
        alarms |= {"bus": Alarm.MAJOR, "fault": Alarm.MAJOR}
    if frame.loop.late:
        alarms["late_cycles"] = Alarm.MINOR
    if free_bytes is not None and free_bytes < LEAST_FREE:
        alarms["free_space"] = Alarm.MINOR
    return alarms
