"""Which effects to take out of the catalogue, case by case. It reads keys, and answers nothing."""

import json
from pathlib import Path


def left_out(board: Path, most: int | None = None) -> dict[str, list[str]]:
    """Return for each case with a named gap that can be seen the effects that are right there.

    Parameters
    ----------
    most
        No more cases than that, the first of the board; its order is drawn, so they are any.
    """
    found = {}
    for key in sorted((board / "keys").iterdir()):
        truth = json.loads((key / "truth.json").read_text())
        if truth["verdict"] == "gap" and truth["determinable"]:
            found[key.name] = sorted({name for answer in truth["right"] for name in answer})
    return dict(list(found.items())[:most])
