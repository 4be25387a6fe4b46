"""The table of live values: names, units and alarms, the same for every protocol."""

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import Final, NamedTuple

from pmm.console.messages import ChannelInfo, Frame, Hello
from pmm.run.states import State

# Of the free space in bytes: below it the page is red, too. At 2 MB a run of ten minutes half of it
# is 250 runs, twice as much 1000.
LEAST_FREE: Final = 1e9
_FOREIGN: Final = re.compile(r"[^A-Za-z0-9_]")
_SET: Final = {  # names, their units, the settings of a run
    "set_frequency": ("Hz", "frequency_hz"),
    "set_eccentricity": ("m", "eccentricity_m"),
    "set_phase": ("rad", "strut_phase_rad"),
    "set_speed": ("m/s", "carriage_speed_m_s"),
}


class Alarm(IntEnum):
    """How bad a value is; numbers as EPICS has them."""

    FINE = 0
    MINOR = 1
    MAJOR = 2
    INVALID = 3  # not known


class LiveValue(NamedTuple):
    """A number, a count or a text with its unit.

    Attributes
    ----------
    full_scale
        What its sensor bears to either side; NaN where nobody knows it.
    """

    value: float | int | str
    unit: str = ""
    severity: Alarm = Alarm.FINE
    full_scale: float = math.nan


@dataclass(frozen=True)
class Tick:
    """The values of one tick.

    Attributes
    ----------
    number
        Counts the loop's ticks; one that is missing was dropped.
    utc_s
        When it came, in seconds since 1970.
    """

    number: int
    utc_s: float
    values: dict[str, LiveValue]

    def unknown(self) -> "Tick":
        """Return the same values as those that nobody vouches for any more."""
        values = {k: v._replace(severity=Alarm.INVALID) for k, v in self.values.items()}
        return replace(self, values=values)


class LiveTable:
    """Makes the table of each frame; a channel keeps its latest sample until the next."""

    def __init__(self, hello: Hello) -> None:
        self._hello = hello
        self._samples = [math.nan] * len(hello.channels)
        self._names = [_names(channel, hello.harmonics) for channel in hello.channels]

    def tick(self, frame: Frame, utc_s: float) -> Tick:
        """Return all live values of a frame, measured at ``utc_s``, seconds since 1970."""
        if frame.trace.values.size:
            self._samples = frame.trace.values[:, -1].tolist()
        values = {**_of_the_run(frame), **_of_the_rig(frame)}
        for k, channel in enumerate(self._hello.channels):
            values |= dict(self._of_channel(k, channel, frame))
        return Tick(frame.number, utc_s, values)

    def _of_channel(
        self, row: int, channel: ChannelInfo, frame: Frame
    ) -> Iterator[tuple[str, LiveValue]]:
        """Yield the latest sample, and the needles: mean and harmonics."""
        name, *parts, width_name = self._names[row]
        sample = self._samples[row]
        over = abs(sample) > channel.full_scale
        worst = Alarm.MAJOR if over else Alarm.FINE
        yield name, _number(sample, channel.unit, worst, channel.full_scale)
        count = 2 * self._hello.harmonics + 1
        needles = frame.needles
        read = [math.nan] * count if needles is None else needles.coefficients[row].tolist()
        widths = [math.nan] * count if needles is None else needles.half_widths[row].tolist()
        for part, value in zip(parts, read, strict=True):
            yield part, _number(value, channel.unit, full_scale=channel.full_scale)
        width = max(widths[1:3])  # of the first harmonic
        yield width_name, _number(width, channel.unit)


def _names(channel: ChannelInfo, harmonics: int) -> list[str]:
    """Return the names of a channel's values: sample, mean, harmonics, half-width."""
    parts = ["mean", "in_phase", "quadrature"]
    for order in range(2, harmonics + 1):
        parts += [f"in_phase_{order}", f"quadrature_{order}"]
    name = _FOREIGN.sub("_", channel.name)
    return [name, *(f"{name}:{part}" for part in (*parts, "half_width"))]


def _of_the_run(frame: Frame) -> dict[str, LiveValue]:
    status = frame.status
    fault = status.state is State.FAULT
    asked = Alarm.MINOR if frame.question else Alarm.FINE
    values = {
        "state": LiveValue(str(status.state), severity=Alarm.MAJOR if fault else Alarm.FINE),
        "run": LiveValue(status.run),
        "run_number": LiveValue(status.run_number),
        "run_count": LiveValue(status.run_count),
        "gate": LiveValue(str(status.gate)),
        "periods": LiveValue(status.periods),
        "periods_wanted": LiveValue(status.wanted_periods),
        "final": LiveValue(int(frame.needles is not None and frame.needles.final)),
        "question": LiveValue(frame.question, severity=asked),
    }
    for name, (unit, key) in _SET.items():
        point = frame.set_point
        values[name] = _number(math.nan if point is None else getattr(point, key), unit)
    return values


def _of_the_rig(frame: Frame) -> dict[str, LiveValue]:
    free = frame.status.free_bytes
    free_bytes = math.nan if free is None else float(free)
    bus = Alarm.FINE if frame.bus.ok else Alarm.MAJOR
    late = Alarm.MINOR if frame.loop.late else Alarm.FINE
    scarce = Alarm.MINOR if free_bytes < LEAST_FREE else Alarm.FINE
    return {
        "time": LiveValue(frame.status.time_s, "s"),
        "shaft": _number(frame.shaft_hz, "Hz"),
        **{_FOREIGN.sub("_", name): _number(value, unit) for name, unit, value in frame.axes},
        "bus": LiveValue(int(frame.bus.ok), severity=bus),
        "fault": LiveValue("; ".join(frame.bus.faults), severity=bus),
        "late_cycles": LiveValue(frame.loop.late, severity=late),
        "free_space": _number(free_bytes, "byte", scarce),
    }


def _number(
    value: float, unit: str, severity: Alarm = Alarm.FINE, full_scale: float = math.nan
) -> LiveValue:
    if not math.isfinite(value):
        return LiveValue(math.nan, unit, Alarm.INVALID, full_scale)
    return LiveValue(value, unit, severity, full_scale)
