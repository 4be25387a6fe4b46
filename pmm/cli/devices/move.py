"""``pmm devices move``: an axis by hand."""

import math
import re
from contextlib import ExitStack
from pathlib import Path

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.devices import RIG, YES, confirm, opened
from pmm.cli.screen import show
from pmm.cli.terminal import Terminal

_UNITS = {"m": ("m", 1.0), "mm": ("m", 1e-3), "rad": ("rad", 1.0),
                 "deg": ("rad", math.pi / 180.0)}  # fmt: skip
_POSITION = re.compile(r"^\s*([-+]?[0-9.]+(?:[eE][-+]?[0-9]+)?)\s*([a-z]*)\s*$")


@click.command(context_settings={"ignore_unknown_options": True})
@click.argument("axis", metavar="AXIS")
@click.argument("position", metavar="POSITION")
@RIG
@YES
def move(axis: str, position: str, rig: str, free_running: bool, as_json: bool, yes: bool) -> None:
    """Move an axis by hand: eccentricity, phase, drift, heel or rudder.

    POSITION is in the axis's unit, or as 20mm, 30deg. It is homed first if it is not. Beyond its
    limits, or while the shaft turns, it is refused.

    \b
    pmm devices move eccentricity 20mm rig.toml
    """  # noqa: D301
    from hardware.command_limits import check_position
    from pmm.devices.axis_move import NOTHING_MOVED, axis_of, look
    from pmm.devices.axis_move import move as move_axis
    from pmm.devices.device_source import DeviceTables
    from pmm.report.devices_document import move_document

    tables = DeviceTables(Path(rig))
    with (
        ExitStack() as stack,
        opened(tables.configuration(), free_running=free_running) as opened_rig,
    ):
        rig_axis = axis_of(opened_rig, axis)
        goal = _position(position, rig_axis.unit)
        check_position(rig_axis, goal, remark=NOTHING_MOVED)
        goal_text = f"{goal:g} {rig_axis.unit}"
        confirm(
            f"{axis} will home if it has to, and move to {goal_text}. Is the way clear?", yes=yes
        )
        stack.enter_context(Terminal())
        opened_rig.prepare()
        look(opened_rig)
        reading = move_axis(opened_rig, rig_axis, goal)
        unit = rig_axis.unit
    show(move_document(axis, goal, unit, reading), as_json=as_json)


def _position(text: str, unit: str) -> float:
    """Return a position in the axis's unit, from ``20mm``, ``30deg`` or a bare number.

    Raises
    ------
    ConfigurationError
        If it is no number, or its unit is not one of the axis's.
    """
    match = _POSITION.match(text)
    allowed = [name for name, (base, _) in _UNITS.items() if base == unit]
    if not match or (match[2] and match[2] not in allowed):
        raise ConfigurationError(
            f"position {text!r}: write a number, with or without a unit ({', '.join(allowed)})"
        )
    try:
        return float(match[1]) * (_UNITS[match[2]][1] if match[2] else 1.0)
    except ValueError:
        raise ConfigurationError(f"position {text!r} is no number") from None
