"""The steps that only worlds have: figures held to a world's limits, printed and as JSON."""

import json
from dataclasses import asdict
from pathlib import Path

from pmm.cli.screen import output
from pmm.configuration import read_toml


def world_of(board: Path) -> str:
    """Return the world of a board's folder."""
    return str(read_toml(board / "board.toml").get("world", "A"))


def held(board: Path, json_file: Path | None) -> None:
    """Hold a board's figures to the limits of its world; print them, and write them.

    Raises
    ------
    DataError
        If the board is not whole.
    """
    from rich.table import Table

    from tests.sealed.scoring.board import read_board
    from tests.sealed.scoring.by_world import by_world

    world = world_of(board)
    found = by_world(read_board(board), world)
    table = Table(title=f"World {world}, SNR from 10", title_justify="left", box=None)
    for name in ("figure", "measured [95 %]", "n", "limit", ""):
        table.add_column(name, overflow="fold")
    for one in found:
        value = "-"
        if one.value is not None:
            value = f"{one.value:.3f} [{one.low:.3f}, {one.high:.3f}]"
        limits = [f"at least {one.at_least:g}" if one.at_least is not None else "",
                  f"at most {one.at_most:g}" if one.at_most is not None else ""]  # fmt: skip
        limit = ", ".join(text for text in limits if text)
        table.add_row(one.what, value, str(one.count), limit, one.word)
    output().print(table)
    if json_file is not None:
        rows = [{**asdict(one), "word": one.word} for one in found]
        text = json.dumps({"schema": "sealed-world-1", "world": world, "figures": rows}, indent=1)
        json_file.write_text(text + "\n", encoding="utf-8")
