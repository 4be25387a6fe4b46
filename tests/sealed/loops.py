"""Sealed loops: a case that starts unsure is told more, run after run, in four ways of choosing.

Whoever chooses by the diagnosis sees the case's folder alone; each run is carried out in the case's
own reality and laid into a copy of it. The oracle is told what is truly there and takes the run
that raises the log odds of the true class most; random and space-filling runs look at nothing.
"""

import math
import shutil
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np

from analysis.gap.design.proposals import Proposal
from hardware.description.errors import PmmError
from hardware.description.setpoint import Medium, SetPoint
from pmm.gap.causes import LEAST, SURE
from pmm.gap.examination import Examined, Options, examine
from pmm.gap.found_cause import suggestions
from tests.sealed.generator.case import Case, first_design, make
from tests.sealed.generator.files import write_open
from tests.sealed.generator.further import added, parsed
from tests.sealed.generator.kinds import DETERMINABLE
from tests.sealed.generator.rig import Run
from tests.sealed.generator.worth import Told, sizes_of
from tests.sealed.scoring.keys import Truth
from tests.sealed.scoring.right import by_class

MOST: Final = 5  # runs that are added
LONGEST: Final = 12  # runs of a campaign to begin with
WAYS: Final = ("ours", "random", "space-filling", "oracle")


@dataclass(frozen=True)
class Stand:
    """What was known after some runs.

    Attributes
    ----------
    truth
        Probability of the true class, as all runs that the rig can do leave it.
    said
        Probability that the diagnosis states of the class that it names.
    right
        Whether what it names is in the true class.
    """

    truth: float
    said: float
    right: bool


@dataclass(frozen=True)
class Loop:
    """What was known of a case after each run, by way of choosing; nothing of what was there."""

    snr: float
    runs: int
    ways: Mapping[str, Sequence[Stand]]


@dataclass(eq=False)
class _Looping:
    """A case under way: what the rig can do, and what each of its runs would tell the oracle."""

    case: Case
    points: tuple[SetPoint, ...]
    told: Mapping[SetPoint, Told]
    right: frozenset[str]
    effects: frozenset[str]
    own: Told
    made: list[SetPoint] = field(default_factory=list)

    @property
    def left(self) -> list[SetPoint]:
        return [one for one in self.points if one not in self.made]


Chooses = Callable[[_Looping, Examined], SetPoint | None]


def looped(seed: int, index: int, where: str, scratch: Path) -> Loop | str:
    """Return what each way came to know of a case; in a word why it is none where it is not.

    Parameters
    ----------
    scratch
        An empty folder.
    """
    if len(first_design(seed, index, where).runs) > LONGEST:
        return "more runs"
    case = make(seed, index, null=False, where=where)
    if len(case.campaign.runs) > LONGEST:
        return "more runs"
    if case.content.verdict != "gap" or case.snr < DETERMINABLE:
        return "no class"
    write_open(case, scratch)
    folder = scratch / case.name
    try:
        first = examine(folder)
    except PmmError as error:
        return f"refused: {error}"
    if first.conclusion.probability > SURE:
        return "sure"
    told = _looping(case, first)
    ways = {name: list(_stands(told, folder, first, name)) for name in WAYS}
    return Loop(case.snr, len(case.campaign.runs), ways)


def _looping(case: Case, first: Examined) -> _Looping:
    """Return a case with what every oscillation of its rig would tell."""
    points = tuple(dict.fromkeys(point_of(first.diagnosis.proposals)))
    sizes, last = sizes_of(case), case.campaign.runs[-1]
    told = {one: Told.by(case, [_run(one, last)], sizes) for one in points}
    own = Told.by(case, case.campaign.runs, sizes)
    every = own
    for one in told.values():
        every = every + one
    truth = Truth(
        case.name, case.content.kind, case.null, case.content.verdict, case.snr, case.right,
        case.stages, every.classes(), {},
    )  # fmt: skip
    right = by_class(truth)
    effects = frozenset(name for answer in right for name in answer.split("+"))
    return _Looping(case, points, told, right, effects, own)


def point_of(proposals: Sequence[Proposal]) -> Iterator[SetPoint]:
    """Yield what the rig can do by itself, in an order that says nothing of its worth."""
    points = [one.set_point for one in proposals if one.set_point is not None and not one.force_n]
    yield from sorted(points, key=repr)


def _run(point: SetPoint, last: Run) -> Run:
    return parsed({name: getattr(point, name) for name in _KEYS}, last)


_KEYS: Final = (
    "frequency_hz", "eccentricity_m", "strut_phase_rad", "carriage_speed_m_s", "medium",
    "drift_rad",
)  # fmt: skip


def _stands(told: _Looping, start: Path, first: Examined, way: str) -> Iterator[Stand]:
    """Yield what is known before the first run and after each one."""
    folder = start.with_name(f"{start.name}-{way}")
    shutil.copytree(start, folder)
    told.made, found, last = [], first, told.case.campaign.runs[-1]
    yield _stand(told, found)
    while len(told.made) < MOST and found.conclusion.probability <= SURE:
        point = _CHOOSES[way](told, found)
        if point is None:
            return
        told.made.append(point)
        last = _run(point, last)
        added(told.case, last, folder, len(told.made))
        found = examine(folder, Options(proposes=way == "ours"))
        yield _stand(told, found)


def _stand(told: _Looping, found: Examined) -> Stand:
    shares = found.shares
    truth = math.fsum(share for name, share in shares.items() if name in told.right)
    return Stand(
        round(truth, 6), round(found.conclusion.probability, 6), next(iter(shares)) in told.right
    )


def _ours(told: _Looping, found: Examined) -> SetPoint | None:
    made = {run.set_point for run in found.campaign.runs}
    worth = (one for one in suggestions(found.diagnosis.proposals) if one.gain >= LEAST)
    return next((one.set_point for one in worth if one.set_point not in made), None)


def _random(told: _Looping, _: Examined) -> SetPoint | None:
    rng = np.random.default_rng([told.case.seed, told.case.index, 6, len(told.made)])
    return told.left[int(rng.integers(len(told.left)))] if told.left else None


def _space_filling(told: _Looping, _: Examined) -> SetPoint | None:
    """Return the run that is farthest from all that were made, each setting over its own span."""
    own = [_setting(run) for run in told.case.campaign.runs]
    made = np.array(own + [_setting(one) for one in told.made])
    every = np.array([_setting(one) for one in told.left])
    if not len(every):
        return None
    span = np.ptp(np.vstack((made, every)), axis=0)
    apart = (every[:, None] - made) / np.where(span > 0.0, span, 1.0)
    return told.left[int(np.argmax(np.linalg.norm(apart, axis=2).min(axis=1)))]


def _setting(one: SetPoint | Run) -> tuple[float, ...]:
    return (
        math.log(one.frequency_hz), math.log(one.eccentricity_m), one.strut_phase_rad,
        one.carriage_speed_m_s, one.drift_rad, float(one.medium == Medium.AIR),
    )  # fmt: skip


def _oracle(told: _Looping, _: Examined) -> SetPoint | None:
    so_far = told.own
    for one in told.made:
        so_far = so_far + told.told[one]
    seed, right = (told.case.seed, told.case.index, 4), set(told.effects)
    worth = {one: (so_far + told.told[one]).log_odds(right, seed) for one in told.left}
    return max(worth, key=lambda one: worth[one], default=None)


_CHOOSES: Final[Mapping[str, Chooses]] = dict(
    zip(WAYS, (_ours, _random, _space_filling, _oracle), strict=True)
)
