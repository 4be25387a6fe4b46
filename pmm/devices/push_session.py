"""The push test on a rig: one gauge after the other is pushed, and has to answer with its sign."""

from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.demand import Demand
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCE_X, Channel
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.rig import Rig
from pmm.devices.push_test import NoPushError, Push, PushError, faults, judge

_REST_S: Final = 1.0
_LOOK_S: Final = 0.1
_FEWEST: Final = 8  # samples to judge by, however slow the amplifier
_AFTER_S: Final = 0.5  # recorded on after a push is seen
_PUSH_SHARE: Final = 0.1  # of the full scale, what a simulated operator pushes with


@dataclass(frozen=True)
class Pushed:
    """What came of one gauge.

    Attributes
    ----------
    asked
        The gauge that was to be pushed.
    push
        What the gauges saw; ``None`` if that was no push.
    wrong
        What is wrong and how to put it right; empty if nothing is.
    """

    asked: str
    push: Push | None
    wrong: tuple[str, ...]


class GaugeReadings:
    """Keeps what the force channels of a rig have read since :meth:`begin`."""

    def __init__(self, rig: Rig) -> None:
        self.rig = rig
        self.channels: tuple[Channel, ...] = tuple(
            channel for device in rig.forces for channel in device.channels
        )
        if not self.channels:
            raise ConfigurationError("the rig has no force channels; it needs a [[forces]] table")
        self._rates = {
            channel.name: dev.sample_rate_hz for dev in rig.forces for channel in dev.channels
        }
        self._kept: dict[str, deque[float]] = {}
        self.begin()

    def begin(self) -> None:
        """Forget all readings, before a push."""
        self._kept = {channel.name: deque() for channel in self.channels}

    def run(self, seconds: float, prompt: str = "") -> None:
        """Let cycles pass; ``prompt`` is shown to the operator meanwhile."""
        for _ in range(max(1, round(seconds * self.rig.configuration.sample_rate_hz))):
            if prompt:
                self.rig.prompt(prompt)
            self.rig.cycle()
            for device in self.rig.forces:
                for block in device.take():
                    for channel, row in zip(device.channels, block.values, strict=True):
                        self._kept[channel.name].extend(row.tolist())

    def records(self, last_s: float | None = None) -> Mapping[str, FloatArray]:
        """Return the samples of each channel, all of them or the last seconds."""
        records = {}
        for name, values in self._kept.items():
            record = np.array(values, dtype=np.float64)
            count = record.size
            if last_s is not None:
                count = max(round(last_s * self._rates[name]), _FEWEST)
            records[name] = record[max(record.size - count, 0) :]
        return records


def push_each(
    gauges: GaugeReadings, names: tuple[str, ...], plane: Plane | None, within_s: float = 30.0
) -> Iterator[Pushed]:
    """Have the gauges pushed one after the other; yield what came of each.

    Parameters
    ----------
    plane
        Decides how the directions are named; ``None`` where the rig's file does not say.
    within_s
        How long to wait for each push, and for its end.

    Raises
    ------
    HardwareError
        As the rig's cycle does; pushed beyond full scale, the channel is saturated.
    """
    for name in names:
        gauges.begin()
        gauges.run(_REST_S)
        rest = gauges.records()
        gauges.begin()
        yield _wait_for_push(gauges, name, rest, plane, within_s)
        _wait_for_rest(gauges, name, rest, within_s)


def direction(channel: str, plane: Plane | None) -> str:
    """Return which way to push the model at a gauge, so that the gauge has to read plus.

    A dynamometer reads the force of the strut on the model, positive down, to starboard or forward
    (docs/conventions.md); a hand that pushes the model the other way is held by just that.
    """
    if channel == FORCE_X.name:
        return "aft"
    if plane is None:
        return "up (vertical oscillator) or to port (horizontal)"
    return "up" if plane is Plane.VERTICAL else "to port"


def _wait_for_push(
    gauges: GaugeReadings,
    name: str,
    rest: Mapping[str, FloatArray],
    plane: Plane | None,
    within_s: float,
) -> Pushed:
    text = f"push the model {direction(name, plane)} at the gauge {name}, then let go"
    demand = Demand(text, "load", _load(gauges, name), 1.0, name)
    reason = ""
    for _ in range(round(within_s / _LOOK_S)):
        gauges.run(_LOOK_S, demand)
        try:
            judge(gauges.channels, rest, gauges.records(2.0 * _LOOK_S))
        except PushError as error:
            reason = str(error)
            continue
        gauges.run(_AFTER_S)
        return _judged(gauges, name, rest)
    return Pushed(name, None, (f"{reason} (waited {within_s:g} s)",))


def _judged(gauges: GaugeReadings, name: str, rest: Mapping[str, FloatArray]) -> Pushed:
    try:
        push = judge(gauges.channels, rest, gauges.records())
    except PushError as error:
        return Pushed(name, None, (str(error),))
    return Pushed(name, push, faults(push, name))


def _wait_for_rest(
    gauges: GaugeReadings, name: str, rest: Mapping[str, FloatArray], within_s: float
) -> None:
    """Let cycles pass until no gauge shows a push any more, or the time is over."""
    demand = Demand(f"let go of {name}", "load", 0.0, 1.0, name)
    for _ in range(round(within_s / _LOOK_S)):
        gauges.run(_LOOK_S, demand)
        try:
            judge(gauges.channels, rest, gauges.records(_LOOK_S))
        except NoPushError:
            return
        except PushError:
            continue


def _load(gauges: GaugeReadings, name: str) -> float:
    full = next(channel.full_scale for channel in gauges.channels if channel.name == name)
    return _PUSH_SHARE * (full or 1.0)
