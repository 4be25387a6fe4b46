"""``pmm devices``: look at the devices of a rig one by one, before anything runs by itself."""

from collections.abc import Callable
from typing import Any

import click

from pmm.cli.group import NamingGroup

JOBS = ("scan", "read", "move", "photocell", "gauges", "ports")


class Jobs(NamingGroup):
    """The group of the jobs, in the order in which a rig is put into service."""

    names = JOBS
    kind = "job"


@click.group(cls=Jobs)
def devices() -> None:
    """Scan a bus or a port, read values live, move an axis, test photocell and gauges.

    A job takes the rig's file; "scan" and "read" also a bus or a port alone. Exit status: 0 all is
    right, 1 something is missing or wrong, 2 the request or the file is.

    \b
    pmm devices scan rig.toml
    pmm devices scan --interface socketcan --channel can0 --bitrate 1000000
    pmm devices gauges rig.toml
    """  # noqa: D301


def _with(*options: Callable[[Any], Any]) -> Callable[[Any], Any]:
    def add(function: Any) -> Any:
        for option in reversed(options):
            function = option(function)
        return function

    return add


_JSON = click.option("--json", "as_json", is_flag=True, help="Print one JSON document.")
_YES = click.option("--yes", is_flag=True, help="Do not ask before anything moves.")
_FREE = click.option(
    "--free-running", is_flag=True, help="A simulated rig only: as fast as it goes, nobody asked."
)
_RIG = _with(click.argument("rig", metavar="RIG.toml"), _FREE, _JSON)
_ANY = _with(
    click.argument("rig", metavar="[RIG.toml]", required=False),
    click.option("--interface", metavar="NAME", help="A CAN interface of python-can."),
    click.option("--channel", metavar="NAME", default="", help="Its channel: can0, a device ..."),
    click.option("--bitrate", metavar="BIT/S", type=click.IntRange(min=1), default=1_000_000,
                 show_default=True, help="Bits per second."),
    click.option("--option", "options", metavar="NAME=VALUE", multiple=True,
                 help="More for the interface, as python-can names it; repeatable."),
    click.option("--port", metavar="URL", help="A serial port, alone; see \"pmm devices ports\"."),
    click.option("--baud", metavar="BIT/S", type=click.IntRange(min=1), default=115_200,
                 show_default=True, help="Of that port."),
    _JSON,
)  # fmt: skip


@devices.command("scan")
@_ANY
@click.option("--listen", "listen_s", metavar="S", type=click.FloatRange(min=0.0), default=1.1,
              show_default=True, help="How long to listen for heartbeats and lines.")  # fmt: skip
def scan(**options: Any) -> None:
    """List who answers: identity, state, heartbeat, mapping.

    Nothing is changed: no SYNC, no state is commanded. With a rig's file, who is missing is named.
    """
    from pmm.cli.devices_scan import DeviceScanOptions, run

    run(DeviceScanOptions(**options))


@devices.command("read")
@_ANY
@click.option("--once", is_flag=True, help="Read once and end, in place of a live table.")
@click.option("--seconds", type=click.FloatRange(min=0.0), help="End after so long.")
def read(**options: Any) -> None:
    """Show what the devices read, live. Nothing gets power.

    A bus alone is read by SDO: what the nodes have mapped to their process data.
    """
    from pmm.cli.devices_read import DeviceReadOptions, run

    run(DeviceReadOptions(**options))


@devices.command("move", context_settings={"ignore_unknown_options": True})
@click.argument("axis", metavar="AXIS")
@click.argument("position", metavar="POSITION")
@_RIG
@_YES
def move(**options: Any) -> None:
    """Move an axis by hand: eccentricity or phase.

    POSITION is in the axis's unit, or as 20mm, 30deg. It is homed first if it is not. Beyond its
    limits, or while the shaft turns, it is refused.

    \b
    pmm devices move eccentricity 20mm rig.toml
    """  # noqa: D301
    from pmm.cli.devices_rig import move as run

    run(**options)


@devices.command("photocell")
@_RIG
@_YES
@click.option("--pulses", type=click.IntRange(min=2), default=5, show_default=True,
              help="End after so many.")  # fmt: skip
@click.option("--within", "within_s", metavar="S", type=click.FloatRange(min=0.1), default=60.0,
              show_default=True, help="Wait so long for them.")  # fmt: skip
@click.option("--turn", "turn_hz", metavar="HZ", type=float,
              help="Let the drive turn the shaft; else turn it by hand.")  # fmt: skip
def photocell(**options: Any) -> None:
    """Test the photocell: pulses, intervals, missing and extra ones."""
    from pmm.cli.devices_rig import photocell as run

    run(**options)


@devices.command("gauges")
@_RIG
@click.option("--channel", "channels", metavar="NAME", multiple=True,
              help="Only this gauge; repeatable.")  # fmt: skip
@click.option("--within", "within_s", metavar="S", type=click.FloatRange(min=1.0), default=30.0,
              show_default=True, help="Wait so long for each push.")  # fmt: skip
def gauges(**options: Any) -> None:
    """Push test: push each gauge as you are asked to; swapped cables and wrong signs are refused.

    You are asked for one gauge after the other; nothing has to be typed, the push itself is seen.
    """
    from pmm.cli.devices_rig import gauges as run

    run(**options)


@devices.command("ports")
@_JSON
def ports(as_json: bool) -> None:
    """List this machine's serial ports, with the names that stay the same when plugged anew."""
    from pmm.cli.devices_scan import print_ports

    print_ports(as_json=as_json)
