"""``pmm gap add-pendulum``: put the causes that were found into a pendulum's simulation."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import click

from pmm.cli.gap.add import add_and_say, check_appendable
from pmm.cli.gap.options import CATALOGUE, MOST, Chosen
from pmm.cli.options import JSON

if TYPE_CHECKING:
    from analysis.gap.pendulum.settle import Settled
    from pmm.gap.pendulum_examination import PendulumOptions

_SCHEMA: Final = "pmm-gap-add-pendulum-1"


@click.command("add-pendulum")
@click.argument("file", metavar="FILE.toml")
@click.argument("causes", nargs=-1, metavar="[EFFECT]...")
@MOST
@CATALOGUE
@JSON
def add_pendulum(
    file: str, causes: tuple[str, ...], most: int, as_json: bool, **chosen: Any
) -> None:
    """Write effects with their fitted parameters into the file of a pendulum or a free decay.

    The next "pmm gap pendulum FILE.toml" starts from them. With EFFECT, that one or those are
    fitted and added; without, what is found. The file as it was is kept beside it as FILE.toml.1
    (.2, ...). Where the cause cannot be told nothing is written. The options that "pmm gap
    pendulum" was given are given here too, so that the same cause is found.

    Exit status: 0 added; 1 no cause is found; 2 the request was wrong.
    """
    from pmm.cli.screen import pasted
    from pmm.gap.appended_tables import Added, refuse_twice
    from pmm.gap.pendulum_examination import PendulumOptions
    from pmm.gap.pendulum_file import read_case

    given, path = Chosen(**chosen), Path(file)
    there = [one.name for one in read_case(path).effects]
    check_appendable(path)
    refuse_twice(path, there, causes)
    after = _settled(path, causes, PendulumOptions(given.effects, given.without, most))
    refuse_twice(path, there, after.best.names)
    added = [Added(one.name, _told(one)) for one in after.best.effects]
    again = pasted(
        "gap", "pendulum", file, *(word for one in given.files for word in ("--effects", one))
    )
    add_and_say(path, added, read_case, again=again, schema=_SCHEMA, as_json=as_json)


def _settled(path: Path, causes: tuple[str, ...], options: "PendulumOptions") -> "Settled":
    """Return the causes to add, fitted."""
    from hardware.description.errors import DataError
    from pmm.cli.screen import doing
    from pmm.gap.pendulum_conclusion import conclusion_of
    from pmm.gap.pendulum_examination import examine_pendulum, fitted_causes
    from pmm.gap.pendulum_words import what_is_wrong

    if causes:
        return fitted_causes(path, causes, options)
    with doing("reading") as shown:
        found = examine_pendulum(path, options, shown).diagnosis
    concluded = conclusion_of(found)
    if not concluded.adds:
        said = what_is_wrong(found, concluded)
        raise DataError(f"{path.stem}: {said} So there is nothing to add")
    return found.settled


def _told(effect: object) -> dict[str, float | str]:
    """Return an effect's parameters; what is left to the record is left out."""
    return {key: value for key, value in asdict(cast("Any", effect)).items() if value != ""}
