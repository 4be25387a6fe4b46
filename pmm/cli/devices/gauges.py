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
        ExitStack() as stack,
        opened(tables.configuration(), free_running=free_running) as opened_rig,
    ):
        all_gauges = GaugeReadings(opened_rig)
        names = tuple(gauge.name for gauge in all_gauges.channels)
        for name in channels:
            if name not in names:
                raise ConfigurationError(
                    f"no force channel {name!r}; the rig has {', '.join(names)}"
                )
        console = output(sys.stdout)
        terminal = stack.enter_context(Terminal())
        opened_rig.prepare()
        pushes = []
        for push in push_each(all_gauges, channels or names, tables.plane, within_s):
            pushes.append(push)
            if not as_json:
                _show_push(terminal, console, push, push_line(push))
    if as_json:
        show(gauges_document(pushes), as_json=True)
    if any(push.wrong for push in pushes):
        raise click.exceptions.Exit(1)


def _show_push(terminal: Terminal, console: "Console", push: "Pushed", line: str) -> None:
    if line:
        terminal.do(lambda: console.print(line))
    for fault in push.wrong:
        terminal.say(f"error: {push.asked}: {fault}")
