"""Answers, as whoever answers writes them. ``docs/sealed.md`` has the entries."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Final, TypeAlias

from pmm.configuration import STRICT_TABLE
from pmm.gap.answer import SCHEMA as ANSWER_SCHEMA
from tests.sealed.scoring.files import checked, read_json
from tests.sealed.scoring.keys import Truth, forces

NONE, COEFFICIENTS, UNKNOWN, FAILED = "none", "coefficients", "unknown", "failed"
ODD_RUN = "odd-run"
VERDICTS = (NONE, COEFFICIENTS, UNKNOWN, ODD_RUN)
CONTROLS: Final = ("after_rival", "after_polynomial")
_ALIKE = 1e-6  # that a sum of probabilities may differ from 1 by


@dataclass(frozen=True)
class Predicted:
    """Harmonics of one channel of a withheld run as an answer foretells them."""

    mean: float
    in_phase: tuple[float, ...]
    quadrature: tuple[float, ...]

    __pydantic_config__ = STRICT_TABLE


Forecast: TypeAlias = Mapping[str, Mapping[str, Predicted]]
"""Withheld runs, and the channels of each, by name."""


@dataclass(frozen=True)
class Interval:
    """A value with its 95 % interval."""

    value: float
    low: float
    high: float

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class Named:
    """An effect that an answer names."""

    name: str
    parameters: Mapping[str, Interval] = field(default_factory=dict)

    __pydantic_config__ = STRICT_TABLE


@dataclass(frozen=True)
class Answer:
    """An answer; entries as in ``docs/sealed.md``.

    Attributes
    ----------
    after_rival, after_polynomial
        As ``after``, with the second best answer and with a free polynomial in place of the best:
        controls, which need not be given.
    failed
        Why there is none, where whoever was asked failed or took too long; else empty.
    seconds
        Processor time that it took; ``None`` where nobody measured it.
    """

    schema: str
    case: str
    probabilities: Mapping[str, float]
    stages: Mapping[str, float]
    classes: tuple[tuple[str, ...], ...] = ()
    effects: tuple[Named, ...] = ()
    before: Forecast = field(default_factory=dict)
    after: Forecast = field(default_factory=dict)
    after_rival: Forecast = field(default_factory=dict)
    after_polynomial: Forecast = field(default_factory=dict)
    shrinkage: Interval = field(default_factory=lambda: Interval(0.0, 0.0, 0.0))
    next_run: Mapping[str, Any] | None = None
    failed: str = ""
    seconds: float | None = None

    __pydantic_config__ = STRICT_TABLE

    @property
    def said(self) -> str:
        """The most probable answer; of equal ones the first in the alphabet."""
        if self.failed:
            return FAILED
        return min(self.probabilities, key=lambda name: (-self.probabilities[name], name))

    @property
    def alarm(self) -> bool:
        """Whether the answer is a gap that coefficients do not account for."""
        return self.said not in (NONE, COEFFICIENTS, FAILED)


def read_answer(path: Path, known: frozenset[str], truth: Truth) -> Answer:
    """Read and check the answer to a case.

    Parameters
    ----------
    known
        Names of all effects that may be named.

    Raises
    ------
    ValueError
        With every error of the file.
    """
    answer = checked(Answer, path, read_json(path, ANSWER_SCHEMA))
    found = list(_faults(answer, known, truth))
    if found:
        raise ValueError("\n".join(f"{path}: {fault}" for fault in found))
    return answer


def _faults(answer: Answer, known: frozenset[str], truth: Truth) -> Iterator[str]:
    if answer.case != truth.case:
        yield f"case is {answer.case!r}, should be {truth.case!r}"
    if not answer.failed:
        yield from _faults_of_given(answer, known, truth)
    elif answer.probabilities:
        yield "failed, and yet there are probabilities: one or the other"


def _faults_of_given(answer: Answer, known: frozenset[str], truth: Truth) -> Iterator[str]:
    yield from _shares("probabilities", answer.probabilities)
    if answer.stages:
        yield from _shares("stages", answer.stages)
    for name in sorted(_names(answer) - known - set(VERDICTS)):
        yield f"effect {name!r} is not known{_nearest(name, known)}"
    for name in answer.probabilities:
        if name.split("+") != sorted(set(name.split("+"))):
            yield f"probabilities.{name}: a pair is two names in alphabetical order"
    yield from _faults_of_forecasts(answer, truth)


def _faults_of_forecasts(answer: Answer, truth: Truth) -> Iterator[str]:
    if bool(answer.before) != bool(answer.after):
        yield "before and after go together: give both, or leave both empty"
    for what in CONTROLS:
        if getattr(answer, what) and not answer.after:
            yield f"{what} stands beside after, which is missing"
    for what in ("before", "after", *CONTROLS):
        yield from _missing(what, getattr(answer, what), truth)


def _shares(what: str, shares: Mapping[str, float]) -> Iterator[str]:
    for name, share in shares.items():
        if not 0.0 <= share <= 1.0:
            yield f"{what}.{name} = {share:g} is no probability"
    total = math.fsum(shares.values())
    if abs(total - 1.0) > _ALIKE:
        yield f"{what} sum to {total:.6g}, should be 1"


def _names(answer: Answer) -> set[str]:
    said = {part for name in answer.probabilities for part in name.split("+")}
    return said | {n for group in answer.classes for n in group} | {e.name for e in answer.effects}


def _nearest(name: str, known: frozenset[str]) -> str:
    near = get_close_matches(name, known, n=1, cutoff=0.5)
    return f"; did you mean {near[0]!r}?" if near else ""


def _missing(what: str, foretold: Forecast, truth: Truth) -> Iterator[str]:
    if not foretold:
        return
    for run, there in truth.held_out.items():
        for channel in forces(there):
            if channel not in foretold.get(run, {}):
                yield f"{what}.{run}.{channel} is missing"
