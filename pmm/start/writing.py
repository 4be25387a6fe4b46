"""Templates filled in, tried, and only then put where they belong."""

import shutil
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hardware.description.errors import ConfigurationError


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
    environment.filters["toml"] = toml_value
    return environment.get_template(template).render(values)


def toml_value(value: object) -> str:
    """Return a text or number as TOML has it."""
    if isinstance(value, str):
        escaped = value.replace("\\", "\\\\").replace('"', '\\"')
        return f'"{escaped}"'
    return f"{value!r}" if isinstance(value, float) else str(value)


def check_free(folder: Path, names: Sequence[str], *, force: bool) -> None:
    """Refuse to write over files that are there.

    Raises
    ------
    ConfigurationError
        Unless ``force``; it names the files.
    """
    there = [str(folder / name) for name in names if (folder / name).exists()]
    if there and not force:
        raise ConfigurationError(
            f"{', '.join(there)}: exists already; --output to another folder, or --force"
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
    """
    check_free(folder, list(files), force=force)
    with TemporaryDirectory() as name:
        tried = Path(name)
        for file, text in files.items():
            (tried / file).write_text(text, encoding="utf-8")
        trial(tried)
        folder.mkdir(parents=True, exist_ok=True)
        return [Path(shutil.copyfile(tried / file, folder / file)) for file in files]
