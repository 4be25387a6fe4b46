"""Which answers to a case are right, and how far off its probabilities are."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product

from tests.sealed.scoring.answers import COEFFICIENTS, FAILED, NONE, UNKNOWN, VERDICTS, Answer
from tests.sealed.scoring.keys import Truth


def named(answer: str) -> tuple[str, ...]:
    """Return the effects of an answer, in alphabetical order; none for a verdict or a failure."""
    silent = (*VERDICTS, FAILED)
    return () if answer in silent else tuple(sorted(answer.split("+")))


def best_name(answer: Answer) -> str | None:
    """Return the most probable effect or pair, verdicts left aside; of equal ones as in ``said``.

    ``None`` where no effect has a probability above 0, or the answer failed.
    """
    shares = {name: share for name, share in answer.probabilities.items() if named(name)}
    best = min(shares, key=lambda name: (-shares[name], name), default=None)
    # A probability of 0 says no more than an entry that is not there.
    return best if best is not None and shares[best] > 0.0 else None


def exactly(truth: Truth) -> frozenset[str]:
    """Return the answers that the key calls right, written as in an answer."""
    names = {"+".join(sorted(one)) for one in truth.right if one}
    verdicts = {NONE: {NONE}, COEFFICIENTS: {COEFFICIENTS}, UNKNOWN: {UNKNOWN}, "gap": set()}
    return frozenset(names | verdicts[truth.verdict])


def by_class(truth: Truth) -> frozenset[str]:
    """Return the same with every name standing for what these runs cannot tell from it."""
    found = set(exactly(truth))
    for one in truth.right:
        groups = [truth.classes.get(name) or (name,) for name in one]
        found |= {"+".join(sorted(set(names))) for names in product(*groups) if names}
    return frozenset(found)


def stated(answer: Answer) -> tuple[str, ...]:
    """Return what the answer itself says cannot be told from what it names, itself included."""
    names = named(answer.said)
    if len(names) != 1:
        return names
    groups = [group for group in answer.classes if names[0] in group]
    return tuple(sorted({names[0]}.union(*groups)))


def is_stated(answer: Answer, truth: Truth) -> bool:
    """Tell whether the answer, or a single effect that it calls the same, is right."""
    if answer.said in exactly(truth):
        return True
    return len(named(answer.said)) == 1 and bool(exactly(truth) & set(stated(answer)))


def brier(answer: Answer, truth: Truth) -> float:
    """Return the answer's Brier score (1950), 0 to 2: all right answers count as one.

    One that failed counts as sure and wrong.
    """
    if answer.failed:
        return 2.0
    right = by_class(truth)
    sure = sum(p for name, p in answer.probabilities.items() if name in right)
    wrong = sum(p**2 for name, p in answer.probabilities.items() if name not in right)
    return float((1.0 - sure) ** 2 + wrong)


@dataclass(frozen=True)
class Reliability:
    """How often answers of some probability are right."""

    low: float
    high: float
    count: int
    said: float
    right: float


def reliability(
    pairs: Sequence[tuple[Answer, Truth]], edges: Sequence[float] = (0.0, 0.5, 0.7, 0.9, 0.99, 1.01)
) -> tuple[Reliability, ...]:
    """Return, by the probability of the most probable answer, how often it is right."""
    sure = [(a.probabilities[a.said], a.said in by_class(t)) for a, t in pairs if not a.failed]
    found = []
    for low, high in pairwise(edges):
        inside = [one for one in sure if low <= one[0] < high]
        if inside:
            said = sum(p for p, _ in inside) / len(inside)
            hits = sum(hit for _, hit in inside) / len(inside)
            found.append(Reliability(low, min(high, 1.0), len(inside), said, hits))
    return tuple(found)
