"""A board scored: printed, as JSON, as a page, and among the scores of the documentation."""

from pathlib import Path

from benchmarks.machine import describe
from pmm.cli.gap_checking import print_score
from pmm.cli.screen import messages, output
from pmm.gap.scoring.board import read_board
from pmm.gap.scoring.page import write_page
from pmm.gap.scoring.score import CarryOut, score
from tests.sealed.scoreboard import write_scoreboard
from tests.sealed.scores import dumped, keep, refuse_another


def score_board(
    board: Path,
    carry_out: CarryOut | None,
    *,
    json_file: Path | None = None,
    page: Path | None = None,
    docs: Path | None = None,
) -> None:
    """Score a board, print it and write what is asked for.

    Parameters
    ----------
    docs
        The documentation's folder, to keep the score among the others there.

    Raises
    ------
    ConfigurationError, DataError
        If the board cannot be read, or is not whole; before anything is scored, if its score was
        to be kept and its seed is one for development or was scored already.
    """
    read = read_board(board)
    if docs is not None:
        refuse_another(docs, read.seed)
    found, made_on = score(read, carry_out), describe()
    print_score(output(), found)
    if json_file is not None:
        json_file.write_text(dumped(found, made_on))
    if page is not None:
        command = f"python -m tests.sealed score {board} --page {page}"
        write_page(found, page, title=f"Sealed board {found.seed}", command=command)
    if docs is not None:
        messages().print(f"kept: {keep(docs, found, made_on)}")
        write_scoreboard(docs)
    messages().print(f"scored: {found.cases} cases, {len(found.rows)} rows")
