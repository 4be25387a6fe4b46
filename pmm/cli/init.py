"""``pmm init``: first files, from a few questions or from options."""

from collections.abc import Callable
from typing import Any

import click

from pmm.cli.group import NamingGroup

JOBS = ("rig", "campaign", "swing", "bifilar")
_COMMON = (
    click.option("--output", metavar="FOLDER", default=".", show_default=True,
                 help="Where to write."),
    click.option("--force", is_flag=True, help="Write over files that are there."),
    click.option("--yes", is_flag=True, help="Take the defaults, ask nothing."),
    click.option("--name", metavar="TEXT", help="What it is called."),
)  # fmt: skip
_FILES = click.argument("recordings", nargs=-1, metavar="[RECORDING...]")
_PLANE = click.option("--plane", type=click.Choice(("vertical", "horizontal")),
                      help="Heave and pitch, or sway and yaw.")  # fmt: skip


class Jobs(NamingGroup):
    """The group of what can be begun."""

    names = JOBS
    kind = "job"


@click.group(cls=Jobs)
def init() -> None:
    """Write first files: commented, and tried by the very commands that read them.

    What no option tells is asked, each question with a default that works. Nothing is written over
    without --force.

    \b
    pmm init rig --output my-rig            a rig and a plan; simulated until you name a bus
    pmm init campaign run1.csv run2.csv     recordings of another system
    pmm init swing, pmm init bifilar        a pendulum test
    """  # noqa: D301


def _number(name: str, metavar: str, text: str) -> Callable[[Any], Any]:
    return click.option(name, type=float, metavar=metavar, help=text)


def _job(*options: Callable[[Any], Any]) -> Callable[[Callable[..., None]], click.Command]:
    def make(function: Callable[..., None]) -> click.Command:
        for option in reversed((*options, *_COMMON)):
            function = option(function)
        return init.command(function.__name__)(function)

    return make


def _run(job: str, options: dict[str, Any]) -> None:
    from pmm.cli.init_work import run

    run(job, options)


_SPACING = _number("--half-spacing-m", "M", "Of a strut from the midpoint.")
_MASS = _number("--mass-kg", "KG", "Of the model with all below the gauges.")
_INERTIA = _number("--inertia-kg-m2", "KG_M2", "Its inertia about the midpoint.")


@_job(
    _PLANE,
    click.option("--interface", metavar="NAME", help="CAN interface, as python-can names it."),
    click.option("--channel", metavar="NAME", help="Its channel."),
    click.option("--axes", type=click.Choice(("driven", "by-hand")),
                 help="How eccentricity and strut phase are set."),
    _SPACING,
    _MASS,
    _INERTIA,
    _number("--length-m", "M", "Of the model."),
    _number("--beam-m", "M", "Of the model."),
    _number("--draught-m", "M", "Of the model."),
    _number("--tank-length-m", "M", "What the carriage may use."),
    _number("--tank-width-m", "M", "Of the tank."),
    _number("--tank-depth-m", "M", "Of the water."),
    _number("--full-scale-n", "N", "Of a force gauge."),
)  # fmt: skip
def rig(**options: Any) -> None:
    """Write rig.toml and plan.toml; both pass "pmm plan check"."""
    _run("rig", options)


@_job(_FILES, _PLANE, _SPACING, _MASS, _INERTIA)
def campaign(**options: Any) -> None:
    """Write campaign.toml: for recordings, or without any for a simulation.

    Which column is what, and each run's frequency, amplitude and phase, are taken from the
    recordings as far as they show.
    """
    _run("campaign", options)


@_job(
    _FILES,
    _number("--gravity-m-s2", "M_S2", "Gravity at the place."),
    _number("--swing-mass-kg", "KG", "Of the empty swing."),
    _number("--lever-m", "M", "Of the tilting weights."),
)
def swing(**options: Any) -> None:
    """Write swing.toml: the empty swing, from records or stopwatch periods."""
    _run("swing", options)


@_job(
    _FILES,
    _number("--gravity-m-s2", "M_S2", "Gravity at the place."),
    _number("--half-spacing-m", "M", "Of a line from the middle."),
    _number("--line-m", "M", "Length of the lines."),
    _number("--mass-kg", "KG", "Of what hangs on them."),
)
def bifilar(**options: Any) -> None:
    """Write bifilar.toml: yaw on two lines, from records or stopwatch periods."""
    _run("bifilar", options)
