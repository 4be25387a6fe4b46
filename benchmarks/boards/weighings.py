"""How probable each answer is in cases that were spent on the prior odds, and which are right."""

import math
from collections.abc import Collection, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

from benchmarks.boards.judged import scratch
from benchmarks.boards.worlds import CASES as BOARD
from benchmarks.boards.worlds import made
from tests.sealed.scoring.answers import UNKNOWN
from tests.sealed.scoring.keys import Truth, read_truth
from tests.sealed.scoring.right import by_class, named

Line = dict[str, Any]

WORLDS: Final = ("A", "B")
CASES: Final = 134  # of each, gaps and nulls together
SPENT: Final = "284e94bef2a25016c8432f9f1cf104a77d351dd7"  # the seed: a board that was looked at
_CLEAR_SNR: Final = 10.0
_LEAST: Final = 1e-6  # probability that is kept: no odds that were weighed are 1e6 times others


def weighed(world: str, index: int) -> Line:
    """Make a case and weigh its answers; of one below SNR 10 only that it is so.

    Returns
    -------
    dict
        ``answers`` with their probabilities at ``odds``; which of them are ``right`` by class;
        ``alike``, for a name those that these runs cannot tell from it by the key; ``count`` and
        ``concealed`` effects.
    """
    with scratch() as folder:
        name = made(world, index, SPENT, BOARD, folder)
        truth = read_truth(folder / "keys" / name / "truth.json")
        line = {"campaign": world, "seed": index, "verdict": truth.verdict}
        if truth.verdict in ("gap", UNKNOWN) and truth.snr < _CLEAR_SNR:
            return {**line, "is_clear": False}
        return {**line, "is_clear": True, **_weighed(folder / "cases" / name, truth)}


def _weighed(case: Path, truth: Truth) -> Line:
    from analysis.gap.inference.constants import ODDS
    from tests.sealed.learning.weighed import weighed_hypotheses

    hypotheses = weighed_hypotheses(case)
    shares = hypotheses.answers.by_answer
    return {
        **kept_of(shares, truth),
        "count": hypotheses.count,
        "concealed": hypotheses.concealed,
        "odds": asdict(ODDS),
    }


def kept_of(shares: Mapping[str, float], truth: Truth) -> Line:
    """Return of a case's answers what is kept."""
    answers = {name: float(f"{share:.6g}") for name, share in shares.items() if share > _LEAST}
    right = by_class(truth)
    effects = {one for name in answers for one in named(name)}
    return {
        "answers": answers,
        "right": [name for name in answers if name in right],
        "alike": _alike(effects, truth),
    }


def _alike(effects: Collection[str], truth: Truth) -> dict[str, list[str]]:
    groups = {name: sorted({name, *truth.classes.get(name, ())} & {*effects}) for name in effects}
    return {name: group for name, group in sorted(groups.items()) if len(group) > 1}


def reweighed(line: Line, odds: Mapping[str, float]) -> dict[str, float]:
    """Return a line's probabilities at other prior odds.

    Parameters
    ----------
    odds
        As the fields of :class:`analysis.gap.inference.constants.Odds`.
    """
    logs = {
        name: math.log(share) + _log_prior(name, line, odds) - _log_prior(name, line, line["odds"])
        for name, share in line["answers"].items()
    }
    most = max(logs.values())
    weights = {name: math.exp(log - most) for name, log in logs.items()}
    total = math.fsum(weights.values())
    return {name: weight / total for name, weight in weights.items()}


def _log_prior(answer: str, line: Line, odds: Mapping[str, float]) -> float:
    """Return the log of an answer's prior probability, but for what no odds change."""
    if answer == "none":
        hidden = line["concealed"] / max(line["count"], 1)
        prior = odds["none"] + odds["single"] * hidden * (1.0 + odds["further"] * hidden)
    elif answer == "unknown":
        prior = odds["unknown"]
    elif answer in ("coefficients", "odd-run"):
        prior = odds["mistake"]
    else:
        prior = odds["single"] * odds["further"] ** (len(answer.split("+")) - 1)
    return math.log(prior)
