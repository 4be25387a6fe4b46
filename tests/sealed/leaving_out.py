"""Which effects to take out of the catalogue, case by case. It reads keys, and answers nothing."""

import json
from itertools import chain, zip_longest
from pathlib import Path
from typing import Any

import numpy as np


def left_out(board: Path, most: int | None = None) -> dict[str, list[str]]:
    """Return, for cases with one named effect that can be seen, the effects that are right there.

    Parameters
    ----------
    most
        No more cases than that. The seed draws them: every effect of the board once before any of
        them twice, so that each is left out in turn. More cases are fewer ones and others.
    """
    truths = [json.loads(key.read_text()) for key in sorted((board / "keys").glob("*/truth.json"))]
    singles = {
        truth["case"]: truth
        for truth in truths
        if truth["kind"] == "single" and truth["verdict"] == "gap" and truth["determinable"]
    }
    chosen = sorted(_in_turn(singles)[:most])
    return {
        case: sorted({name for answer in singles[case]["right"] for name in answer})
        for case in chosen
    }


def _in_turn(singles: dict[str, Any]) -> list[str]:
    """Return all cases, drawn effect by effect in rounds."""
    if not singles:
        return []
    by_effect: dict[str, list[str]] = {}
    for case, truth in singles.items():
        by_effect.setdefault(truth["effects"][0]["name"], []).append(case)
    seed = int(next(iter(singles.values()))["seed"])
    rng = np.random.default_rng([seed, 0x1EF7])
    drawn = [list(rng.permutation(by_effect[name])) for name in sorted(by_effect)]
    rounds = [[case for case in one if case is not None] for one in zip_longest(*drawn)]
    return [str(case) for case in chain.from_iterable(rng.permutation(one) for one in rounds)]
