"""What an examination of a campaign comes to, for the goal that pursues its cause."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from analysis.gap.design.proposals import Proposal
from analysis.gap.inference.answers import effects_in
from analysis.gap.judge.confounded import separating_measurements
from pmm.gap.causes import LEAST, SURE, CauseDiagnosis, Suggestion
from pmm.gap.conclusion import EFFECT
from pmm.gap.examination import Examined, Options, examine
from pmm.gap.report import gap_report
from pmm.gap.words import joined
from pmm.sequential.look import KnownCause

_POSSIBLE: Final = 0.02  # probability from which on an answer is still to be told from the others


def diagnosed(folder: Path, options: Options) -> CauseDiagnosis:
    """Examine a campaign and return what that comes to."""
    return found_of(examine(folder, options))


def found_of(examined: Examined, least: float = LEAST) -> CauseDiagnosis:
    """Return what an examination comes to."""
    report, concluded = gap_report(examined), examined.conclusion
    possible = [name for name, share in examined.shares.items() if share > _POSSIBLE]
    effects = sorted({effect for name in possible for effect in effects_in(name)})
    outside = [
        str(proposal)
        for proposal in examined.diagnosis.proposals
        if (proposal.set_point is None or proposal.force_n) and proposal.gain >= least
    ]
    alike = tuple(dict.fromkeys(how for row in report.ranking for how in row.measure))
    measurements = tuple(dict.fromkeys([*alike, *separating_measurements(effects), *outside[:1]]))
    return CauseDiagnosis(
        (*report.said, *(f"{name} is left out: {why}" for name, why in report.left_out.items())),
        concluded.probability,
        _verdict_text(examined, alike),
        tuple(_causes(examined)),
        suggestions(examined.diagnosis.proposals),
        measurements,
    )


def _causes(examined: Examined) -> Iterator[KnownCause]:
    """Yield what is possible, the most probable answer first, with all that is alike there."""
    concluded, answers = examined.conclusion, list(examined.shares.items())
    first = answers[0][0]
    alike = concluded.weighing.alike
    same = tuple(name for effect in effects_in(first) for name in alike.get(effect, ()))
    yield KnownCause(first, concluded.probability, SURE, same)
    for name, share in answers[1:]:
        if share > _POSSIBLE and name not in same:
            yield KnownCause(name, share, SURE)


def suggestions(proposals: Sequence[Proposal]) -> tuple[Suggestion, ...]:
    """Return those of some proposals that a rig can make by itself: no weights, no records."""
    return tuple(
        Suggestion(proposal.set_point, proposal.gain, proposal.between)
        for proposal in proposals
        if proposal.set_point is not None and not proposal.force_n
    )


def _verdict_text(examined: Examined, alike: Sequence[str]) -> str:
    first, concluded = next(iter(examined.shares)), examined.conclusion
    answer = joined(first) if concluded.verdict == EFFECT else f"the answer {first!r}"
    also = f"; within its class tells: {'; or '.join(alike)}" if alike else ""
    return f"the class of {answer} has probability {concluded.probability:.3f}{also}"
