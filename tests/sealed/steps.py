"""The steps from a seed to a scored board; each keeps what is done and says how far it is."""

from collections.abc import Sequence
from pathlib import Path

import click

from tests.sealed.answering import Asked
from tests.sealed.progress import told


def generated(board: Path, seed: int, cases: int, nulls: int, workers: int) -> None:
    """Make a board.

    Raises
    ------
    click.UsageError
        If the folder holds something else.
    RuntimeError
        With the cases that could not be made; all others are there.
    """
    from tests.sealed.board import generate, jobs_of

    try:
        jobs = jobs_of(seed, cases, nulls, board)
    except FileExistsError as error:
        raise click.UsageError(str(error)) from None
    for _name in told("cases made", len(jobs), generate(jobs, workers)):
        pass


def answered(board: Path, workers: int, limit_s: float) -> None:
    """Answer a board by the diagnosis."""
    from tests.sealed.answering import DIAGNOSIS, still_asked

    _answer("diagnosis", still_asked(board, (DIAGNOSIS,)), workers, limit_s)


def others(board: Path, workers: int, limit_s: float, only: Sequence[str] = ()) -> None:
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
    _answer("controls and peers", still_asked(board, rows), workers, limit_s)


def left_out_answered(board: Path, workers: int, limit_s: float, most: int | None) -> None:
    """Answer a board by the diagnosis with each case's right effects out of the catalogue."""
    from tests.sealed.answering import LEFT_OUT, still_asked
    from tests.sealed.leaving_out import left_out

    asked = still_asked(board, (LEFT_OUT,), left_out(board, most))
    _answer("effects left out", asked, workers, limit_s)


def _answer(label: str, asked: Sequence[Asked], workers: int, limit_s: float) -> None:
    from tests.sealed.answering import answers

    for given in told(label, len(asked), answers(asked, workers, limit_s)):
        for row, why in given.failed.items():
            click.echo(f"{given.case}, {row}: failed, {why}", err=True)


def scored(board: Path, docs: Path, workers: int) -> None:
    """Score a board; write the page and the JSON of the documentation."""
    from tests.sealed.carrying_out import carrier
    from tests.sealed.scoring import score_board

    score_board(board, carrier(board, workers), json_file=docs / "scoreboard.json",
                page=board / "scoreboard.html", docs=docs / "scoreboard.md")  # fmt: skip
