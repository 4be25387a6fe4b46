"""An examined campaign as plain rows: the same numbers for the table, the JSON and the page."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Final

from analysis.gap.design.proposals import Proposal
from analysis.gap.judge.confounded import coefficient_error, separating_measurements
from analysis.gap.judge.description import Description
from analysis.gap.judge.marginal import Marginal
from analysis.gap.judge.verdict import coefficient_shift, coefficient_twins
from analysis.gap.judge.withheld import Predicted, gap_of, shrinkage
from analysis.gap.locate.walk import FAR, left_by_step
from analysis.gap.search.fit import Fit
from hardware.description.arrays import FloatArray
from pmm.gap.answer import effect_rows, next_run
from pmm.gap.cells import Cell, heat_cells
from pmm.gap.coefficients import UNITS, CoefficientRow, coefficient_rows
from pmm.gap.conclusion import Conclusion
from pmm.gap.examination import Examined
from pmm.gap.hull_report import Convention
from pmm.gap.run_notes import command_notes, noise_notes, odd_note, odd_one, run_notes
from pmm.gap.sizes import HowLarge, how_large, own_sizes
from pmm.gap.steps import StepRow, step_row
from pmm.gap.tables import ControlRow, RankedAnswer, RegimeRow
from pmm.gap.words import Remedies, joined, sentences, something_besides

_SHOWN: Final = 8  # hypotheses of the ranking
_LEAST: Final = 1e-4
PROPOSED: Final = 5  # runs


@dataclass(frozen=True, eq=False)
class GapReport:
    """Everything that is shown of a campaign.

    Attributes
    ----------
    conclusion
        The verdict, the walk along the chain, and what the answer leaves of it.
    said
        Three plain sentences: what is wrong, how large it is, what to do next.
    convention
        How the derivatives among the coefficients are written.
    effects
        Those that are not out of the question, whatever else is there too.
    """

    campaign: str
    runs: tuple[str, ...]
    held_out: tuple[str, ...]
    left_out: dict[str, str]
    conclusion: Conclusion
    said: tuple[str, str, str]
    how_large: HowLarge
    notes: tuple[str, ...]
    contrasts: tuple[StepRow, ...]
    stages: dict[str, float]
    ranking: tuple[RankedAnswer, ...]
    effects: tuple[Marginal, ...]
    hidden: tuple[str, ...]
    controls: tuple[ControlRow, ...]
    regimes: tuple[RegimeRow, ...]
    convention: Convention
    coefficients: tuple[CoefficientRow, ...]
    cells: tuple[Cell, ...]
    description: Description | None
    next_runs: tuple[dict[str, Any], ...]


def gap_report(examined: Examined) -> GapReport:
    """Put an examined campaign in rows."""
    diagnosis, concluded = examined.diagnosis, examined.conclusion
    stack = diagnosis.problem.simulator.stack
    convention, rows = coefficient_rows(examined)
    ranking, odd = tuple(_ranking(examined)), odd_one(examined)
    large = how_large(stack, _difference(examined), concluded.walk, rows)
    sizes = () if examined.cause is None else tuple(own_sizes(examined.cause))
    next_runs = tuple(_next_row(proposal) for proposal in diagnosis.proposals[:PROPOSED])
    measures = tuple(how for row in ranking for how in row.measure)
    run = next_runs[0]["said"] if next_runs else ""
    todo = Remedies(odd, measures, run)
    return GapReport(
        examined.campaign.name,
        tuple(run.name for run in stack.runs),
        examined.held_out,
        dict(examined.left_out),
        concluded,
        sentences(concluded, large, sizes, todo),
        large,
        tuple(_notes(examined, odd)),
        tuple(step_row(contrast) for contrast in diagnosis.walk.contrasts),
        dict(sorted(diagnosis.stages.items(), key=lambda pair: -pair[1])),
        ranking,
        examined.effects,
        diagnosis.weighed.hidden,
        tuple(_controls(examined)),
        tuple(_regimes(examined)),
        convention,
        rows,
        tuple(heat_cells(diagnosis.problem, examined.remainder)),
        examined.description,
        next_runs,
    )


def _difference(examined: Examined) -> FloatArray:
    """Return the difference whose size is told, in u: the effect's own, or what is left."""
    if examined.cause is not None:
        return examined.cause.signature
    return left_by_step(examined.diagnosis.problem, examined.remainder)


