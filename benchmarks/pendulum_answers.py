"""How bodies that scipy integrates are answered: those with nothing wrong, and those with a cause.

Each cause is diagnosed by the whole catalogue, and by one without it and whatever acts alike.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.random import Generator

from analysis.gap.pendulum.causes import causes_for
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import weigh
from analysis.gap.pendulum.verdict import CAUSE, judge
from benchmarks.outcome import Outcome, Report, Row

_NULLS: Final = 60
_EACH: Final = 10
_SURE: Final = 0.9
RIGHT: Final = (
    "Right is the cause itself or what acts alike; of one that is left out of the catalogue, with "
    "what acts alike, that something unknown is there or the cause cannot be told. Wrong and sure "
    "is any other answer at a probability above 0.9."
)


@dataclass(frozen=True)
class Cause:
    """A cause of many sizes.

    Attributes
    ----------
    field
        What of the body it is.
    low, high
        Sizes between which its logarithm is even.
    alike
        Effects of the catalogue that it may be called.
    out
        Effects that are left out with it.
    """

    field: str
    low: float
    high: float
    alike: tuple[str, ...]
    out: tuple[str, ...] = ()


@dataclass(frozen=True)
class Bodies:
    """Bodies of one kind: what may be wrong with them, and how one is drawn and recorded.

    Attributes
    ----------
    drawn
        Returns the problem of a body within what is known of it, with what is wrong by field, from
        a generator and a seed.
    """

    causes: Mapping[str, Cause]
    drawn: Callable[[Generator, Mapping[str, float], int], PendulumProblem]


def answered(bodies: Bodies, seed: int, note: str, quick: bool, report: Report) -> Outcome:
    """Draw bodies, and ask what is wrong with each."""
    generator = np.random.default_rng(seed)
    report("nothing")
    nulls = [_nulls(bodies, generator, 1 if quick else _NULLS)]
    known: list[Row] = []
    withheld: list[Row] = []
    for name in list(bodies.causes)[: 1 if quick else None]:
        report(name)
        with_it, without = _caused(bodies, name, generator, 1 if quick else _EACH)
        known.append(with_it)
        withheld.append(without)
    measured = {
        "nulls": _share(nulls, "right"),
        "named": _share(known, "right"),
        "sure": _share([*nulls, *known], "wrong and sure"),
        "withheld": _share(withheld, "wrong and sure"),
        "withheld_open": _share(withheld, "right"),
    }
    return Outcome({"Answers": [*nulls, *known, *withheld]}, measured, (note, RIGHT))


def _said(problem: PendulumProblem, without: tuple[str, ...] = ()) -> tuple[str, set[str], float]:
    """Return what is said, the causes that are named, and how sure that is."""
    causes = [one for one in causes_for(problem.trials) if one.name not in without]
    verdict = judge(weigh(problem, causes, most=1))
    return verdict.outcome, set(verdict.best.names), verdict.probability


def _nulls(bodies: Bodies, generator: Generator, count: int) -> Row:
    said = [_said(bodies.drawn(generator, {}, at)) for at in range(count)]
    right = sum(one == "none" for one, *_ in said)
    sure = sum(one != "none" and share > _SURE for one, _, share in said)
    return {"what": "nothing", "drawn": count, "right": right, "wrong and sure": sure}


def _caused(bodies: Bodies, name: str, generator: Generator, count: int) -> tuple[Row, Row]:
    """Return how a cause is answered by the whole catalogue, and by one without it."""
    cause = bodies.causes[name]
    known: Row = {"what": name, "drawn": count, "right": 0, "wrong and sure": 0}
    withheld: Row = {"what": f"{name}, left out", "drawn": count, "right": 0, "wrong and sure": 0}
    for at in range(count):
        size = float(np.exp(generator.uniform(np.log(cause.low), np.log(cause.high))))
        problem = bodies.drawn(generator, {cause.field: size}, 100 + at)
        for row, without in ((known, ()), (withheld, cause.out or cause.alike)):
            said, names, share = _said(problem, without)
            named = said == CAUSE and names <= set(cause.alike) and not without
            open_ = said in ("unknown", "untold")
            row["right"] = int(row["right"]) + (open_ if without else named)
            row["wrong and sure"] = int(row["wrong and sure"]) + (
                share > _SURE and not named and not open_
            )
    return known, withheld


def _share(rows: list[Row], key: str) -> float:
    return sum(int(row[key]) for row in rows) / sum(int(row["drawn"]) for row in rows)
