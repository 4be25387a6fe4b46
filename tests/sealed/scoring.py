"""The scored board as tables, JSON, a page and a page of the documentation."""

import json
from dataclasses import asdict
from pathlib import Path

from benchmarks.machine import describe
from pmm.cli.gap_checking import print_score
from pmm.cli.screen import messages, output
from pmm.gap.scoring.board import read_board
from pmm.gap.scoring.document import document
from pmm.gap.scoring.markdown import markdown
from pmm.gap.scoring.page import write_page
from pmm.gap.scoring.score import CarryOut, score
from tests.sealed.targets import target_tables, verdicts

INTRO = (
    "Written by `python -m tests.sealed whole` or `score BOARD --docs FILE`; do not edit. "
    "[sealed.md](sealed.md) says what a board is, [sealed-scoring.md](sealed-scoring.md) what each "
    "figure counts: value, 95 % interval, number of cases. Seeds 0 to 99 are for development."
)


def score_board(
    board: Path,
    carry_out: CarryOut | None,
    *,
    json_file: Path | None = None,
    page: Path | None = None,
    docs: Path | None = None,
) -> None:
    """Score a board, print it and write what is asked for.

    Raises
    ------
    ConfigurationError, DataError
        If the board cannot be read, or is not whole.
    """
    found, made_on = score(read_board(board), carry_out), describe()
    print_score(output(), found)
    if json_file is not None:
        table = {
            **document(found),
            "made_on": made_on,
            "targets": [asdict(one) for one in verdicts(found)],
        }
        json_file.write_text(json.dumps(table, indent=1, allow_nan=False) + "\n")
    if page is not None:
        command = f"python -m tests.sealed score {board} --page {page}"
        write_page(found, page, title=f"Sealed board {found.seed}", command=command)
    if docs is not None:
        targets = list(target_tables(found))
        text = markdown(found, made_on, title="The scoreboard", intro=INTRO, first=targets)
        docs.write_text(text)
    messages().print(f"scored: {found.cases} cases, {len(found.rows)} rows")
