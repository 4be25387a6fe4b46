"""What of records and of the catalogue a diagnosis looks at: options that commands share."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.options import with_options

if TYPE_CHECKING:
    from concurrent.futures import Executor

    from pmm.gap.examination import Options


@dataclass(frozen=True)
class CatalogueOptions:
    """The options that choose from the catalogue, by their names on the command line."""

    effects: tuple[str, ...]
    without: tuple[str, ...]

    @property
    def files(self) -> tuple[str, ...]:
        """Files with effects of the user's own."""
        from pmm.gap.own_effects import files_among

        return files_among(self.effects)

    @property
    def read(self) -> list[tuple[str, Path]]:
        """Those files, each with the option that names it."""
        return [("--effects", Path(file)) for file in self.files]

    def check_alone(self, jobs: int | None, scheduler: str | None = None) -> None:
        """Refuse to share work that only this process can do.

        Raises
        ------
        ConfigurationError
            If there are effects of the user's own, and more than this process shall work.
        """
        if self.files and (scheduler is not None or (jobs or 1) > 1):
            shared = "--jobs" if scheduler is None else "--scheduler"
            raise ConfigurationError(
                f"--effects {self.files[0]}: effects of your own are known in this process only; "
                f"leave {shared} out"
            )

    def words(self) -> Iterator[str]:
        """Yield the options as they are typed."""
        for name, values in (("--effects", self.effects), ("--without", self.without)):
            for value in values:
                yield from (name, value)


@dataclass(frozen=True)
class Looks(CatalogueOptions):
    """Those and the options of a campaign's runs."""

    sensors: str | None
    hold_out: tuple[str, ...]

    @property
    def options(self) -> "Options":
        """Return these options as the diagnosis takes them, the sensors' names apart."""
        from pmm.gap.examination import Options

        names = tuple(name.strip() for name in (self.sensors or "").split(",") if name.strip())
        return Options(self.effects, self.without, names, self.hold_out)

    def words(self) -> Iterator[str]:
        """Yield the options as they are typed."""
        yield from super().words()
        if self.sensors:
            yield from ("--sensors", self.sensors)
        for value in self.hold_out:
            yield from ("--hold-out", value)


def _listed(_: click.Context, __: click.Parameter, texts: tuple[str, ...]) -> tuple[str, ...]:
    """Take names apart that stand between commas."""
    names = [name for text in texts for name in text.split(",")]
    return tuple(name.strip() for name in names if name.strip())


CATALOGUE: Final = with_options(
    click.option(
        "--effects",
        multiple=True,
        callback=_listed,
        metavar="NAME|FILE.py",
        help="Consider this effect only, or those of a Python file of your own too; repeatable.",
    ),
    click.option(
        "--without",
        multiple=True,
        callback=_listed,
        metavar="NAME",
        help="Take an effect out of the catalogue; repeatable.",
    ),
)
LOOKS: Final = with_options(
    CATALOGUE,
    click.option(
        "--sensors",
        metavar="NAME,NAME",
        help='Use these channels only; "photocell" is one.  [default: all]',
    ),
    click.option(
        "--hold-out",
        multiple=True,
        metavar="RUN|KEY=VALUE",
        help="Withhold this run, or those with this frequency (Hz), amplitude (mm), phase (deg), "
        "speed (m/s), drift (deg) or medium (water, air, or rest for zero runs), and predict them; "
        "repeatable.  "
        "[default: each regime in its turn]",
    ),
)

MOST: Final = click.option(
    "--most",
    type=click.IntRange(1, 3),
    default=3,
    show_default=True,
    help="Causes that may act together.",
)


@contextmanager
def engine(
    looks: Looks, jobs: int | None, scheduler: str | None = None
) -> "Iterator[Executor | None]":
    """Open what effects are looked at by: as asked for, or a process for each core.

    ``None``, for this process, with effects of the user's own: no other one knows them.
    """
    from analysis.threads import cores
    from pmm.parallel import open_executor

    looks.check_alone(jobs, scheduler)
    if scheduler is None and (jobs == 1 or looks.files or cores() == 1):
        yield None
        return
    with open_executor(jobs, scheduler) as executor:
        yield executor
