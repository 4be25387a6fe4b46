"""An examined campaign as plain rows: the same numbers for the table, the JSON and the page."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from typing import TYPE_CHECKING, Any, Final

from analysis.gap.description import Description
from analysis.gap.diagnose import SHIFTED
from analysis.gap.marginal import Marginal
from analysis.gap.propose import Proposal
from analysis.gap.twins import coefficient_error, separating_measurements
from analysis.gap.verdict import (
    COEFFICIENTS,
    NONE,
    UNKNOWN,
    answer_of,
    coefficient_shift,
    coefficient_twins,
)
from analysis.gap.withheld import Predicted, gap_of, shrinkage
from pmm.gap.answer import effect_rows, next_run
from pmm.gap.cells import Cell, StepRow, heat_cells, remains, step_row
from pmm.gap.coefficients import UNITS, CoefficientRow, coefficient_rows
from pmm.gap.examine import Examined
from pmm.gap.plain import plain_values
from pmm.gap.reported import Convention
from pmm.gap.rows import ControlRow, Ranked, RegimeRow
from pmm.gap.run_notes import odd_note, run_notes
from sim.effects.catalogue import catalogue

if TYPE_CHECKING:
    from analysis.gap.fit import Fit

JSON_SCHEMA: Final = "pmm-gap-1"
_SHOWN: Final = 8  # hypotheses of the ranking
_LEAST: Final = 1e-4
PROPOSED: Final = 5  # runs
_FITS: Final = 2.0  # u: a step below it needs no coefficient to fit


@dataclass(frozen=True, eq=False)
class GapReport:
    """Everything that is shown of a campaign.

    Attributes
    ----------
    verdict
        ``"none"``, ``"coefficients"``, ``"unknown"`` or ``"effect"``.
    sentence
        The verdict for people.
    class_probability
        Of the most probable answer together with all that these runs cannot tell from it.
    convention
        How the derivatives among the coefficients are written.
    effects
        Those that are not out of the question, whatever else is there too.
    remains
        What the best answer leaves, step by step.
    """

    campaign: str
    runs: tuple[str, ...]
    held_out: tuple[str, ...]
    left_out: dict[str, str]
    verdict: str
    sentence: str
    class_probability: float
    notes: tuple[str, ...]
    walk: tuple[StepRow, ...]
    contrasts: tuple[StepRow, ...]
    stages: dict[str, float]
    ranking: tuple[Ranked, ...]
    effects: tuple[Marginal, ...]
    hidden: tuple[str, ...]
    controls: tuple[ControlRow, ...]
    regimes: tuple[RegimeRow, ...]
    convention: Convention
    coefficients: tuple[CoefficientRow, ...]
    remains: tuple[StepRow, ...]
    cells: tuple[Cell, ...]
    description: Description | None
    next_runs: tuple[dict[str, Any], ...]

    def as_dict(self) -> dict[str, Any]:
        """Return it as a document for programs; what is not known is ``null``."""
        found: dict[str, Any] = {"schema": JSON_SCHEMA, **plain_values(asdict(self))}
        return found


def gap_report(examined: Examined) -> GapReport:
    """Put an examined campaign in rows."""
    found = examined.diagnosis
    problem = found.problem
    verdict = _verdict(examined)
    return GapReport(
        examined.campaign.name,
        tuple(run.name for run in problem.simulator.stack.runs),
        examined.held_out,
        dict(examined.left_out),
        verdict,
        _sentence(examined, verdict),
        _class_probability(examined),
        tuple(_notes(examined)),
        tuple(step_row(one) for one in found.walk.steps),
        tuple(step_row(one) for one in found.walk.contrasts),
        dict(sorted(found.stages.items(), key=lambda one: -one[1])),
        tuple(_ranking(examined)),
        examined.effects,
        tuple(sorted(found.weighed.hidden)),
        tuple(_controls(examined)),
        tuple(_regimes(examined)),
        *coefficient_rows(examined, named=verdict == "effect"),
        tuple(remains(examined)),
        tuple(heat_cells(examined)),
        examined.description,
        tuple(_next(one) for one in found.proposals[:PROPOSED]),
    )


def _verdict(examined: Examined) -> str:
    best = next(iter(examined.shares))
    return best if best in (NONE, COEFFICIENTS, UNKNOWN) else "effect"


def _sentence(examined: Examined, verdict: str) -> str:
    found, shares = examined.diagnosis, examined.shares
    if verdict == NONE:
        moved = any(one.stated > _FITS for one in found.walk.steps)
        said = "no gap beyond u, with the coefficients fitted" if moved else "no gap beyond u"
        return f"{said}, probability {shares[NONE]:.2f}"
    if verdict == COEFFICIENTS:
        return "no effect is missing: the coefficients are not those that the campaign states"
    if verdict == UNKNOWN:
        stage = max(found.stages, key=lambda name: found.stages[name], default="")
        outside = "something that the catalogue does not have"
        if not catalogue().keys() <= examined.catalogue.keys():
            outside = f"something else than the {len(examined.catalogue)} effects considered"
        said = f"{outside}, probability {shares[UNKNOWN]:.2f}"
        near = found.best
        like = "" if near is None else f"; nearest, but not it: {joined(answer_of(near.fit))}"
        return f"{said}; most likely in {stage}{like}"
    share = _class_probability(examined)
    return f"{_in_classes(_alike(examined))} probability {share:.2f}; or whatever has its signature"


def _alike(examined: Examined) -> dict[str, list[str]]:
    """Return each part of the most probable answer with what these runs cannot tell from it."""
    classes = examined.diagnosis.classes
    names = next(iter(examined.shares)).split("+")
    return {name: sorted(other for other, _ in classes.get(name, ())) for name in names}


def _class_probability(examined: Examined) -> float:
    groups = [[name, *others] for name, others in _alike(examined).items()]
    answers = {"+".join(sorted(one)) for one in product(*groups)}
    return sum(examined.shares.get(name, 0.0) for name in answers)


def _in_classes(alike: Mapping[str, Sequence[str]]) -> str:
    """Return an answer as people read it, with what its runs cannot tell from each effect."""
    if not any(alike.values()):
        return f"{' and '.join(alike)};"
    if len(alike) == 1:
        ((name, others),) = alike.items()
        return f"{name} or {', '.join(others)}, which these runs cannot tell from it;"
    said = " and ".join(
        f"{name} (or {', '.join(others)})" if others else name for name, others in alike.items()
    )
    return f"{said}, which these runs cannot tell from what is in brackets;"


def joined(answer: str) -> str:
    """Return an answer as people read it: the effects of a pair with "and" between them."""
    return " and ".join(answer.split("+"))


def _notes(examined: Examined) -> Iterator[str]:
    moved = examined.recentred
    far = sorted(moved.units, key=lambda name: -abs(moved.units[name]))[:3]
    if far:
        said = ", ".join(f"{name} {moved.moved[name]:+.4g}" for name in far)
        yield f"the stated model is far off ({said}); the diagnosis goes on about what fits"
    for name in examined.diagnosis.not_foretold:
        yield (
            f"{joined(name)} explains the runs that it is fitted to, but does not foretell those "
            "that are withheld: what it stands for counts as unknown"
        )
    odd = odd_note(examined)
    if odd is not None:
        yield odd
    yield from run_notes(examined)
    found = examined.diagnosis
    best = found.best
    pulled = coefficient_shift(found.problem, found.problem.residual)
    beyond = [f"{name} {units:+.1f}" for name, units in pulled.items() if abs(units) > SHIFTED]
    if beyond:
        yield f"without an effect these would be off by so many tolerances: {', '.join(beyond)}"
    if found.cause is not None:
        twins = coefficient_twins(found.problem, found.cause, examined.free)
        for name, (off, units) in twins.items():
            how = separating_measurements([coefficient_error(name), *found.cause.names])
            yield (
                f"{name} off by {off:+.4g} {UNITS.get(name, '')} ({abs(units):.3g} tolerances) "
                f"would do the same in these runs as {joined(answer_of(found.cause))}"
                + (f"; to tell them apart: {'; '.join(how)}" if how else "")
            )
    if odd is None and best is not None and found.cause is not None and best.remainder > 0.2:
        yield (
            f"{joined(answer_of(best.fit))} leaves {100.0 * best.remainder:.0f} % of its own size "
            "unexplained: its form is not quite that of the catalogue"
        )


def _ranking(examined: Examined) -> Iterator[Ranked]:
    found = examined.diagnosis
    fits: dict[str, Fit] = {}
    for one in (*found.weighed.singles, *found.weighed.pairs):
        fits.setdefault(answer_of(one.fit), one.fit)
    shares = examined.shares
    ranked = list(shares)
    kept = [
        name for number, name in enumerate(ranked[:_SHOWN]) if number < 3 or shares[name] > _LEAST
    ]
    for name in kept:
        fit = fits.get(name)
        members = found.classes if name == ranked[0] else {}
        alike = {other: left for group in members.values() for other, left in group}
        stage = "" if fit is None else " and ".join(
            dict.fromkeys(one.kind.stage.value for one in fit.candidates)
        )  # fmt: skip
        effects = [] if fit is None else list(effect_rows(fit))
        measure = [
            how
            for own, group in members.items()
            for how in separating_measurements([own, *(other for other, _ in group)])
        ]
        left = examined.judged.by_answer.get(name, math.nan)
        yield Ranked(name, float(shares[name]), left, stage, effects, alike, measure)


def _controls(examined: Examined) -> Iterator[ControlRow]:
    found, judged = examined.diagnosis, examined.judged
    rows: list[tuple[str, Sequence[Predicted]]] = []
    if found.best is not None:
        near = "nearest, but not it: " if found.cause is None else ""
        rows.append((near + joined(answer_of(found.best.fit)), judged.cured))
    if found.rival is not None:
        rows.append((f"second best: {joined(answer_of(found.rival.fit))}", judged.rival))
    rows.append(("free polynomial", judged.free_form))
    for what, after in rows:
        if judged.plain and after:
            one = shrinkage(judged.plain, after)
            certain = len(after) > 1
            low, high = (one.low, one.high) if certain else (math.nan, math.nan)
            yield ControlRow(what, one.before, one.after, one.share, low, high)


def _regimes(examined: Examined) -> Iterator[RegimeRow]:
    judged = examined.judged
    for number, one in enumerate(judged.plain):
        after = [
            gap_of(part[number].left) if part else math.nan
            for part in (judged.cured, judged.rival, judged.free_form)
        ]
        yield RegimeRow(str(one.regime), gap_of(one.left), *after)


def _next(one: Proposal) -> dict[str, Any]:
    return {
        "run": next_run(one),
        "said": str(one),
        "gain_log_odds": one.gain,
        "between": list(one.between),
    }
