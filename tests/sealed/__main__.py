"""``python -m tests.sealed``: makes a board, has it answered, and scores it. docs/sealed.md."""

import json
import os
import re
from pathlib import Path

import click
from click.core import ParameterSource

BOARD = click.argument("board", type=click.Path(exists=True, file_okay=False, path_type=Path))
FILE = click.Path(dir_okay=False, path_type=Path)
WORKERS = click.option("--workers", default=os.cpu_count() or 1, show_default="one per core",
                       type=click.IntRange(1))  # fmt: skip
LIMIT = click.option("--limit", "limit_s", default=300.0, show_default=True,
                     type=click.FloatRange(1.0), help="Seconds that a case may take.")  # fmt: skip
SCHEDULER = click.option("--scheduler", metavar="ADDRESS",
                         help="A Dask scheduler that answers in place of processes.")  # fmt: skip
MOST = click.option("--left-out", "most", type=click.IntRange(0),
                    help="Leave-one-out on no more cases than that.")  # fmt: skip
_OPTIONS = (
    click.option("--seed", type=click.IntRange(0, 99), help="A seed for development."),
    click.option("--commit", help="The hash of the commit whose diagnosis is to be scored."),
    click.option("--cases", default=300, show_default=True, type=click.IntRange(0)),
    click.option("--nulls", default=300, show_default=True, type=click.IntRange(0)),
    click.option(
        "--world",
        "where",
        default="A",
        show_default=True,
        type=click.Choice(("A", "B", "C", "D")),
        help="Set of assumptions.",
    ),
)


def _refuse_beside(scheduler: str | None, *names: str) -> None:
    """Refuse options that mean nothing to a cluster."""
    source = click.get_current_context().get_parameter_source
    for name, option in (("workers", "--workers"), ("limit_s", "--limit")):
        if scheduler and name in names and source(name) is ParameterSource.COMMANDLINE:
            raise click.UsageError(
                f"give --scheduler or {option}, not both: a cluster has its own size and no limit"
            )


@click.group()
def main() -> None:
    """Sealed data: see docs/sealed.md."""


def _number(seed: int | None, commit: str | None) -> int:
    if (seed is None) == (commit is None):
        raise click.UsageError("give either --seed (0 to 99, development) or --commit (scored)")
    if seed is not None:
        return seed
    if not re.fullmatch("[0-9a-f]{40}", str(commit)):
        raise click.UsageError(f"--commit {commit!r} is no whole hash: 40 hexadecimal digits")
    return int(str(commit), 16)


@main.command("generate")
@_OPTIONS[0]
@_OPTIONS[1]
@_OPTIONS[2]
@_OPTIONS[3]
@_OPTIONS[4]
@click.option("--output", required=True, type=click.Path(path_type=Path))
@WORKERS
def generate_command(
    seed: int | None,
    commit: str | None,
    cases: int,
    nulls: int,
    where: str,
    output: Path,
    workers: int,
) -> None:
    """Make a board of sealed cases; cases that are there already are kept."""
    from tests.sealed.steps import generated

    generated(output, _number(seed, commit), cases, nulls, workers, where)


@main.command("run")
@click.argument("key", type=click.Path(exists=True, file_okay=False, path_type=Path))
@click.argument("run", type=click.Path(exists=True, dir_okay=False, path_type=Path))
@click.option("--output", required=True, type=click.Path(path_type=Path))
def run_command(key: Path, run: Path, output: Path) -> None:
    """Carry out the further RUN (a JSON file) in the reality of the case with this KEY."""
    from tests.sealed.generator.further import carried_out, case_of

    carried_out(case_of(key), json.loads(run.read_text()), output)


@main.command("answer")
@BOARD
@LIMIT
@WORKERS
@SCHEDULER
def answer_command(board: Path, limit_s: float, workers: int, scheduler: str | None) -> None:
    """Answer BOARD by the diagnosis; what has an answer keeps it, what fails counts as wrong."""
    from tests.sealed.steps import answered

    _refuse_beside(scheduler, "workers", "limit_s")
    answered(board, workers, limit_s, scheduler)


@main.command("rows")
@BOARD
@click.option("--only", multiple=True, help="Names of the rows; all controls and peers if none.")
@LIMIT
@WORKERS
@SCHEDULER
def rows_command(
    board: Path, only: tuple[str, ...], limit_s: float, workers: int, scheduler: str | None
) -> None:
    """Answer BOARD by the trivial controls and by those peers that are installed."""
    from tests.sealed.steps import others

    _refuse_beside(scheduler, "workers", "limit_s")
    others(board, workers, limit_s, only, scheduler)


@main.command("oracle")
@BOARD
@LIMIT
@WORKERS
@SCHEDULER
def oracle_command(board: Path, limit_s: float, workers: int, scheduler: str | None) -> None:
    """Answer BOARD by the diagnosis told the tolerances that its keys have."""
    from tests.sealed.oracle import answered_as, told
    from tests.sealed.steps import answered

    _refuse_beside(scheduler, "workers", "limit_s")
    output = told(board)
    answered(output, workers, limit_s, scheduler)
    click.echo(f"{answered_as(board, output)} answers of the oracle")


@main.command("leave-out")
@BOARD
@MOST
@LIMIT
@WORKERS
@SCHEDULER
def leave_out_command(
    board: Path, most: int | None, limit_s: float, workers: int, scheduler: str | None
) -> None:
    """Answer BOARD by the diagnosis with each case's right effects out of the catalogue."""
    from tests.sealed.steps import left_out_answered

    _refuse_beside(scheduler, "workers", "limit_s")
    left_out_answered(board, workers, limit_s, most, scheduler)


