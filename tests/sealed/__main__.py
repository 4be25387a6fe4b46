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


@main.command("rows")
@click.argument("board", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--only", multiple=True, help="Names of the rows; all controls and peers if none.")
@click.option("--workers", default=os.cpu_count() or 1, show_default="one per core",
              type=click.IntRange(1))  # fmt: skip
def rows_command(board: Path, only: tuple[str, ...], workers: int) -> None:
    """Answer BOARD by the trivial controls and by those peers that are installed."""
    from tests.sealed.rows import answer_rows

    for line in answer_rows(board, only, workers):
        click.echo(line)


@main.command("leave-out")
@click.argument("board", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--output", required=True, type=click.Path(path_type=Path))
def leave_out_command(board: Path, output: Path) -> None:
    """Write for each case with a named gap the effects to take out of the catalogue."""
    out = {}
    for key in sorted((board / "keys").iterdir()):
        truth = json.loads((key / "truth.json").read_text())
        if truth["verdict"] == "gap" and truth["determinable"]:
            out[key.name] = sorted({name for answer in truth["right"] for name in answer})
    output.write_text(json.dumps(out, indent=1) + "\n")


@main.command("score")
@click.argument("board", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.option("--json", "json_file", type=click.Path(path_type=Path), help="Write it there.")
@click.option("--page", type=click.Path(path_type=Path), help="Write the page there.")
@click.option("--docs", type=click.Path(path_type=Path), help="Write docs/scoreboard.md there.")
@click.option(
    "--carry-out/--no-carry-out",
    default=True,
    show_default=True,
    help="Carry the proposed runs out in the sealed reality.",
)
@click.option("--workers", default=os.cpu_count() or 1, show_default="one per core",
              type=click.IntRange(1))  # fmt: skip
def score_command(
    board: Path,
    json_file: Path | None,
    page: Path | None,
    docs: Path | None,
    carry_out: bool,
    workers: int,
) -> None:
    """Score BOARD, its proposed runs carried out."""
    from tests.sealed.carrying_out import carrier
    from tests.sealed.scoring import score_board

    score_board(board, carrier(board, workers) if carry_out else None,
                json_file=json_file, page=page, docs=docs)  # fmt: skip


if __name__ == "__main__":
    main()
