"""What ``pmm gap pendulum`` shows: said once, for the terminal, the page and programs."""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any, Final

from analysis.gap.inference.answers import COEFFICIENTS, NONE, effects_in
from analysis.gap.pendulum.diagnose import PendulumDiagnosis
from analysis.gap.pendulum.laws import DampingLaw
from analysis.gap.pendulum.search import cause_names
from analysis.gap.pendulum.withheld import WithheldPrediction
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.notation import percent, written
from pmm.gap import pendulum_figures as figures
from pmm.gap.pendulum_conclusion import classes, fitted, parameters, ranking
from pmm.gap.pendulum_examination import ExaminedPendulum
from pmm.gap.pendulum_words import sentences

SCHEMA: Final = "pmm-gap-pendulum-1"
RECORD: Final = "record"
"""How the names of the records' figures begin."""
_PROPOSED: Final = 6
_SHARE: Final = percent("z.1f")
_ONE: Final = written(".1f")
_TWO: Final = written(".2f")

_U: Final = "Below, u is the standard uncertainty of a number: a difference of 1 u is noise."
_E: Final = (
    "E is measured minus simulated, u its standard uncertainty, in windows of whole swings: "
    "amplitude (decay), phase (period), mean, third harmonic. E/u is their ratio, root mean "
    "square: 1 is noise alone. As stated, the releases alone are fitted; what is known within "
    "tolerances is fitted too after that."
)
_HEAT: Final = (
    "E/u of each record and kind of observable, window by window: as stated, and with the best "
    "answer. Light is noise."
)
_RANKING: Final = "Answers by probability: sets of causes, something unknown, no gap."
_LAWS: Final = (
    "Each law beside what else the answer holds. One is told from the best if that is 20 times as "
    "probable. ln ratio: the natural logarithm of its probability over the best law's; -3 is a "
    "factor of 20."
)
_REGIMES: Final = (
    "Swings that were not fitted to: the gap in u, and by how much an answer shrinks it."
)
_WITHHELD: Final = "The gap of swings that the fit has not seen, with the answer and a wrong cause."
_SWINGS: Final = "Amplitude and phase, measured and simulated; both simulations are fitted freely."

WHERE: Final = (
    word("where", "kind"),
    number("as stated", "stated", _TWO, "u"),
    number("tolerances fitted", "before", _TWO, "u"),
    number("with the answer", "after", _TWO, "u"),
    *data_only("count"),
)
ALTERNATIVES: Final = (
    word("in place of", "instead_of"),
    word("could be", "name"),
    number("ln ratio", "log_ratio", _ONE),
)
NEXT: Final[tuple[Column[Any], ...]] = (
    Column("next run", lambda proposal: proposal.record, "what"),
    Column(
        "would tell them apart",
        lambda proposal: proposal.gain,
        "gain_ln_evidence",
        lambda ln: _odds(ln),
    ),
)


def document(name: str, examined: ExaminedPendulum) -> Document:
    """Return what is shown of a diagnosis.

    Parameters
    ----------
    name
        What the records are of.
    """
    return Document(name, "measured and simulated", tuple(_sections(name, examined)), SCHEMA)


def _sections(name: str, examined: ExaminedPendulum) -> Iterator[Section]:
    """Yield what there is to show, in the order in which it is read."""
    diagnosis = examined.diagnosis
    yield Section(
        "",
        (
            Text(sentences(diagnosis), "said", strong=True),
            Text((_U,)),
            Notes([Note("note", note) for note in examined.notes], "notes"),
            Data("name", name),
            *_numbers(diagnosis),
        ),
    )
    heat = Figure("heat", _HEAT, partial(figures.heat_map, diagnosis))
    yield Section(
        "Where", (Text((_E,)), heat, Table("Where", WHERE, diagnosis.gap_by_kind, "where"))
    )
    yield Section("Which", tuple(_answer_contents(diagnosis)))
    laws = Table("Laws of damping", _law_columns(diagnosis), diagnosis.laws, "laws")
    yield Section("Laws of damping", (Text((_LAWS,) if diagnosis.laws else ()), laws))
    yield Section("How far", tuple(_how_far(diagnosis)))
    yield Section("Records", tuple(_records(diagnosis)))
    yield _remains(diagnosis)
    yield _next_section(diagnosis)


def _numbers(diagnosis: PendulumDiagnosis) -> Iterator[Data]:
    """Yield what programs alone get."""
    verdict, answers = diagnosis.verdict, diagnosis.weighed.answers
    yield Data("verdict", verdict.outcome)
    yield Data("best", _best_answer(diagnosis))
    yield Data(
        "probabilities", {key: share for key, share in answers.by_answer.items() if share > 1e-9}
    )
    yield Data("besides", answers.besides)
    yield Data("unknown_stages", answers.unknown_stages)
    yield Data("classes", verdict.by_class)
    yield Data("causes", verdict.by_cause)
    yield Data("parameters", parameters(diagnosis.settled.best))
    yield Data("withheld", diagnosis.regimes)
    yield Data("rivals", [cause_names(rival) for rival in diagnosis.rivals or ()])


