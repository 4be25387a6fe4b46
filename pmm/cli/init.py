"""``pmm init``: first files, from a few questions or from options."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.files import check_folder
from pmm.cli.group import CommandGroup
from pmm.cli.screen import messages, pasted, say

if TYPE_CHECKING:
    from pmm.start.questions import StartQuestion

# What a job is followed by; {} stands for the folder.
_NEXT = {
    "rig": (
        ("devices", "scan", "{}/rig.toml"),
        ("plan", "check", "{}/plan.toml"),
        ("run", "{}/plan.toml"),
    ),
    "recordings": (("analyse", "{}"), ("coefficients", "{}")),
    "campaign": (
        ("simulate", "{}/campaign.toml", "--output", "{}/simulated"),
        ("analyse", "{}/simulated"),
    ),
    "swing": (("inertia", "swing", "{}/swing.toml"),),
    "bifilar": (("inertia", "bifilar", "{}/bifilar.toml"),),
    "ship": (("manoeuvre", "{}/ship.toml"),),
    "steering": (("steering", "{}"),),
}
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


@click.group(cls=CommandGroup, kind="job")
def init() -> None:
    """Write first files: commented, and tried by the very commands that read them.

    What no option tells is asked, each question with a default that works. Nothing is written over
    without --force.

    \b
    pmm init rig --output my-rig            a rig and a plan; simulated until you name a bus
    pmm init campaign run1.csv run2.csv     recordings of another system
    pmm init swing, pmm init bifilar        a pendulum test
    pmm init ship                           a free ship, for its manoeuvres
    pmm init steering --output campaign     propeller and rudder of a campaign's model
    """  # noqa: D301


def _number(name: str, metavar: str, text: str) -> Callable[[Any], Any]:
    return click.option(name, type=float, metavar=metavar, help=text)


def _job(*options: Callable[[Any], Any]) -> Callable[[Callable[..., None]], click.Command]:
    def make(function: Callable[..., None]) -> click.Command:
        for option in reversed((*options, *_COMMON)):
            function = option(function)
        return init.command(function.__name__)(function)

    return make


_SPACING = _number("--half-spacing-m", "M", "Of a strut from the midpoint.")
_MASS = _number("--mass-kg", "KG", "Of the model with all below the gauges.")
_INERTIA = _number("--inertia-kg-m2", "KG_M2", "Its inertia about the midpoint.")


@_job(
    _PLANE,
    click.option("--interface", metavar="NAME", help="CAN interface, as python-can names it."),
    click.option("--channel", metavar="NAME", help="Its channel."),
    click.option("--axes", type=click.Choice(("driven", "by-hand", "paths")),
                 help="How eccentricity and strut phase are set; paths: each strut has a drive."),
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
    _write("rig", options)


@_job(_FILES, _PLANE, _SPACING, _MASS, _INERTIA)
def campaign(**options: Any) -> None:
    """Write campaign.toml: for recordings, or without any for a simulation.

    Which column is what, and each run's frequency, amplitude and phase, are taken from the
    recordings as far as they show.
    """
    _write("campaign", options)


@_job(
    _FILES,
    _number("--gravity-m-s2", "M_S2", "Gravity at the place."),
    _number("--swing-mass-kg", "KG", "Of the empty swing."),
    _number("--lever-m", "M", "Of the tilting weights."),
)
def swing(**options: Any) -> None:
    """Write swing.toml: the empty swing, from records or stopwatch periods."""
    _write("swing", options)


@_job(
    _FILES,
    _number("--gravity-m-s2", "M_S2", "Gravity at the place."),
    _number("--half-spacing-m", "M", "Of a line from the middle."),
    _number("--line-m", "M", "Length of the lines."),
    _number("--mass-kg", "KG", "Of what hangs on them."),
)
def bifilar(**options: Any) -> None:
    """Write bifilar.toml: yaw on two lines, from records or stopwatch periods."""
    _write("bifilar", options)


@_job(
    _number("--length-m", "M", "Of the model."),
    _number("--draught-m", "M", "Of the model."),
    _number("--mass-kg", "KG", "Of the model."),
    _number("--inertia-kg-m2", "KG_M2", "About the vertical axis through the derivatives' point."),
    _number("--speed-m-s", "M_S", "Of the approach."),
    _number("--scale", "N", "Ship over model."),
)
def ship(**options: Any) -> None:
    """Write ship.toml: derivatives, propeller and rudder of a free ship."""
    _write("ship", options)


@_job(
    _number("--length-m", "M", "Of the model."),
    _number("--diameter-m", "M", "Of its propeller."),
    _number("--rudder-area-m2", "M2", "Of its rudder."),
    _number("--rudder-height-m", "M", "Of its rudder."),
)
def steering(**options: Any) -> None:
    """Write steering.toml: propeller and rudder, beside a campaign's file."""
    _write("steering", options)


def _write(job: str, options: dict[str, Any]) -> None:
    """Write a job's files and print the commands that come next."""
    from pmm.start.jobs import FILES, StartTask, write
    from pmm.start.questions import answers
    from pmm.start.writing import check_free

    folder = Path(options["output"])
    recordings = tuple(Path(recording) for recording in options.get("recordings", ()))
    check_folder(folder, "--output")
    check_free(folder, FILES[job], force=options["force"])
    job_answers = answers(job, options, _default if options["yes"] else _ask)
    silent = (name for name in job_answers if options["yes"] and options.get(name) is None)
    task = StartTask(job, job_answers, folder, recordings, frozenset(silent))
    outcome = write(task, force=options["force"])
    for path in outcome.paths:
        messages().print(f"written: {path}")
    for note in outcome.notes:
        messages().print(note)
    kind = "recordings" if job == "campaign" and recordings else job
    for words in _NEXT[kind]:
        place = folder.as_posix()
        command = pasted(*(Path(word.format(place)) if "{}" in word else word for word in words))
        say(f"next: {command}")


def _default(question: "StartQuestion") -> str | float:
    return question.default


def _ask(question: "StartQuestion") -> str | float:
    kind: Any = click.Choice(question.choices) if question.choices else type(question.default)
    answer: str | float = click.prompt(question.text, default=question.default, type=kind, err=True)
    return answer
