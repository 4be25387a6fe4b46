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
    return Column(
        heading, lambda setting: value(setting.loop), key, written(".4g"), unit, number=True
    )


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
    Column("", lambda row: rounded(row.of.value, row.half_width), number=True),
    Column("", lambda row: row.of.unit, "unit"),
    Column(None, lambda row: row.of.value, "value"),
    Column(None, lambda row: row.half_width, "half_width"),
)


def tune_document(tuning: Tuning) -> Document:
    """Return what is told of a speed loop; ``docs/devices.md`` describes the keys."""
    contents: list[Content] = [Data("job", "tune"), Text(_answer(tuning), strong=True)]
    if tuning.identified_loop is not None and tuning.record is not None:
        loop, record = tuning.identified_loop, tuning.record
        contents += [
            Table("Found", _NUMBERS, _numbers(loop, tuning), "found"),
            Figure("lag", "What the ramps make of the shaft's angle, measured and of the loop "
                   "found.", lambda: record_figure(record, loop)),
        ]  # fmt: skip
    contents += [
        Table("Gains", _SETTINGS, tuning.settings, "settings", notes=(f"gains in {tuning.unit}",)),
        Figure("bode", "The open loop and how it answers a load.",
               lambda: bode_figure(tuning.settings)),
        Figure("step", "The speed after a step of its set-point, and after one of the load.",
               lambda: step_figure(tuning.settings)),
        Table("Speed ripple", _ripple_columns(tuning), tuning.ripples, "ripples", titled=True),
    ]  # fmt: skip
    return Document("", "speed loop", (Section("", tuple(contents)),), SCHEMA)


def _answer(tuning: Tuning) -> list[str]:
    """Return the answer in three sentences at most."""
    now, best = tuning.settings[0].loop, tuning.settings[-1].loop
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


def _numbers(loop: IdentifiedLoop, tuning: Tuning) -> list[_Number]:
    estimates = {
        "inertia at the shaft": loop.inertia,
        "proportional gain": loop.proportional,
        "viscous bearing": loop.bearing,
        "latency": loop.latency_s,
    }
    return [
        _Number(name, estimate, tuning.level)
        for name, estimate in estimates.items()
        if estimate is not None
    ]


def _ripple_columns(tuning: Tuning) -> Sequence[Column[RunRipple]]:
    def part(index: int) -> Column[RunRipple]:
        return Column(
            tuning.settings[index].name,
            lambda ripple: ripple.relative[index],
            tuning.settings[index].name,
            lambda value: f"{value:.2%}",
            number=True,
        )

    return (word("run", "run"), *map(part, range(len(tuning.settings))))
