"""Templates filled in, tried, and only then put where they belong."""

import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hardware.description.errors import ConfigurationError
from pmm.recorder.campaign_owner import own_campaign
from pmm.toml_text import toml_key, toml_value


def render(template: str, values: Mapping[str, Any]) -> str:
    """Return a template of this package with values put in; a missing one is an error."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=PackageLoader("pmm.start"),
        undefined=StrictUndefined,
        autoescape=False,  # noqa: S701  (TOML, not HTML)
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters |= {"toml": toml_value, "key": toml_key}
    return environment.get_template(template).render(values)


def check_free(folder: Path, names: Sequence[str], *, force: bool) -> None:
    """Refuse to write over files that are there.

    Raises
    ------
    ConfigurationError
        Unless ``force``; it names the files.
    """
    files = [str(folder / name) for name in names if (folder / name).exists()]
    if files and not force:
        raise ConfigurationError(
            f"{', '.join(files)}: exists already; --output to another folder, or --force"
        )


def write_tried(
    folder: Path, files: Mapping[str, str], trial: Callable[[Path], object], *, force: bool
) -> list[Path]:
    """Write files to a folder after a trial of them has passed.

    Parameters
    ----------
    trial
        Reads the files in a folder as they will be read, and raises what is wrong with them.

    Raises
    ------
    ConfigurationError
        If a file is there and ``force`` is not given. Whatever ``trial`` raises is passed on, and
        then nothing is written.
    OwnedElsewhereError
        If another process is writing into the folder.
    """
    check_free(folder, list(files), force=force)
    with TemporaryDirectory() as name:
        tried = Path(name)
        for file, text in files.items():
            (tried / file).write_text(text, encoding="utf-8")
        trial(tried)
        with own_campaign(folder):
            return [Path(shutil.copyfile(tried / file, folder / file)) for file in files]
