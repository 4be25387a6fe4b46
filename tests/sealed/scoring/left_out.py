"""Answers that were given with a case's right effects taken out of the catalogue."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Self

from tests.sealed.scoring.answers import UNKNOWN, Answer
from tests.sealed.scoring.intervals import Figure, share
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import named

SURE: Final = 0.9
LEAST: Final = 3.0  # sigma that an imitator has to leave to be told from what is there
SAME: Final = 0.99  # cosine above which these boards call two effects one class


@dataclass(frozen=True)
class Omitted:
    """One effect (or several that were right together) that was left out, in cases."""

    name: str
    cases: int
    unknown: int
    good: int
    sure_and_wrong: int


@dataclass(frozen=True)
class LeftOut:
    """What was said of effects that the catalogue did not have.

    Attributes
    ----------
    unknown
        "Unknown" was said.
    good
        The same, or an effect that the imitation angle justifies (:func:`imitators`); in both
        cases with a right stage.
    sure_and_wrong
        Another name was given more than ``SURE``, or the answer failed.
    by_effect
        The same by what was left out, in alphabetical order.
    """

    unknown: Figure
    good: Figure
    stage: Figure
    sure_and_wrong: Figure
    by_effect: tuple[Omitted, ...] = ()


@dataclass(frozen=True)
class _Said:
    """What one answer said."""

    name: str
    unknown: bool
    good: bool
    stage: bool
    sure_and_wrong: bool

    @classmethod
    def of(cls, answer: Answer, truth: Truth) -> Self:
        names = named(answer.said)
        silent, stage = answer.said == UNKNOWN, _stage(answer) in truth.stages
        like = bool(names) and set(names) <= imitators(truth)
        wrong = bool(names) and not like and answer.probabilities[answer.said] > SURE
        own = "+".join(one.name for one in truth.effects)
        good = (silent or like) and stage
        return cls(own, silent, good, stage, wrong or bool(answer.failed))


def left_out(truths: Sequence[Truth], answers: Mapping[str, Answer]) -> LeftOut | None:
    """Return the figures over the cases with a gap that can be seen; ``None`` without answers."""
    there = [
        truth
        for truth in truths
        if truth.case in answers and truth.verdict == "gap" and truth.snr >= LEAST
    ]
    said = [_Said.of(answers[truth.case], truth) for truth in there]
    unknown, good, stage, wrong = (
        share([float(getattr(one, key)) for one in said])
        for key in ("unknown", "good", "stage", "sure_and_wrong")
    )
    if unknown is None or good is None or stage is None or wrong is None:
        return None
    reached = [(truth.ceiling or {}).get("unknown") for truth in there]
    beside = unknown.beside([one for one in reached if one is not None])
    return LeftOut(beside, good, stage, wrong, tuple(_by_effect(said)))


def _by_effect(said: Sequence[_Said]) -> Iterator[Omitted]:
    for name in sorted({one.name for one in said}):
        own = [one for one in said if one.name == name]
        unknown, good, wrong = (
            sum(getattr(one, key) for one in own) for key in ("unknown", "good", "sure_and_wrong")
        )
        yield Omitted(name, len(own), unknown, good, wrong)


def imitators(truth: Truth) -> set[str]:
    """Return the effects that the imitation angle justifies in place of what is there.

    They leave less than ``LEAST`` sigma of it, or point the same way within what makes a class.
    """
    return {
        one.name
        for one in truth.imitators
        if one.cosine > SAME or truth.snr * math.sqrt(max(1.0 - one.cosine**2, 0.0)) < LEAST
    }


def _stage(answer: Answer) -> str:
    stages = answer.stages
    return min(stages, key=lambda name: (-stages[name], name)) if stages else ""
