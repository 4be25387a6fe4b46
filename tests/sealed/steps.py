"""The steps from a seed to a scored board; each keeps what is done and says how far it is."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import click

from hardware.description.errors import DataError, PmmError
from tests.sealed.answering import Asked
from tests.sealed.progress import told

LEAST: Final = 300
"""Cases, and as many nulls, that a kept score is made of."""


def limits_file(docs: Path, seed: int, where: str) -> Path:
    """Return where the figures of a seed that have limits are kept, world by world."""
    folder = docs / "scores" / "worlds"
    folder.mkdir(parents=True, exist_ok=True)
    name = f"{seed:040x}"
    return folder / f"{name[:7]}-{where}.json"


def refuse(seed: int, cases: int, nulls: int, docs: Path, where: str = "A") -> None:
    """Refuse to begin a score that could not be kept.

    Raises
    ------
    click.UsageError
        If the seed was scored already, is the hash of another commit than is checked out (its
        diagnosis would not be the one that the seed names), or the board would be a small one.
    """
    from benchmarks.machine import commit
    from tests.sealed.scores import refuse_another

    name, here = f"{seed:040x}", commit()
    if where != "A" and (there := limits_file(docs, seed, where)).exists():
        raise click.UsageError(f"world {where} of seed {name[:7]} was scored: {there}")
    try:
        if where == "A":
            refuse_another(docs, name)
    except DataError as error:
        raise click.UsageError(str(error)) from None
    if min(cases, nulls) < LEAST:
        raise click.UsageError(
            f"{cases} cases and {nulls} nulls: --commit takes {LEAST} of each or more, and a part "
            "looked at first would no longer be sealed; --seed takes as few as you like"
        )
    if not name.startswith(here):
        raise click.UsageError(
            f"--commit {name[:7]}, but {here} is checked out, and that is what would answer: check "
            "the commit out (a clone or a work tree of it), or take --seed for development"
        )


def generated(
    board: Path, seed: int, cases: int, nulls: int, workers: int, where: str = "A"
) -> None:
    """Make a board of a world.

    Raises
    ------
    click.UsageError
        If the folder holds something else.
    RuntimeError
        With the cases that could not be made; all others are there.
    """
    from tests.sealed.board import generate, jobs_of

    try:
        jobs = jobs_of(seed, cases, nulls, board, where)
    except FileExistsError as error:
        raise click.UsageError(str(error)) from None
    for _name in told("cases made", len(jobs), generate(jobs, workers)):
        pass


def answered(board: Path, workers: int, limit_s: float, scheduler: str | None = None) -> None:
    """Answer a board by the diagnosis, on processes of this computer or on a Dask cluster.

    Raises
    ------
    click.ClickException
        If the cluster cannot do it; the other answering steps say so too.
    """
    from tests.sealed.answering import DIAGNOSIS, still_asked

    _answer("diagnosis", still_asked(board, (DIAGNOSIS,)), workers, limit_s, scheduler)


def others(
    board: Path,
    workers: int,
    limit_s: float,
    only: Sequence[str] = (),
    scheduler: str | None = None,
) -> None:
    """Answer a board by controls and peers.

    Raises
    ------
    click.UsageError
        If a row is not known.
    """
    from tests.sealed.answering import still_asked
    from tests.sealed.rows import known_rows, missing

    strange = sorted(set(only) - set(known_rows()))
    if strange:
        raise click.UsageError(f"no rows {', '.join(strange)}; there are {', '.join(known_rows())}")
    rows = []
    for row in only or known_rows():
        if needs := missing(row):
            click.echo(f"{row}: skipped, {needs} is not installed (extra peers)", err=True)
        else:
            rows.append(row)
    _answer("controls and peers", still_asked(board, rows), workers, limit_s, scheduler)


def left_out_answered(
    board: Path, workers: int, limit_s: float, most: int | None, scheduler: str | None = None
) -> None:
    """Answer a board by the diagnosis with each case's right effects out of the catalogue."""
    from tests.sealed.answering import LEFT_OUT, still_asked
    from tests.sealed.leaving_out import left_out

    asked = still_asked(board, (LEFT_OUT,), left_out(board, most))
    _answer("effects left out", asked, workers, limit_s, scheduler)


def _answer(
    label: str, asked: Sequence[Asked], workers: int, limit_s: float, scheduler: str | None
) -> None:
    from tests.sealed.answering import answers

    with in_words():
        for given in told(label, len(asked), answers(asked, workers, limit_s, scheduler)):
            for row, why in given.failed.items():
                click.echo(f"{given.case}, {row}: failed, {why}", err=True)


def scored(board: Path, docs: Path | None) -> None:
    """Score a board; without a folder of documentation its JSON stays beside it."""
    shown(board, board / "scoreboard.json" if docs is None else None, board / "scoreboard.html",
          docs)  # fmt: skip


def shown(board: Path, json_file: Path | None, page: Path | None, docs: Path | None) -> None:
    """Score a board.

    Raises
    ------
    click.ClickException
        If the board is not whole, or its score cannot be kept.
    """
    from tests.sealed.scored import score_board

    with in_words():
        score_board(board, json_file=json_file, page=page, docs=docs)


def scoreboard(docs: Path) -> None:
    """Write the page of all scores again.

    Raises
    ------
    click.ClickException
        If there are none, or one cannot be read.
    """
    from tests.sealed.scoreboard import write_scoreboard

    with in_words():
        write_scoreboard(docs)


@contextmanager
def in_words() -> Iterator[None]:
    """Let an error of the data end the command with its own words, as ``pmm`` does."""
    try:
        yield
    except PmmError as error:
        raise click.ClickException(str(error)) from None