def _notes(examined: Examined, odd: str) -> Iterator[str]:
    if odd:
        yield odd_note(odd, examined.diagnosis.answers.odd_runs[odd])
    memory = examined.campaign.memory
    if memory is not None:
        yield f"memory of the water, {memory}"
    yield from run_notes(examined)
    yield from noise_notes(examined)
    yield from command_notes(examined)
    if examined.cause is not None:
        yield from _of_cause(examined, examined.cause)
        return
    pulled = coefficient_shift(examined.diagnosis.problem)
    beyond = [f"{name} {units:+.1f}" for name, units in pulled.items() if abs(units) > FAR]
    if beyond:
        yield f"off by so many tolerances, if no effect is there: {', '.join(beyond)}"


def _of_cause(examined: Examined, cause: Fit) -> Iterator[str]:
    """Yield what else could do what is named, and how much of its form is not the catalogue's."""
    twins = coefficient_twins(examined.diagnosis.problem, cause, examined.free)
    for name, (off, units) in twins.items():
        how = separating_measurements([coefficient_error(name), *cause.names])
        yield (
            f"{name} off by {off:+.4g} {UNITS.get(name, '')} ({abs(units):.3g} tolerances) "
            f"would do the same in these runs as {joined(cause.answer)}"
            + (f"; to tell them apart: {'; '.join(how)}" if how else "")
        )
    yield from something_besides(cause.answer, examined.diagnosis.answers.besides[cause.answer])


def _ranking(examined: Examined) -> Iterator[RankedAnswer]:
    diagnosis = examined.diagnosis
    fits: dict[str, Fit] = {}
    for ranked_fit in diagnosis.weighed.ranked:
        fits.setdefault(ranked_fit.answer, ranked_fit)
    shares = examined.shares
    ranked, best = list(shares), examined.conclusion.weighing.best
    names = [
        name for number, name in enumerate(ranked[:_SHOWN]) if number < 3 or shares[name] > _LEAST
    ]
    for name in names:
        fit = fits.get(name)
        members = diagnosis.classes if name == best else {}
        alike = {twin: sigma for group in members.values() for twin, sigma in group}
        stage = "" if fit is None else " and ".join(
            dict.fromkeys(candidate.stage for candidate in fit.candidates)
        )  # fmt: skip
        effects = [] if fit is None else list(effect_rows(fit))
        measure = [
            how
            for effect, group in members.items()
            for how in separating_measurements([effect, *(twin for twin, _ in group)])
        ]
        withheld_u = examined.judged.by_answer.get(name, math.nan)
        yield RankedAnswer(name, float(shares[name]), withheld_u, stage, effects, alike, measure)


def _controls(examined: Examined) -> Iterator[ControlRow]:
    diagnosis, judged = examined.diagnosis, examined.judged
    rows: list[tuple[str, Sequence[Predicted]]] = []
    if diagnosis.best is not None:
        near = "nearest, but not it: " if examined.cause is None else ""
        rows.append((near + joined(diagnosis.best.answer), judged.cured))
    if diagnosis.rival is not None:
        rows.append((f"second best: {joined(diagnosis.rival.answer)}", judged.rival))
    rows.append(("free polynomial", judged.free_form))
    for answer, after in rows:
        if judged.plain and after:
            change = shrinkage(judged.plain, after)
            certain = len(after) > 1
            low, high = (change.low, change.high) if certain else (math.nan, math.nan)
            yield ControlRow(answer, change.before, change.after, change.share, low, high)


def _regimes(examined: Examined) -> Iterator[RegimeRow]:
    judged = examined.judged
    for number, prediction in enumerate(judged.plain):
        after = [
            gap_of(part[number].remainder) if part else math.nan
            for part in (judged.cured, judged.rival, judged.free_form)
        ]
        yield RegimeRow(str(prediction.regime), gap_of(prediction.remainder), *after)


def _next_row(proposal: Proposal) -> dict[str, Any]:
    return {
        "run": next_run(proposal),
        "said": str(proposal),
        "gain_log_odds": proposal.gain,
        "tank_time_min": proposal.cost_s / 60.0,
        "between": list(proposal.between),
    }
