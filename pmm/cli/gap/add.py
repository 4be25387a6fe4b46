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
def add(campaign: str, effect: str | None, jobs: int | None, as_json: bool, **chosen: Any) -> None:
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
    from pmm.gap.appended_tables import Added, stated
    from pmm.gap.load import campaign_of

    looks, folder = Looks(**chosen), Path(campaign)
    path = folder / CAMPAIGN_FILE if folder.is_dir() else folder
    if not path.exists():
        raise ConfigurationError(f"{path}: no such folder or campaign file")
    check_appendable(path)
    if effect is not None:
        _refuse_twice(path, (effect,))
    found = _effects(_examined(looks, path, effect, jobs), effect)
    _refuse_twice(path, [one.name for one in found])
    added = [Added(one.name, stated(one)) for one in found]
    files = [word for one in looks.files for word in ("--effects", one)]
    again = pasted("gap", campaign, *files)
    add_and_say(path, added, campaign_of, again=again, schema=_SCHEMA, as_json=as_json)


def _examined(looks: Looks, path: Path, effect: str | None, jobs: int | None) -> "Examined":
    from dataclasses import replace

    from pmm.cli.screen import doing
    from pmm.gap.examination import examine

    options = looks.options
    if effect is not None:
        options = replace(options, effects=(effect, *looks.files))
    with doing("reading") as told, engine(looks, jobs) as executor:
        return examine(path, options, executor, told)


def _effects(examined: "Examined", effect: str | None) -> "Sequence[Effect]":
    """Return what to add: the named effect as fitted, or the one that was found."""
    from hardware.description.errors import DataError
    from pmm.gap.words import what_is_wrong

    found = examined.diagnosis
    if effect is not None:
        fits = [one for one in found.weighed.singles if one.names == (effect,)]
        if not fits:
            reason = found.weighed.refused.get(effect, "these runs do not show it")
            raise DataError(f"{effect}: cannot be fitted: {reason}")
        return fits[0].effects
    if examined.cause is None:
        raise DataError(
            f"{examined.campaign.name}: {what_is_wrong(examined.conclusion)} So there "
            "is nothing to add; --effect NAME adds one all the same"
        )
    return examined.cause.effects


def _refuse_twice(path: Path, names: "Sequence[str]") -> None:
    from pmm.gap.appended_tables import refuse_twice
    from pmm.gap.load import campaign_of

    refuse_twice(path, [one.name for one in campaign_of(path).effects], names)


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
    added: "Sequence[Added]",
    read: "Callable[[Path], object]",
    *,
    again: str,
    schema: str,
    as_json: bool,
) -> None:
    """Append effects to a file and print what was added.

    Parameters
    ----------
    read
        Reads such a file.
    again
        The command that starts from the new file.
    schema
        Of the JSON document.
    """
    from pmm.cli.screen import show
    from pmm.document.content import Data, Document, Section, Text
    from pmm.gap.appended_tables import append_tables

    kept = append_tables(path, [one.table for one in added], read)
    told = (
        Text([f"added {one.said}" for one in added]),
        Text((f"{path}; as it was: {kept}", again)),
        Data("file", path),
        Data("kept", kept),
        Data("effects", added),
    )
    show(Document("", "added effects", (Section("", told),), schema), as_json=as_json)