def _best_answer(diagnosis: PendulumDiagnosis) -> tuple[str, ...]:
    """Return the most probable answer: causes, none, or what it is besides."""
    best = diagnosis.weighed.answers.best
    calm = best in (NONE, COEFFICIENTS)
    return () if calm else effects_in(best) or (best,)


def _answer_contents(diagnosis: PendulumDiagnosis) -> Iterator[Content]:
    sets = {" and ".join(cause_names(fit)): fit for fit in diagnosis.weighed.ranked}
    sets[" and ".join(cause_names(diagnosis.best))] = diagnosis.settled.best
    answers: tuple[Column[tuple[str, float]], ...] = (
        Column("answer", lambda row: row[0]),
        Column(
            "parameters (95 %)",
            lambda row: "; ".join(fitted(sets[row[0]])) if row[0] in sets else "",
        ),
        Column("probability", lambda row: row[1], written=_SHARE, number=True),
    )
    shares: tuple[Column[tuple[str, float]], ...] = (
        Column("class, or cause in any set", lambda row: row[0]),
        answers[-1],
    )
    yield Text(("Answers by their probability.",))
    yield Figure("ranking", _RANKING, partial(figures.ranking_figure, diagnosis))
    yield Table("Answers", answers, tuple(ranking(diagnosis.weighed.answers)))
    yield Table("Classes and causes", shares, tuple(classes(diagnosis.verdict)))
    yield Table("Alternatives", ALTERNATIVES, diagnosis.alternatives, "alternatives")


def _law_columns(diagnosis: PendulumDiagnosis) -> tuple[Column[DampingLaw], ...]:
    def told_apart(law: DampingLaw) -> str:
        return "" if law is diagnosis.laws[0] else "yes" if law.told_apart else "no"

    def gaps(withheld: list[float]) -> str:
        return ", ".join(map(_ONE, withheld))

    return (
        word("law of damping", "name"),
        number("ln ratio", "log_ratio", _ONE),
        Column("withheld gap", lambda law: law.withheld, "withheld_u", gaps, "u", number=True),
        Column("told apart", told_apart, number=True),
        Column(None, lambda law: law.told_apart, "told_apart"),
    )


def _how_far(diagnosis: PendulumDiagnosis) -> Iterator[Content]:
    """Yield, for each withheld regime, what each set of causes leaves of its gap."""
    if diagnosis.regimes:
        yield Text((_REGIMES,))
        yield Figure("withheld", _WITHHELD, partial(figures.withheld_figure, diagnosis))
    for regime in diagnosis.regimes:
        title = f"withheld: {regime.name}"
        columns: tuple[Column[WithheldPrediction], ...] = (
            Column(title, lambda foretold: _answer_name(foretold, diagnosis)),
            Column("gap", lambda foretold: foretold.gap, written=_ONE, unit="u", number=True),
            Column("shrinks by", lambda foretold: foretold.shrinkage, written=_SHARE, number=True),
            Column(
                "95 %",
                lambda foretold: f"{_SHARE(foretold.low)} to {_SHARE(foretold.high)}",
                number=True,
            ),
        )
        yield Table(title, columns, (regime.before, *regime.foretold))


def _answer_name(foretold: WithheldPrediction, diagnosis: PendulumDiagnosis) -> str:
    control = "wrong cause: " if foretold.causes == diagnosis.control and foretold.causes else ""
    return control + (", ".join(foretold.causes) or "no cause")


def _records(diagnosis: PendulumDiagnosis) -> Iterator[Figure]:
    for at, trial in enumerate(diagnosis.problem.trials):
        draw = partial(figures.swings_figure, diagnosis, at)
        yield Figure(f"{RECORD}{at + 1}", f"{trial.name}. {_SWINGS}", draw)


def _remains(diagnosis: PendulumDiagnosis) -> Section:
    columns: tuple[Column[Any], ...] = (
        word("where", "kind"),
        Column("verdict", lambda row: "gap" if row.is_beyond_noise else "no gap"),
        number("E/u", "after", _TWO),
    )
    table = Table("Remainder", columns, diagnosis.gap_by_kind)
    return Section("What remains", (table,))


def _odds(ln_evidence: float) -> str:
    """Return expected evidence in words; past a million to one it is of no more use to count."""
    if ln_evidence < math.log(3.0):
        return "no"
    if ln_evidence > math.log(1e6):
        return "for certain"
    return f"at odds of {math.exp(ln_evidence):.2g} to 1"


def _next_section(diagnosis: PendulumDiagnosis) -> Section:
    lines: tuple[str, ...] = ()
    if diagnosis.proposals and diagnosis.rivals is not None:
        first, second = (" + ".join(cause_names(rival)) for rival in diagnosis.rivals)
        lines = (
            "Records that a further test can make, by the odds at which the right one of two "
            f"answers would then stand at least, whichever is right: {first}, or {second}.",
        )
    runs = Table("Next", NEXT, diagnosis.proposals, "next", most=_PROPOSED)
    return Section("Next", (Text(lines), runs))
