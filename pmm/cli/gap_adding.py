"""What both commands do that put effects into a file: append, keep the old one, and say so."""

import json
import os
from collections.abc import Callable, Sequence
from dataclasses import asdict
from pathlib import Path

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.screen import output
from pmm.gap.appending import Added, append_effects


def check_appendable(path: Path) -> None:
    """Refuse a file that cannot be written to, before anything is fitted.

    Raises
    ------
    ConfigurationError
        If it cannot be.
    """
    if not os.access(path, os.W_OK):
        raise ConfigurationError(f"{path}: cannot be written to")


def add_and_say(
    path: Path,
    added: Sequence[Added],
    read: Callable[[Path], object],
    *,
    again: str,
    schema: str | None,
) -> None:
    """Append effects to a file and print what was added.

    Parameters
    ----------
    read
        Reads such a file.
    again
        The command that starts from the new file.
    schema
        Of the JSON document; ``None`` prints a text.
    """
    kept = append_effects(path, added, read)
    if schema is not None:
        rows = [asdict(one) for one in added]
        document = {"schema": schema, "file": str(path), "kept": str(kept), "effects": rows}
        click.echo(json.dumps(document, indent=1, allow_nan=False))
        return
    for one in added:
        output().print(f"added {one.said}", soft_wrap=True)
    output().print(f"{path}; as it was: {kept}", soft_wrap=True)
    output().print(again, soft_wrap=True)
