"""``pmm gap add``: put the effect that was found into the campaign's simulation."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from pmm.cli.gap.options import LOOKS, Looks, engine
from pmm.cli.options import JSON, jobs_option

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from pmm.gap.appended_tables import Added
    from pmm.gap.examination import Examined
    from sim.effects.effect import Effect

_SCHEMA: Final = "pmm-gap-add-1"


@click.command()
@click.argument("campaign", metavar="CAMPAIGN")
@click.option(
    "--effect",
    metavar="NAME",
    help="Fit and add this effect.  [default: the one that is found]",
)
@LOOKS
@jobs_option("one for each core")
@JSON
def add(campaign: str, effect: str | None, jobs: int | None, as_json: bool, **options: Any) -> None:
    """Write an effect with its fitted parameters into the campaign file.

    The next "pmm gap CAMPAIGN" and "pmm simulate" start from it. The file as it was is kept beside
    it as campaign.toml.1 (.2, ...). Where no effect is found nothing is written. The options that
    "pmm gap CAMPAIGN" was given are given here too, so that the same effect is found.

    Exit status: 0 added; 1 no effect is found; 2 the request was wrong.
    """
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from hardware.description.errors import ConfigurationError
    from pmm.campaign.file_names import CAMPAIGN_FILE
    from pmm.cli.screen import pasted
    from pmm.gap.appended_tables import Added, stated_parameters
    from pmm.gap.load import campaign_of

    looks, folder = Looks(**options), Path(campaign)
    path = folder / CAMPAIGN_FILE if folder.is_dir() else folder
    if not path.exists():
        raise ConfigurationError(f"{path}: no such folder or campaign file")
    check_appendable(path)
    if effect is not None:
        _refuse_twice(path, (effect,))
    causes = _effects(_examined(looks, path, effect, jobs), effect)
    _refuse_twice(path, [cause.name for cause in causes])
    additions = [Added(cause.name, stated_parameters(cause)) for cause in causes]
    files = [word for file in looks.files for word in ("--effects", file)]
    command = pasted("gap", campaign, *files)
    add_and_say(path, additions, campaign_of, command=command, schema=_SCHEMA, as_json=as_json)


def _examined(looks: Looks, path: Path, effect: str | None, jobs: int | None) -> "Examined":
    from dataclasses import replace

    from pmm.cli.screen import doing
    from pmm.gap.examination import examine

    options = looks.options
    if effect is not None:
        options = replace(options, effects=(effect, *looks.files))
    with doing("reading") as progress, engine(looks, jobs) as executor:
        return examine(path, options, executor, progress)


def _effects(examination: "Examined", effect: str | None) -> "Sequence[Effect]":
    """Return what to add: the named effect as fitted, or the one that was found."""
    from hardware.description.errors import DataError
    from pmm.gap.words import what_is_wrong

    diagnosis = examination.diagnosis
    if effect is not None:
        fits = [fit for fit in diagnosis.weighed.singles if fit.names == (effect,)]
        if not fits:
            reason = diagnosis.weighed.refused.get(effect, "these runs do not show it")
            raise DataError(f"{effect}: cannot be fitted: {reason}")
        return fits[0].effects
    if examination.cause is None:
        raise DataError(
            f"{examination.campaign.name}: {what_is_wrong(examination.conclusion)} So there "
            "is nothing to add; --effect NAME adds one all the same"
        )
    return examination.cause.effects


def _refuse_twice(path: Path, names: "Sequence[str]") -> None:
    from pmm.gap.appended_tables import refuse_twice
    from pmm.gap.load import campaign_of

    refuse_twice(path, [effect.name for effect in campaign_of(path).effects], names)


def check_appendable(path: Path) -> None:
    """Refuse a file that cannot be written to, before anything is fitted.

    Raises
    ------
    ConfigurationError
        If it cannot be.
    """
    from hardware.description.errors import ConfigurationError

    if not os.access(path, os.W_OK):
        raise ConfigurationError(f"{path}: cannot be written to")


def add_and_say(
    path: Path,
    additions: "Sequence[Added]",
    reader: "Callable[[Path], object]",
    *,
    command: str,
    schema: str,
    as_json: bool,
) -> None:
    """Append effects to a file and print what was added.

    Parameters
    ----------
    reader
        Reads such a file.
    command
        The command that starts from the new file.
    schema
        Of the JSON document.
    """
    from pmm.cli.screen import show
    from pmm.document.content import Data, Document, Section, Text
    from pmm.gap.appended_tables import append_tables

    backup = append_tables(path, [addition.table for addition in additions], reader)
    contents = (
        Text([f"added {addition.text}" for addition in additions]),
        Text((f"{path}; as it was: {backup}", command)),
        Data("file", path),
        Data("kept", backup),
        Data("effects", additions),
    )
    show(Document("", "added effects", (Section("", contents),), schema), as_json=as_json)
