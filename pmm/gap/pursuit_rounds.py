"""The rounds of a pursuit: diagnose, propose, ask, write the plan, take in what was recorded."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from analysis.gap.design.proposals import Proposal
from analysis.gap.inference.answers import effects_in
from analysis.gap.judge.confounded import separating_measurements
from hardware.description.errors import DataError
from pmm.gap.conclusion import EFFECT
from pmm.gap.examination import Examined
from pmm.gap.pursuit import Maker, pursued, take_in, worth_making, write_round
from pmm.gap.report import GapReport, gap_report
from pmm.gap.words import joined

SURE: Final = 0.95
LEAST: Final = 1.0  # log odds that a run is worth making for
_POSSIBLE: Final = 0.02  # probability from which on an answer is still to be told from the others


@dataclass(frozen=True)
class Look:
    """What was known after some runs, and what was proposed then.

    Attributes
    ----------
    answer
        The most probable one, with its probability by itself.
    class_probability
        Of the verdict: of an effect with all that is alike in these runs.
    said
        Three sentences, as of ``pmm gap``.
    proposed
        The next runs in words, each with what it is worth in log odds.
    """

    runs: int
    verdict: str
    answer: str
    probability: float
    class_probability: float
    said: tuple[str, str, str]
    proposed: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Pursuit:
    """How a pursuit went, and how it ended.

    Attributes
    ----------
    ending
        ``"known"``, ``"exhausted"``, ``"waiting"`` or ``"rejected"``.
    remark
        The ending in words, with what to do.
    measures
        Outside the rig's runs, which would tell further.
    """

    looks: tuple[Look, ...]
    ending: str
    remark: str
    measures: tuple[str, ...] = ()


@dataclass(frozen=True)
class Ways:
    """How the work of a pursuit is done.

    Attributes
    ----------
    examine
        Diagnoses the folder as it is.
    approve
        Shows what is known and proposed, and returns whether these runs are to be made.
    make
        Makes the recordings; ``None`` where somebody else does.
    appear
        Waits until recordings may have appeared; returns whether to look again.
    least
        Expected log odds below which a run is not worth making.
    batch
        Runs of a round at most.
    """

    examine: Callable[[], Examined]
    approve: Callable[[Look], bool]
    make: Maker | None
    appear: Callable[[], bool]
    least: float
    batch: int


def pursue(folder: Path, ways: Ways) -> Pursuit:
    """Go on from what the folder holds until one class is known or nothing is left to propose.

    Raises
    ------
    ConfigurationError
        If the folder is no campaign, or a plan of it is wrong.
    DataError
        If the campaign cannot be diagnosed, or no runs can be proposed for it.
    """
    looks: list[Look] = []
    while True:
        missing = _recorded(folder, ways)
        if missing:
            return Pursuit(tuple(looks), "waiting", _waiting(missing))
        there, found = pursued(folder), ways.examine()
        report = gap_report(found)
        known, worth = _look(found, report, ()), found.diagnosis.proposals
        if known.class_probability > SURE:
            alike = tuple(dict.fromkeys(how for one in report.ranking for how in one.measure))
            return Pursuit((*looks, known), "known", _known(known, alike), alike)
        if found.campaign.oscillator is None or not worth:
            raise DataError(
                f"{folder}: no runs can be proposed; [oscillator] in the campaign file, or [rig] "
                "in a case.toml beside it, says what the rig can do"
            )
        chosen = worth_making(there, worth, ways.least)[: ways.batch]
        look = _look(found, report, chosen)
        looks.append(look)
        if not chosen:
            measures = _measures(found, report, ways.least)
            return Pursuit(tuple(looks), "exhausted", _exhausted(ways.least, measures), measures)
        if not ways.approve(look):
            return Pursuit(tuple(looks), "rejected", "Not approved: no plan was written.")
        write_round(there, chosen)


def _recorded(folder: Path, ways: Ways) -> dict[str, str]:
    """Take in what has been recorded of the open runs; return those that are missing."""
    while True:
        there = pursued(folder)
        if there.open and ways.make is not None:
            ways.make(folder, there.campaign, there.open)
        missing = take_in(there)
        if not missing or not ways.appear():
            return missing


def _look(found: Examined, report: GapReport, chosen: Sequence[Proposal]) -> Look:
    concluded = found.conclusion
    answer, share = next(iter(found.shares.items()))
    proposed = tuple((str(one), one.gain) for one in chosen)
    return Look(
        len(report.runs), concluded.verdict, answer, share, concluded.probability, report.said,
        proposed,
    )  # fmt: skip


def _known(look: Look, alike: Sequence[str]) -> str:
    what = joined(look.answer) if look.verdict == EFFECT else f"the answer {look.answer!r}"
    also = f"; within its class tells: {'; or '.join(alike)}" if alike else ""
    return f"Known: the class of {what} has probability {look.class_probability:.3f}{also}."


def _waiting(missing: dict[str, str]) -> str:
    reasons = "; ".join(missing.values())
    return (
        f"Waiting for {', '.join(missing)} ({reasons}): put the recordings into the folder, or "
        "take a run that cannot be made out of its plan, and call again."
    )


def _exhausted(least: float, measures: Sequence[str]) -> str:
    left = f"No run that the rig can make by itself is worth {least:g} log odds"
    if not measures:
        return f"{left}, and no measurement outside it is known that would tell."
    return f"{left}; what would tell: {'; or '.join(measures)}."


def _measures(found: Examined, report: GapReport, least: float) -> tuple[str, ...]:
    """Return the measurements outside the rig's runs that tell, what is confounded first."""
    possible = [name for name, share in found.shares.items() if share > _POSSIBLE]
    effects = sorted({one for name in possible for one in effects_in(name)})
    outside = [
        str(one)
        for one in found.diagnosis.proposals
        if (one.set_point is None or one.force_n) and one.gain >= least
    ]
    alike = [how for one in report.ranking for how in one.measure]
    return tuple(dict.fromkeys([*alike, *separating_measurements(effects), *outside[:1]]))
