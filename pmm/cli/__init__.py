"""The command line: ``pmm COMMAND``, each command imported when it is asked for."""

import os
import sys
from typing import Any

import click

from hardware.description.errors import PmmError
from pmm.cli.group import CommandGroup

_LINES = {
    "analyse": "Resolve recordings into mean and harmonics, with uncertainty.",
    "archive": "Keep many campaigns in one file: list, find, show, note, trend, export.",
    "coefficients": "Find a campaign's coefficients, each with its interval and budget.",
    "compare": "Compare two channels that show the same quantity.",
    "completion": "Print the lines that let a shell complete commands and options with Tab.",
    "console": "Show a rig in the browser and command it from there.",
    "demo": "Run a small campaign on the simulated rig and write a report.",
    "devices": "Scan a bus or a port, read values live, move an axis, test photocell and gauges.",
    "doctor": "Check installation, buses, ports, devices, permissions, clock and disk.",
    "effects": "List the effects, or show one with the signature that theory predicts.",
    "evaluate": "Evaluate the tests of a recorded campaign.",
    "gap": "Find out why rig and simulation differ.",
    "inertia": "Find mass, centre of gravity, inertia and gyradii, with a budget.",
    "init": "Write first files: commented, and tried by the very commands that read them.",
    "manoeuvre": "Predict turning circles, zig-zags, spiral and stability of a ship.",
    "plan": "Design, check and show a plan of runs, before the rig moves.",
    "recover": "Make recordings of runs that were not closed.",
    "replay": "Run a run's raw log through the live path again, and compare.",
    "report": "Write a campaign's report: one HTML page, offline, ready to print.",
    "run": "Carry out a plan on its rig and record every run.",
    "simulate": "Simulate the runs of a campaign and write its recordings.",
    "steering": "Identify propeller and rudder of tows and oscillations by the MMG method.",
}  # of the help
_INTERRUPTED = 130  # what a shell reports of a command that Ctrl-C ended


class Commands(CommandGroup):
    """The group of all commands, which turns our errors into messages and exit statuses."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command; what it refuses becomes one clear line and an exit status."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise
        except (PmmError, OSError) as error:
            from pmm.cli.screen import tell_refusal

            ctx.exit(tell_refusal(error))
        except KeyboardInterrupt:
            click.echo("stopped", err=True)
            ctx.exit(_INTERRUPTED)


def _print_version(ctx: click.Context, parameter: click.Parameter, wanted: bool) -> None:  # noqa: ARG001
    if wanted and not ctx.resilient_parsing:
        from pmm.version import version_line

        click.echo(version_line())
        ctx.exit()


def _set_memory(ctx: click.Context, parameter: click.Parameter, gigabytes: float | None) -> None:  # noqa: ARG001
    """Set the limit for this process and those that it starts."""
    from analysis.reading_limits import MEMORY_SETTING

    if gigabytes is not None:
        os.environ[MEMORY_SETTING] = repr(gigabytes)


@click.group(
    cls=Commands,
    package="pmm.cli",
    names=_LINES,
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.option("--debug", is_flag=True, help="Show the traceback of an error.")
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version, and what it runs on.",
)
@click.option(
    "--read-memory",
    type=click.FloatRange(0.0, min_open=True),
    metavar="GB",
    expose_value=False,
    callback=_set_memory,
    help="Memory that reading one recording may take; PMM_READ_MEMORY_GB does the same."
    "  [default: 1]",
)
def cli(debug: bool) -> None:
    """Planar motion mechanism: simulate runs and resolve recordings into harmonics.

    Exit status: 0 done, 1 the data or the rig says no, 2 wrong usage.
    """


def main() -> None:
    """Run the command line of this process."""
    from pmm.cli.screen import pasted

    _hold_standard_numbers()
    cli.main(args=sys.argv[1:], prog_name=pasted(), complete_var="_PMM_COMPLETE")


def _hold_standard_numbers() -> None:
    """Keep the numbers of closed standard streams from files: a message would end in one."""
    for number in range(3):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest that is free
