"""``pmm devices read``: what a rig, a bus or a port reads now."""

import sys
import time
from contextlib import contextmanager, suppress
from functools import partial
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.devices import ANY, Target, opened
from pmm.cli.screen import error_line, output, show
from pmm.cli.terminal import Terminal

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from rich.console import Console
    from rich.live import Live as Screen

    from pmm.devices.device_readings import DeviceRow
    from pmm.devices.device_source import DeviceTables
    from pmm.devices.readings import Look, Shown

_LATEST = 5  # faults shown


@click.command()
@ANY
@click.option("--once", is_flag=True, help="Read once and end, in place of a live table.")
@click.option("--seconds", type=click.FloatRange(min=0.0), help="End after so long.")
def read(once: bool, seconds: float | None, as_json: bool, **options: Any) -> None:
    """Show what the devices read, live. Nothing gets power.

    A bus alone is read by SDO: what the nodes have mapped to their process data.
    """
    from pmm.devices.readings import ONCE_S
    from pmm.report.devices_document import values_document

    target = Target(**options)
    tables = target.tables()
    screen = None if once or as_json else _screen(output(sys.stdout))
    # The terminal is waited for last: the rig is left by then.
    with Terminal() as terminal, _source(target, tables) as look:
        values = look(ONCE_S) if once else _live(look, seconds, terminal, screen)
    if as_json or once:
        show(values_document(values), as_json=as_json)
    for message in () if as_json else values.faults[-_LATEST:]:
        error_line(message)


@contextmanager
def _source(target: Target, tables: "DeviceTables | None") -> "Iterator[Look]":
    """Open what is named, and give what looks at it."""
    from pmm.devices.readings import of_bus, of_port, of_rig

    if tables is not None:
        with opened(tables.configuration()) as rig:
            rig.prepare()
            yield of_rig(rig)
    else:
        source = of_bus(target.bus()) if target.interface else of_port(target.port_settings())
        with source as look:
            yield look


def _live(
    look: "Look", seconds: float | None, terminal: Terminal, screen: "Screen | None"
) -> "Shown":
    """Look again and again; on a terminal the table stays in its place."""
    from pmm.devices.readings import REFRESH_S, Shown

    end = None if seconds is None else time.monotonic() + seconds
    values = Shown(())
    with suppress(KeyboardInterrupt):  # the way to end it
        while end is None or time.monotonic() < end:
            values = look(REFRESH_S)
            if screen is not None:
                terminal.draw(partial(_draw, screen, values.rows))
    if screen is not None:
        terminal.do(partial(_draw, screen, values.rows))
        terminal.do(screen.stop)
    return values


def _screen(console: "Console") -> "Screen":
    from rich.live import Live as Screen

    return Screen(console=console, auto_refresh=False, redirect_stdout=False, redirect_stderr=False)


def _draw(screen: "Screen", rows: "Sequence[DeviceRow]") -> None:
    from pmm.document.terminal import grid
    from pmm.report.devices_document import values_table

    screen.start()
    screen.update(grid(values_table(rows)), refresh=True)