@main.command("score")
@BOARD
@click.option("--json", "json_file", type=FILE, help="Write it there.")
@click.option("--page", type=FILE, help="Write the page there.")
@click.option("--docs", type=click.Path(exists=True, file_okay=False, path_type=Path),
              help="Keep the score in this folder's scores/, write its scoreboard.md.")  # fmt: skip
def score_command(
    board: Path, json_file: Path | None, page: Path | None, docs: Path | None
) -> None:
    """Score BOARD; without --docs nothing is kept."""
    from tests.sealed.steps import shown

    shown(board, json_file, page, docs)


@main.command("limits")
@BOARD
@click.option("--json", "json_file", type=FILE, help="Write it there.")
def limits_command(board: Path, json_file: Path | None) -> None:
    """Hold BOARD's figures from SNR 10 on to the limits of its world, intervals and n beside."""
    from tests.sealed.steps_of_worlds import held

    held(board, json_file)


@main.command("vary")
@BOARD
@click.option("--cases", default=100, show_default=True, type=click.IntRange(1))
@click.option("--output", required=True, type=click.Path(path_type=Path))
def vary_command(board: Path, cases: int, output: Path) -> None:
    """Write BOARD's first cases thinned, resampled and cut; ``answer`` answers them too."""
    from tests.sealed.variations import varied

    click.echo(f"{sum(1 for _ in varied(board, output, cases))} written to {output / 'cases'}")


@main.command("invariance")
@BOARD
@click.argument("variations", type=click.Path(exists=True, file_okay=False, path_type=Path))
def invariance_command(board: Path, variations: Path) -> None:
    """Tell how often VARIATIONS of BOARD's cases are answered as the cases are."""
    from tests.sealed.variations import agreements

    for one in agreements(board, variations):
        click.echo(f"{one.name}: {one.count} cases, the same class in {one.same_class:.2f}, "
                   f"its probability within 0.1 in {one.near:.2f}")  # fmt: skip


@main.command("recorded")
@click.option("--output", required=True, type=click.Path(path_type=Path))
@click.option("--shared", default="../shared/data", show_default=True,
              type=click.Path(file_okay=False, path_type=Path),
              help="Folder of measured records; left out where it is not.")  # fmt: skip
def recorded_command(output: Path, shared: Path) -> None:
    """Make world E: campaigns that were recorded or came from others, and measured records."""
    from tests.sealed.recorded import recorded

    click.echo(f"{sum(1 for _ in recorded(output, shared.absolute()))} made in {output}")


@main.command("sources")
@click.argument("output", type=click.Path(exists=True, file_okay=False, path_type=Path))
def sources_command(output: Path) -> None:
    """Count by source what is said right of world E: campaigns answered, pendulums asked here."""
    from tests.sealed.recorded import counted

    try:
        sources = counted(output)
    except FileNotFoundError as error:
        raise click.UsageError(
            f"{error.filename} is not there: make world E by 'recorded --output {output}', and "
            f"answer it by 'answer {output}'"
        ) from error
    for one in sources:
        said = "".join(f"; {name}: {what}" for name, what in sorted(one.wrong.items()))
        click.echo(f"{one.source}: {one.right} of {one.count} right{said}")


@main.command("whole")
@_OPTIONS[0]
@_OPTIONS[1]
@_OPTIONS[2]
@_OPTIONS[3]
@_OPTIONS[4]
@click.option("--output", required=True, type=click.Path(path_type=Path), help="The board.")
@click.option("--docs", default="docs", show_default=True,
              type=click.Path(exists=True, file_okay=False, path_type=Path),
              help="Folder of scoreboard.md and scores/; none of them with --seed.")  # fmt: skip
@MOST
@LIMIT
@WORKERS
@SCHEDULER
def whole_command(
    seed: int | None,
    commit: str | None,
    cases: int,
    nulls: int,
    where: str,
    output: Path,
    docs: Path,
    most: int | None,
    limit_s: float,
    workers: int,
    scheduler: str | None,
) -> None:
    """Make a board, answer it by all, and score it; begun again, it goes on where it was.

    A score with --commit is kept in the documentation, once for each world: of other worlds than A
    the figures of ``limits``. With --seed all stays in the board.
    """
    from tests.sealed import steps
    from tests.sealed.steps_of_worlds import held

    _refuse_beside(scheduler, "limit_s")
    number = _number(seed, commit)
    if commit is not None:
        steps.refuse(number, cases, nulls, docs, where)
    steps.generated(output, number, cases, nulls, workers, where)
    steps.answered(output, workers, limit_s, scheduler)
    steps.others(output, workers, limit_s, (), scheduler)
    steps.left_out_answered(output, workers, limit_s, most, scheduler)
    steps.scored(output, docs if commit is not None and where == "A" else None)
    held(output, steps.limits_file(docs, number, where) if commit else output / "limits.json")


@main.command("page")
@click.option("--docs", default="docs", show_default=True,
              type=click.Path(exists=True, file_okay=False, path_type=Path),
              help="Folder of scoreboard.md and scores/.")  # fmt: skip
def page_command(docs: Path) -> None:
    """Write scoreboard.md again, from all scores that were kept."""
    from tests.sealed.steps import scoreboard

    scoreboard(docs)


if __name__ == "__main__":
    main()
