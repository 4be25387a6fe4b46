"""``python -m tests.sealed``: makes a board, or carries out a further run for one of its cases."""

import json
import os
from pathlib import Path

import click

from tests.sealed.board import generate


@click.group()
def main() -> None:
    """Sealed data: see docs/sealed.md."""


@main.command("generate")
@click.option("--seed", type=click.IntRange(0, 99), help="A seed for development.")
@click.option("--commit", help="The hash of the commit whose diagnosis is to be scored.")
@click.option("--cases", default=300, show_default=True, type=click.IntRange(0))
@click.option("--nulls", default=300, show_default=True, type=click.IntRange(0))
@click.option("--output", required=True, type=click.Path(path_type=Path))
@click.option("--workers", default=os.cpu_count() or 1, show_default="one per core",
              type=click.IntRange(1))  # fmt: skip
def generate_command(
    seed: int | None, commit: str | None, cases: int, nulls: int, output: Path, workers: int
) -> None:
    """Make a board of sealed cases."""
    if (seed is None) == (commit is None):
        raise click.UsageError("give either --seed (0 to 99, development) or --commit (scored)")
    try:
        number = seed if seed is not None else int(str(commit), 16)
    except ValueError as error:
        raise click.UsageError(f"--commit {commit!r} is no hash in hexadecimal") from error
    with click.progressbar(length=cases + nulls, label="cases") as bar:
        for _name in generate(number, cases, nulls, output, workers):
            bar.update(1)


@main.command("run")
@click.argument("key", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.argument("run", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--output", required=True, type=click.Path(path_type=Path))
def run_command(key: Path, run: Path, output: Path) -> None:
    """Carry out the further RUN (a JSON file) in the reality of the case with this KEY."""
    from tests.sealed.generator.further import carried_out, case_of

    carried_out(case_of(key), json.loads(run.read_text()), output)


if __name__ == "__main__":
    main()
