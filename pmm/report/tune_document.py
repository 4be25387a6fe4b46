"""What ``pmm devices tune`` says: the loop as it is, as it was found, and as it could be set."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from analysis.speed_loop.identification import IdentifiedLoop
from analysis.speed_loop.loop import ShaftLoop
from analysis.uncertainty.estimate import Estimate
from pmm.document.content import Column, Content, Data, Document, Figure, Section, Table, Text, word
from pmm.document.notation import rounded, written
from pmm.plan.tuning import LoopSetting, RunRipple, Tuning
from pmm.report.devices_document import SCHEMA
from pmm.report.tune_figure import bode_figure, record_figure, step_figure


@dataclass(frozen=True)
class _Number:
    what: str
    of: Estimate
    level: float

    @property
    def half_width(self) -> float:
        return self.of.half_width(self.level)


def _of(
    heading: str, key: str, value: Callable[[ShaftLoop], float], unit: str = ""
) -> Column[LoopSetting]:
    return Column(heading, lambda one: value(one.loop), key, written(".4g"), unit, number=True)


_SETTINGS: Final[tuple[Column[LoopSetting], ...]] = (
    word("gains", "name"),
    _of("proportional", "proportional", lambda loop: loop.controller.proportional),
    _of("integral", "integral", lambda loop: loop.controller.integral),
    _of("bandwidth", "bandwidth_hz", lambda loop: loop.bandwidth_hz, "Hz"),
    _of("gain margin", "gain_margin", lambda loop: loop.margins.gain),
    _of("phase margin", "phase_margin_deg", lambda loop: math.degrees(loop.margins.phase_rad),
        "deg"),
    _of("largest sensitivity", "largest_sensitivity", lambda loop: loop.margins.sensitivity),
)  # fmt: skip
_NUMBERS: Final[tuple[Column[_Number], ...]] = (
    word("found", "what"),
    Column("", lambda one: rounded(one.of.value, one.half_width), number=True),
    Column("", lambda one: one.of.unit, "unit"),
    Column(None, lambda one: one.of.value, "value"),
    Column(None, lambda one: one.half_width, "half_width"),
)


def tune_document(told: Tuning) -> Document:
    """Return what is told of a speed loop; ``docs/devices.md`` describes the keys."""
    contents: list[Content] = [Data("job", "tune"), Text(_answer(told), strong=True)]
    if told.found is not None and told.record is not None:
        found, record = told.found, told.record
        contents += [
            Table("Found", _NUMBERS, _numbers(found, told), "found"),
            Figure("lag", "What the ramps make of the shaft's angle, measured and of the loop "
                   "found.", lambda: record_figure(record, found)),
        ]  # fmt: skip
    contents += [
        Table("Gains", _SETTINGS, told.settings, "settings", notes=(f"gains in {told.unit}",)),
        Figure("bode", "The open loop and how it answers a load.",
               lambda: bode_figure(told.settings)),
        Figure("step", "The speed after a step of its set-point, and after one of the load.",
               lambda: step_figure(told.settings)),
        Table("Speed ripple", _ripple_columns(told), told.ripples, "ripples", titled=True),
    ]  # fmt: skip
    return Document("", "speed loop", (Section("", tuple(contents)),), SCHEMA)


def _answer(told: Tuning) -> list[str]:
    """Return the answer in three sentences at most."""
    now, best = told.settings[0].loop, told.settings[-1].loop
    lines = []
    if now.closed and not now.stable:
        lines.append("The stated gains make the loop unstable.")
    elif now.controller.integral:
        times = best.controller.integral / now.controller.integral
        lines.append(
            f"The proposed gains meet a slow load {times:.3g} times as firmly as the stated ones."
        )
    else:
        lines.append("The stated loop lets the speed fall under a load; the proposed one does not.")
    lines.append("Nothing was written to the drive: set the gains there, and make the test again.")
    return lines


def _numbers(found: IdentifiedLoop, told: Tuning) -> list[_Number]:
    named = {
        "inertia at the shaft": found.inertia,
        "proportional gain": found.proportional,
        "viscous bearing": found.bearing,
        "latency": found.latency_s,
    }
    return [_Number(what, of, told.level) for what, of in named.items() if of is not None]


def _ripple_columns(told: Tuning) -> Sequence[Column[RunRipple]]:
    def part(index: int) -> Column[RunRipple]:
        return Column(
            told.settings[index].name,
            lambda one: one.relative[index],
            told.settings[index].name,
            lambda value: f"{value:.2%}",
            number=True,
        )

    return (word("run", "run"), *map(part, range(len(told.settings))))
