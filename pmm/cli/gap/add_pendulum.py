"""``pmm gap add-pendulum``: put the causes that were found into a pendulum's simulation."""

from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

import click

from pmm.cli.gap.add import add_and_say, check_appendable
from pmm.cli.gap.options import CATALOGUE, MOST, CatalogueOptions
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
    file: str, causes: tuple[str, ...], most: int, as_json: bool, **options: Any
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

    choice, path = CatalogueOptions(**options), Path(file)
    known_names = [effect.name for effect in read_case(path).effects]
    check_appendable(path)
    refuse_twice(path, known_names, causes)
    after = _settled(path, causes, PendulumOptions(choice.effects, choice.without, most))
    refuse_twice(path, known_names, after.best.names)
    additions = [Added(effect.name, _parameters(effect)) for effect in after.best.effects]
    command = pasted(
        "gap",
        "pendulum",
        file,
        *(word for effects_file in choice.files for word in ("--effects", effects_file)),
    )
    add_and_say(path, additions, read_case, command=command, schema=_SCHEMA, as_json=as_json)


def _settled(path: Path, causes: tuple[str, ...], options: "PendulumOptions") -> "Settled":
    """Return the causes to add, fitted."""
    from hardware.description.errors import DataError
    from pmm.cli.screen import doing
    from pmm.gap.pendulum_conclusion import conclusion_of
    from pmm.gap.pendulum_examination import examine_pendulum, fitted_causes
    from pmm.gap.pendulum_words import what_is_wrong

    if causes:
        return fitted_causes(path, causes, options)
    with doing("reading") as progress:
        diagnosis = examine_pendulum(path, options, progress).diagnosis
    conclusion = conclusion_of(diagnosis)
    if not conclusion.adds:
        reason = what_is_wrong(diagnosis, conclusion)
        raise DataError(f"{path.stem}: {reason} So there is nothing to add")
    return diagnosis.settled


def _parameters(effect: object) -> dict[str, float | str]:
    """Return an effect's parameters; what is left to the record is left out."""
    return {key: value for key, value in asdict(cast("Any", effect)).items() if value != ""}
