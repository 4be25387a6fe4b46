"""``python -m tests.sealed.learning``: rows that learn. docs/sealed.md."""

import os
from pathlib import Path

import click

from tests.sealed.learning.campaigns import LOOKS, made, missing
from tests.sealed.learning.training import examples, keep
from tests.sealed.progress import told
from tests.sealed.scoring.board import DIAGNOSIS
from tests.sealed.steps import in_words

FOLDER = click.Path(file_okay=False, path_type=Path)
BOARD = click.Path(exists=True, file_okay=False, path_type=Path)
PLACE = click.Path(exists=True, path_type=Path)
LOOK = click.option("--look", default="components", show_default=True,
                    type=click.Choice(sorted(LOOKS)), help="What is learnt from.")  # fmt: skip


@click.group()
def main() -> None:
    """Rows of the board that learn: see docs/sealed.md."""


@main.command("campaigns")
@click.option("--output", required=True, type=FOLDER)
@click.option("--count", default=2000, show_default=True, type=click.IntRange(1))
@click.option("--workers", default=os.cpu_count() or 1, show_default="one per core",
              type=click.IntRange(1))  # fmt: skip
@click.option("--kept", type=PLACE, help="Those in this file are not made again.")
def campaigns_command(output: Path, count: int, workers: int, kept: Path | None) -> None:
    """Make training campaigns of worlds A and B; those that are there are kept."""
    there = () if kept is None else [one.index for one in examples(kept)]
    jobs = missing(output, count, there)
    for line in told("campaigns made", len(jobs), made(jobs, workers)):
        if not line.endswith(".json"):
            click.echo(line, err=True)


@main.command("keep")
@click.argument("places", nargs=-1, required=True, type=PLACE)
@click.option("--output", required=True, type=click.Path(dir_okay=False, path_type=Path))
def keep_command(places: tuple[Path, ...], output: Path) -> None:
    """Keep the features of campaigns in PLACES, folders or kept files, as one file."""
    click.echo(f"{output}: {keep(places, output)} campaigns")


@main.command("validate")
@click.argument("place", type=PLACE)
@LOOK
def validate_command(place: Path, look: str) -> None:
    """Say how campaigns in PLACE are told by a classifier of the other half, and by ours."""
    from tests.sealed.learning.validation import validated

    with in_words():
        for line in validated(examples(place), look):
            click.echo(line)


@main.command("boost")
@click.argument("board", type=BOARD)
@click.option("--campaigns", required=True, type=PLACE,
              help="Training campaigns: their folder, or the file they are kept in.")  # fmt: skip
@LOOK
def boost_command(board: Path, campaigns: Path, look: str) -> None:
    """Answer BOARD by gradient boosting on training campaigns: the row boosted-LOOK."""
    from tests.sealed.learning.rows import boosted

    with in_words():
        for line in told("boosted", *boosted(board, campaigns, look)):
            click.echo(line, err=True)


@main.command("calibrate")
@click.argument("board", type=BOARD)
@click.option("--on", "fitted_on", multiple=True, required=True, type=BOARD,
              help="Boards of worlds A and B with keys and answers; several times.")  # fmt: skip
@click.option("--row", default=DIAGNOSIS, show_default=True, help="Whose answers.")
@click.option("--miss", default=0.1, show_default=True, type=click.FloatRange(0.0, 1.0),
              help="Share of cases whose set may miss what is right.")  # fmt: skip
def calibrate_command(board: Path, fitted_on: tuple[Path, ...], row: str, miss: float) -> None:
    """Write BOARD's answers calibrated on others: rows ROW-isotonic and ROW-conformal."""
    from tests.sealed.learning.rows import calibrated

    with in_words():
        for line in calibrated(board, fitted_on, row, miss):
            click.echo(line)


if __name__ == "__main__":
    main()
