"""``pmm devices``: look at the devices of a rig one by one, before anything runs by itself."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.group import CommandGroup
from pmm.cli.options import JSON, with_options
from pmm.cli.screen import messages

if TYPE_CHECKING:
    from hardware.bus import BusConfiguration
    from hardware.rig import Rig
    from hardware.rig_configuration import RigConfiguration
    from hardware.serial_port import PortSettings
    from hardware.watch import WatchLimits
    from pmm.devices.device_source import DeviceTables


_LINES = {
    "scan": "List who answers: identity, state, heartbeat, mapping.",
    "read": "Show what the devices read, live.",
    "move": "Move an axis by hand: eccentricity, phase, drift, heel or rudder.",
    "photocell": "Test the photocell: pulses, intervals, missing and extra ones.",
    "gauges": "Push test: push each gauge as you are asked to.",
    "tune": "Find the shaft's speed loop, and propose gains for it.",
    "ports": "List this machine's serial ports.",
}  # of the help


@click.group(
    cls=CommandGroup,
    package="pmm.cli.devices",
    names=_LINES,
    kind="job",
)
def devices() -> None:
    """Scan a bus or a port, read values live, move an axis, test photocell and gauges.

    A job takes the rig's file; "scan" and "read" also a bus or a port alone. Exit status: 0 all is
    right, 1 something is missing or wrong, 2 the request or the file is.

    \b
    pmm devices scan rig.toml
    pmm devices scan --interface socketcan --channel can0 --bitrate 1000000
    pmm devices gauges rig.toml
    """  # noqa: D301


YES = click.option("--yes", is_flag=True, help="Do not ask before anything moves.")
FREE = click.option(
    "--free-running", is_flag=True, help="A simulated rig only: as fast as it goes, nobody asked."
)
RIG = with_options(click.argument("rig", metavar="RIG.toml"), FREE, JSON)
ANY = with_options(
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
    JSON,
)  # fmt: skip


@dataclass(frozen=True)
class Target:
    """What is looked at: a rig, a bus alone or a port alone, by the names of the options."""

    rig: str | None
    interface: str | None
    channel: str
    bitrate: int
    options: tuple[str, ...]
    port: str | None
    baud: int

    def tables(self) -> "DeviceTables | None":
        """Return the rig's file.

        Raises
        ------
        ConfigurationError
            If nothing to look at is named, or two things are.
        """
        places = [place for place in (self.rig, self.interface, self.port) if place]
        if len(places) != 1:
            raise ConfigurationError(
                f"{' and '.join(places) or 'nothing'} to look at: name one of RIG.toml, "
                "--interface (with --channel), --port"
            )
        from pmm.devices.device_source import DeviceTables

        return DeviceTables(Path(self.rig)) if self.rig else None

    def bus(self) -> "BusConfiguration":
        """Return the bus that is named alone."""
        from pmm.devices.device_source import bus_alone

        settings = dict(_option(option) for option in self.options)
        return bus_alone(self.interface or "", self.channel, self.bitrate, settings)

    def port_settings(self) -> "PortSettings":
        """Return the port that is named alone."""
        from hardware.serial_port import PortSettings

        return PortSettings(self.port or "", self.baud)


def _option(text: str) -> tuple[str, int | float | str | bool]:
    name, equals, value = text.partition("=")
    if not equals:
        raise ConfigurationError(f"--option {text!r}: write NAME=VALUE")
    if value in ("true", "false"):
        return name, value == "true"
    for kind in (int, float):
        try:
            return name, kind(value)
        except ValueError:
            continue
    return name, value


@contextmanager
def opened(
    configuration: "RigConfiguration",
    *,
    free_running: bool = False,
    limits: "WatchLimits | None" = None,
) -> "Iterator[Rig]":
    """Open a rig that keeps to the clock, without touching its devices yet.

    Parameters
    ----------
    limits
        Of shaft speed and loads, watched in every cycle; what turns the shaft has them.

    Raises
    ------
    ConfigurationError
        If it is to run free and is not simulated in this process.
    """
    from hardware.pacing import FreeRunning, RealTime
    from hardware.rig import Rig
    from pmm.devices.device_source import SIMULATED

    bus = configuration.bus
    if free_running and (bus is None or bus.interface != SIMULATED):
        raise ConfigurationError(
            f"--free-running is for a simulated rig (interface {SIMULATED!r}); "
            "a real one keeps to the clock"
        )
    period_s = 1.0 / configuration.sample_rate_hz
    pacer = FreeRunning() if free_running else RealTime(period_s, time.monotonic, time.sleep)
    with Rig(configuration, time.monotonic, pacer, _asking(absent=free_running)) as rig:
        if limits is not None:
            rig.limit(limits)
        yield rig


def _asking(*, absent: bool) -> Callable[[str], str | None]:
    """Return what asks a person on the error stream; where nobody answers, a simulated rig acts."""
    from pmm.run.operator import OperatorAnswers

    answers, last_question = OperatorAnswers(sys.stdin), ""

    def ask(question: str) -> str | None:
        nonlocal last_question
        if question != last_question:
            last_question = question
            messages().print(question)
        answer = None if absent else answers(question)
        if answer is not None:
            last_question = ""
        return answer

    return ask


def confirm(question: str, *, yes: bool) -> None:
    """Ask before something moves.

    Raises
    ------
    click.Abort
        If the answer is no, or there is nobody to give one.
    """
    if not yes:
        click.confirm(question, err=True, abort=True)
