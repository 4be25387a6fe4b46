"""``pmm devices photocell``: its pulses, one by one."""

from contextlib import ExitStack
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.devices import RIG, YES, confirm, opened
from pmm.cli.screen import error_line, show
from pmm.cli.terminal import Terminal

if TYPE_CHECKING:
    from hardware.roles import Pulse
    from pmm.devices.photocell_test import PhotocellRecord


@click.command()
@RIG
@YES
@click.option("--pulses", type=click.IntRange(min=2), default=5, show_default=True,
              help="End after so many.")  # fmt: skip
@click.option("--within", "within_s", metavar="S", type=click.FloatRange(min=0.1), default=60.0,
              show_default=True, help="Wait so long for them.")  # fmt: skip
@click.option("--turn", "turn_hz", metavar="HZ", type=float,
              help="Let the drive turn the shaft; else turn it by hand.")  # fmt: skip
def photocell(
    rig: str,
    free_running: bool,
    as_json: bool,
    yes: bool,
    pulses: int,
    within_s: float,
    turn_hz: float | None,
) -> None:
    """Test the photocell: pulses, intervals, missing and extra ones.

    With --turn, loads and speed are watched as in a run, by the whole of the rig's file.
    """
    from hardware.command_limits import check_speed
    from pmm.devices.axis_move import NOTHING_MOVED, look, turn
    from pmm.devices.device_source import DeviceTables
    from pmm.devices.photocell_test import watch
    from pmm.plan.rig_file import read_rig_file
    from pmm.report.devices_document import photocell_document

    limits = None if turn_hz is None else read_rig_file(rig).watched
    tables = DeviceTables(Path(rig))
    with (
        ExitStack() as stack,
        opened(tables.configuration(), free_running=free_running, limits=limits) as opened_rig,
    ):
        shaft = opened_rig.shaft
        if turn_hz is not None:
            if shaft is None:
                raise ConfigurationError("--turn: the rig has no shaft; turn it by hand")
            check_speed(shaft, turn_hz, remark=NOTHING_MOVED)
            confirm(f"the shaft will turn at {turn_hz:g} Hz. Is everything clear of it?", yes=yes)
        terminal = stack.enter_context(Terminal())
        opened_rig.prepare()
        look(opened_rig)
        if turn_hz is not None and shaft is not None:
            turn(opened_rig, shaft, turn_hz)
        else:
            terminal.say(f"turn the shaft by hand, evenly, until {pulses} pulses have come")
        tell = (lambda _: None) if as_json else partial(_tell, terminal)
        record = watch(opened_rig, pulses, within_s, tell)
    show(photocell_document(record), as_json=as_json)
    if not as_json:
        _complain(record)
    if not record.good:
        raise click.exceptions.Exit(1)


def _tell(terminal: Terminal, pulse: "Pulse") -> None:
    terminal.say(f"pulse {pulse.number} at {pulse.time_s:.4f} s")


def _complain(record: "PhotocellRecord") -> None:
    for message in record.driver_messages:
        error_line(message)
    if not record.enough:
        error_line(f"{len(record.pulses)} pulses in the time; check lamp, slot, cable and input")
