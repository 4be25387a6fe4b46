"""What ``pmm devices`` does with a whole rig: move an axis, test the photocell, push the gauges."""

import math
import re
import sys
from contextlib import ExitStack
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from hardware.commanded import check_position, check_speed
from hardware.description.errors import ConfigurationError
from hardware.roles import Pulse
from pmm.cli.devices_common import confirm, opened, print_json, print_table
from pmm.cli.screen import error_line, output
from pmm.cli.terminal import Terminal
from pmm.devices.moving import NOTHING_MOVED, axis_of, look, turn
from pmm.devices.moving import move as move_axis
from pmm.devices.opening import DeviceTables
from pmm.devices.pushing import GaugeReadings, Pushed, push_each
from pmm.devices.watching import PhotocellRecord, watch

if TYPE_CHECKING:
    from rich.console import Console

_UNITS: Final = {"m": ("m", 1.0), "mm": ("m", 1e-3), "rad": ("rad", 1.0),
                 "deg": ("rad", math.pi / 180.0)}  # fmt: skip
_POSITION: Final = re.compile(r"^\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([a-z]*)\s*$")


def move(axis: str, position: str, rig: str, free_running: bool, as_json: bool, yes: bool) -> None:
    """Move an axis by hand.

    Raises
    ------
    ConfigurationError, HardwareError
        If the axis, the position or the rig's state do not allow it; nothing has moved then.
    """
    tables = DeviceTables(Path(rig))
    with (
        ExitStack() as shown,
        opened(tables.configuration(), free_running=free_running) as opened_rig,
    ):
        one = axis_of(opened_rig, axis)
        goal = parse_position(position, one.unit)
        check_position(one, goal, told=NOTHING_MOVED)
        there = f"{goal:g} {one.unit}"
        confirm(f"{axis} will home if it has to, and move to {there}. Is the way clear?", yes=yes)
        shown.enter_context(Terminal())
        opened_rig.prepare()
        look(opened_rig)
        reading = move_axis(opened_rig, one, goal)
        unit = one.unit
    if as_json:
        print_json("move", {"axis": axis, "wanted": goal, "unit": unit, "reading": asdict(reading)})
    else:
        output().print(
            f"{axis} stands at {reading.value:.6g} ± {reading.standard_uncertainty:.2g} {unit} "
            f"({reading.source}); wanted {goal:.6g} {unit}"
        )


def parse_position(text: str, unit: str) -> float:
    """Return a position in the axis's unit, from ``20mm``, ``30deg`` or a bare number.

    Raises
    ------
    ConfigurationError
        If it is no number, or its unit is not one of the axis's.
    """
    found = _POSITION.match(text)
    allowed = [name for name, (base, _) in _UNITS.items() if base == unit]
    if not found or (found[2] and found[2] not in allowed):
        raise ConfigurationError(
            f"position {text!r}: write a number, with or without a unit ({', '.join(allowed)})"
        )
    try:
        return float(found[1]) * (_UNITS[found[2]][1] if found[2] else 1.0)
    except ValueError:
        raise ConfigurationError(f"position {text!r} is no number") from None


def photocell(
    rig: str,
    free_running: bool,
    as_json: bool,
    yes: bool,
    pulses: int,
    within_s: float,
    turn_hz: float | None,
) -> None:
    """Test the photocell; ends with status 1 if a pulse is missing or too many."""
    tables = DeviceTables(Path(rig))
    with (
        ExitStack() as shown,
        opened(tables.configuration(), free_running=free_running) as opened_rig,
    ):
        shaft = opened_rig.shaft
        if turn_hz is not None:
            if shaft is None:
                raise ConfigurationError("--turn: the rig has no shaft; turn it by hand")
            check_speed(shaft, turn_hz, told=NOTHING_MOVED)
            confirm(f"the shaft will turn at {turn_hz:g} Hz. Is everything clear of it?", yes=yes)
        terminal = shown.enter_context(Terminal())
        opened_rig.prepare()
        look(opened_rig)
        if turn_hz is not None and shaft is not None:
            turn(opened_rig, shaft, turn_hz)
        else:
            terminal.say(f"turn the shaft by hand, evenly, until {pulses} pulses have come")
        tell = (lambda _: None) if as_json else partial(_tell, terminal)
        watched = watch(opened_rig, pulses, within_s, tell)
    _print_pulses(watched, as_json=as_json)
    if not watched.good:
        raise click.exceptions.Exit(1)


def gauges(
    rig: str, free_running: bool, as_json: bool, channels: tuple[str, ...], within_s: float
) -> None:
    """Push test; ends with status 1 if a gauge is swapped, turned round or silent."""
    tables = DeviceTables(Path(rig))
    with (
        ExitStack() as shown,
        opened(tables.configuration(), free_running=free_running) as opened_rig,
    ):
        all_gauges = GaugeReadings(opened_rig)
        names = tuple(one.name for one in all_gauges.channels)
        for one in channels:
            if one not in names:
                raise ConfigurationError(
                    f"no force channel {one!r}; the rig has {', '.join(names)}"
                )
        console = output(sys.stdout)
        terminal = shown.enter_context(Terminal())
        opened_rig.prepare()
        found = []
        for pushed in push_each(all_gauges, channels or names, tables.plane, within_s):
            found.append(pushed)
            if not as_json:
                _show_push(terminal, console, pushed)
    if as_json:
        print_json("gauges", {"gauges": [_push_document(one) for one in found]})
    if any(one.wrong for one in found):
        raise click.exceptions.Exit(1)


def _tell(terminal: Terminal, pulse: Pulse) -> None:
    terminal.say(f"pulse {pulse.number} at {pulse.time_s:.4f} s")


def _print_pulses(watched: PhotocellRecord, *, as_json: bool) -> None:
    if as_json:
        print_json(
            "photocell",
            {
                "pulses": [asdict(one) for one in watched.pulses],
                "intervals": [{**asdict(one), "verdict": one.verdict} for one in watched.intervals],
                "said": list(watched.said),
                "good": watched.good,
            },
        )
        return
    print_table(
        ("pulse", "time [s]", "interval [s]", "turns", "verdict"),
        [
            (
                str(one.number),
                f"{one.time_s:.4f}",
                f"{one.seconds:.4f}",
                "-" if math.isnan(one.turns) else f"{one.turns:.4f}",
                one.verdict or "ok",
            )
            for one in watched.intervals
        ],
        "pulse,time [s],interval [s],turns",
    )
    for one in watched.said:
        error_line(one)
    if not watched.enough:
        error_line(f"{len(watched.pulses)} pulses in the time; check lamp, slot, cable and input")


def _show_push(terminal: Terminal, console: "Console", pushed: Pushed) -> None:
    push = pushed.push
    if push is not None:
        sign = "+" if push.sign > 0 else "-"
        right = "right" if not pushed.wrong else "WRONG"
        line = (
            f"{pushed.asked}: came in on {push.channel}, sign {sign}, {push.change:+.3g} "
            f"{push.unit} (a push is more than {push.threshold:.2g} {push.unit}): {right}"
        )
        terminal.do(lambda: console.print(line))
    for one in pushed.wrong:
        terminal.say(f"error: {pushed.asked}: {one}")


def _push_document(pushed: Pushed) -> dict[str, object]:
    push = None if pushed.push is None else {**asdict(pushed.push)}
    return {"asked": pushed.asked, "push": push, "wrong": list(pushed.wrong)}
