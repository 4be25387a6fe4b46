"""The prior odds of the diagnosis on development cases: how good they are, halved, doubled, best.

The cases take half an hour, so they are weighed one by one by ``python -m benchmarks.boards
weighings``; here their answers are weighed again at other odds, which takes no diagnosis.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Final

import numpy as np

from analysis.gap.inference.constants import ODDS
from benchmarks.boards.rows import Line, kept
from benchmarks.boards.weighings import WORLDS, reweighed
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray

_LEAST: Final = 1e-4  # probability below which a right answer costs no more: ln gives 9.2
_SURE: Final = 0.9

Odds = Mapping[str, float]


@dataclass(frozen=True)
class Said:
    """What a case's answers say at some odds.

    Attributes
    ----------
    loss
        Minus the log of the probability of all that is right.
    probability
        Of the most probable answer and of what cannot be told from it.
    is_right
        Whether that answer is.
    """

    verdict: str
    loss: float
    probability: float
    is_right: bool

    @classmethod
    def of(cls, line: Line, odds: Odds) -> "Said":
        """Return it of a line."""
        shares = reweighed(line, odds)
        right = math.fsum(shares[name] for name in line["right"])
        best = max(shares, key=lambda name: shares[name])
        alike = line["alike"].get(best, [best])
        probability = math.fsum(shares.get(name, 0.0) for name in alike)
        return cls(
            line["verdict"], -math.log(max(right, _LEAST)), probability, best in line["right"]
        )


def loss(lines: Sequence[Line], odds: Odds) -> float:
    """Return the mean log loss of all cases."""
    return float(np.mean([Said.of(line, odds).loss for line in lines]))


def fitted(lines: Sequence[Line]) -> dict[str, float]:
    """Return the odds of the least log loss; those of one effect are held, which sets the scale."""
    from scipy.optimize import minimize

    start = asdict(ODDS)
    moved = [name for name in start if name != "single"]

    def odds_at(logs: FloatArray) -> dict[str, float]:
        return start | dict(zip(moved, np.exp(logs).tolist(), strict=True))

    def loss_at(logs: FloatArray) -> float:
        return loss(lines, odds_at(logs))

    found = minimize(
        loss_at,
        np.log([start[name] for name in moved]),
        method="L-BFGS-B",
    )
    return odds_at(found.x)


def counted(lines: Sequence[Line]) -> Outcome:
    """Weigh all clear cases again at the odds as they stand, and at others."""
    clear = [line for line in lines if line["is_clear"]]
    if not clear:
        return Outcome({}, {})
    chosen, best = asdict(ODDS), fitted(clear)
    rows = [_row("as they stand", clear, chosen)]
    for name, value in chosen.items():
        for factor, how in ((0.5, "halved"), (2.0, "doubled")):
            rows.append(_row(f"{name} {how}", clear, chosen | {name: factor * value}))
    values = ", ".join(f"{name} {value:.2g}" for name, value in best.items())
    rows.append(_row("of the least log loss", clear, best))
    measured = {"above_least": loss(clear, chosen) - loss(clear, best), "cases": float(len(clear))}
    return Outcome({"Prior odds": rows}, measured, tuple(_notes(clear, values)))


def _row(what: str, lines: Sequence[Line], odds: Odds) -> Row:
    said = [Said.of(line, odds) for line in lines]
    gaps = [one for one in said if one.verdict != "none"]
    nulls = [one for one in said if one.verdict == "none"]
    sure = [one for one in said if one.probability >= _SURE]
    return {
        "odds": what,
        "log loss": f"{np.mean([one.loss for one in said]):.3f}",
        "gaps named by class": f"{sum(one.is_right for one in gaps)} of {len(gaps)}",
        "nulls right": f"{sum(one.is_right for one in nulls)} of {len(nulls)}",
        "wrong of the sure": f"{sum(not one.is_right for one in sure)} of {len(sure)}",
    }


def _notes(lines: Sequence[Line], best: str) -> Iterator[str]:
    counts = ", ".join(
        f"{sum(line['campaign'] == world for line in lines)} of world {world}" for world in WORLDS
    )
    commits = ", ".join(dict.fromkeys(str(line["commit"]) for line in lines))
    yield (
        f"Cases: {counts}, nulls and gaps from SNR 10 on, of a board that was spent on them; "
        f"answers of commit {commits}, weighed again. A right answer below {_LEAST:g} counts as "
        f"that; sure is {_SURE:g} or more, of no gap too."
    )
    yield f"Of the least log loss: {best}."


def run(quick: bool, report: Report) -> Outcome:
    """Weigh what is there; with ``quick`` a few of it."""
    report("weighing")
    return counted(kept("weighings")[: 20 if quick else None])


BENCHMARK = Benchmark("gap_odds", "Prior odds of the diagnosis on development cases", run)
