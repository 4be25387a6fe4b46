"""``pmm console``: a rig on a screen."""

from typing import Any

import click


@click.command()
@click.argument("rig", metavar="RIG.TOML", default="rig.toml")
@click.option("--plans", metavar="FOLDER", help="Where plans lie.  [default: beside RIG.TOML]")
@click.option(
    "--output",
    metavar="FOLDER",
    help="Record campaigns there, a folder each.  [default: the folder that RIG.TOML names]",
)
@click.option("--host", default="127.0.0.1", show_default=True, help="Listen on this address.")
@click.option("--port", default=8063, show_default=True, type=click.IntRange(0, 65535))
@click.option("--token-file", metavar="FILE", help="Ask for the token in this file.")
@click.option(
    "--watch-token-file", metavar="FILE", help="Whoever gives the token in this file only watches."
)
@click.option(
    "--propose-token-file",
    metavar="FILE",
    help="Whoever gives the token in this file watches, and proposes changes of the queue.",
)
@click.option("--certificate", metavar="FILE", help="Speak HTTPS with this certificate (PEM).")
@click.option("--key", metavar="FILE", help="The certificate's key (PEM).")
@click.option(
    "--earlier",
    metavar="FOLDER",
    multiple=True,
    help="Show the coefficients of this campaign beside; repeatable.",
)
@click.option("--reference", metavar="FILE", help="Show this table of coefficients beside.")
@click.option(
    "--speed",
    type=click.FloatRange(min=0.1, max=1000.0),
    default=1.0,
    show_default=True,
    help="Run a simulated rig so many times as fast as the clock.",
)
@click.option(
    "--mqtt",
    metavar="URL",
    help="Publish live values to this broker: mqtt://HOST, or mqtts://USER@HOST:PORT/TOPIC.",
)
@click.option("--mqtt-password-file", metavar="FILE", help="The broker's password for USER.")
@click.option(
    "--mqtt-authority",
    metavar="FILE",
    help="Trust the broker's certificate by this one (PEM).  [default: the system's]",
)
@click.option(
    "--epics", metavar="PREFIX", help="Serve live values as EPICS process variables, PREFIX:NAME."
)
def console(**options: Any) -> None:
    """Show a rig in the browser and command it from there.

    The page shows needles, phasors, traces, gate, alarms and finished runs, and commands the rig.
    The control loop runs on when the page is closed. Ctrl-C once stops gently and leaves; twice
    stops at once.

    Listening beyond this machine needs --token-file; use --certificate and --key there too.

    \b
    pmm console examples/vertical/rig.toml --output my-campaigns

    Exit status: 0 left by Ctrl-C at rest; 1 the rig says no; 2 the request was wrong.
    """  # noqa: D301
    from contextlib import ExitStack
    from pathlib import Path

    from pmm.cli.files import check_folder
    from pmm.cli.screen import messages
    from pmm.cli.terminal import Terminal
    from pmm.coefficients.references import read_references
    from pmm.coefficients.settings import CoefficientSettings, ReferenceFile
    from pmm.console.request import ConsoleRequest
    from pmm.console.session import run_loop, station_of
    from pmm.run.operator import Interrupts

    request = ConsoleRequest(**options)
    rig_file = request.rig_file()
    if request.output is not None:
        check_folder(Path(request.output), "--output")
    if request.reference is not None:  # shown only when runs have ended: read now
        read_references(
            (ReferenceFile(request.reference),),
            rig_file.oscillator.plane,
            CoefficientSettings().form,
        )
    interrupts = Interrupts()
    # The terminal is waited for last: the rig is left by then.
    with (
        ExitStack() as stack,
        interrupts.counted(),
        station_of(request, rig_file, lambda line: messages().print(line)) as station,
    ):
        terminal = stack.enter_context(Terminal())
        run_loop(station, interrupts, terminal.say)
        if station.control.fault is not None:
            terminal.say(f"fault: {station.control.fault}")
