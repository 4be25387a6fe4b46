"""Answers that were given with a case's right effects taken out of the catalogue."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from pmm.gap.scoring.answers import UNKNOWN, Answer
from pmm.gap.scoring.intervals import Figure, share
from pmm.gap.scoring.keys import Truth
from pmm.gap.scoring.right import named

SURE: Final = 0.9
LEAST: Final = 3.0  # sigma that an imitator has to leave to be told from what is there


@dataclass(frozen=True)
class LeftOut:
    """What was said of effects that the catalogue did not have.

    Attributes
    ----------
    unknown
        "Unknown" was said.
    good
        The same, or an effect that leaves less than ``LEAST`` sigma of what is there; in both
        cases with a right stage.
    sure_and_wrong
        Another name was given more than ``SURE``, or the answer failed.
    """

    unknown: Figure
    good: Figure
    stage: Figure
    sure_and_wrong: Figure


def left_out(truths: Sequence[Truth], answers: Mapping[str, Answer]) -> LeftOut | None:
    """Return the figures over the cases with a gap that can be seen; ``None`` without answers."""
    pairs = [
        (answers[truth.case], truth)
        for truth in truths
        if truth.case in answers and truth.verdict == "gap" and truth.snr >= LEAST
    ]
    if not pairs:
        return None
    silent = [a.said == UNKNOWN for a, _ in pairs]
    like = [bool(named(a.said)) and set(named(a.said)) <= imitators(t) for a, t in pairs]
    stage = [_stage(a) in t.stages for a, t in pairs]
    good = [(a or b) and c for a, b, c in zip(silent, like, stage, strict=True)]
    wrong = [
        bool(a.failed) or (bool(named(a.said)) and not b and a.probabilities[a.said] > SURE)
        for (a, _), b in zip(pairs, like, strict=True)
    ]
    figures = [share([float(hit) for hit in hits]) for hits in (silent, good, stage, wrong)]
    one, two, three, four = (figure for figure in figures if figure is not None)
    reached = [(truth.ceiling or {}).get("unknown") for _, truth in pairs]
    return LeftOut(one.beside([r for r in reached if r is not None]), two, three, four)


def imitators(truth: Truth) -> set[str]:
    """Return the effects that these runs cannot tell from what is there, though they are not."""
    return {
        one.name
        for one in truth.imitators
        if truth.snr * math.sqrt(max(1.0 - one.cosine**2, 0.0)) < LEAST
    }


def _stage(answer: Answer) -> str:
    stages = answer.stages
    return min(stages, key=lambda name: (-stages[name], name)) if stages else ""
