"""``pmm devices gauges``: which gauge is pushed, and which way."""

import sys
from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.devices import RIG, opened
from pmm.cli.screen import output, show
from pmm.cli.terminal import Terminal

if TYPE_CHECKING:
    from rich.console import Console

    from pmm.devices.push_session import Pushed


@click.command()
@RIG
@click.option("--channel", "channels", metavar="NAME", multiple=True,
              help="Only this gauge; repeatable.")  # fmt: skip
@click.option("--within", "within_s", metavar="S", type=click.FloatRange(min=1.0), default=30.0,
              show_default=True, help="Wait so long for each push.")  # fmt: skip
def gauges(
    rig: str, free_running: bool, as_json: bool, channels: tuple[str, ...], within_s: float
) -> None:
    """Push test: push each gauge as you are asked to; swapped cables and wrong signs are refused.

    You are asked for one gauge after the other; nothing has to be typed, the push itself is seen.
    """
    from pmm.devices.device_source import DeviceTables
    from pmm.devices.push_session import GaugeReadings, push_each
    from pmm.report.devices_document import gauges_document, push_line

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
                _show_push(terminal, console, pushed, push_line(pushed))
    if as_json:
        show(gauges_document(found), as_json=True)
    if any(one.wrong for one in found):
        raise click.exceptions.Exit(1)


def _show_push(terminal: Terminal, console: "Console", pushed: "Pushed", line: str) -> None:
    if line:
        terminal.do(lambda: console.print(line))
    for one in pushed.wrong:
        terminal.say(f"error: {pushed.asked}: {one}")
