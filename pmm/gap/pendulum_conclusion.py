"""What a pendulum's diagnosis comes to: the one value from which every word about it is made."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

from analysis.gap.inference.answers import COEFFICIENTS, NONE, ODD_RUN, UNKNOWN, Answers
from analysis.gap.pendulum.diagnose import PendulumDiagnosis
from analysis.gap.pendulum.remainder import turned_runs
from analysis.gap.pendulum.search import cause_names
from analysis.gap.pendulum.verdict import CAUSE, UNTOLD, Verdict, open_causes
from analysis.gap.search.fit import Fit

_SHOWN: Final = 8  # answers
_LEAST: Final = 1e-4  # probability that is worth a row
_SAID: Final = {NONE: "no gap", COEFFICIENTS: "coefficients", ODD_RUN: "one record alone"}


@dataclass(frozen=True)
class PendulumConclusion:
    """What is said of a record, and what it rests on.

    Attributes
    ----------
    verdict
        ``"none"``, ``"unknown"``, ``"odd-run"``, ``"cause"``, or ``"untold"`` where no answer is
        probable enough.
    names
        The likeliest causes; empty where none has any part in it.
    unknown
        Probability of something that the catalogue does not have.
    odd
        The record that alone is off, where that is the verdict.
    alike_causes
        By cause what these records cannot tell from it, itself first, with their probabilities.
    turned
        Runs under a known force that are half a turn off, which no cause explains.
    """

    verdict: str
    names: tuple[str, ...]
    unknown: float = 0.0
    odd: str = ""
    alike_causes: Mapping[str, Mapping[str, float]] = field(default_factory=dict)
    turned: tuple[str, ...] = ()

    @property
    def adds(self) -> bool:
        """Whether the causes are to be put into the simulation."""
        return self.verdict == CAUSE and not self.turned

    @property
    def strange(self) -> bool:
        """Whether something unknown is the likeliest where nothing can be told."""
        return self.verdict == UNTOLD and self.unknown > 0.5


def conclusion_of(diagnosis: PendulumDiagnosis) -> PendulumConclusion:
    """Return what a diagnosis comes to."""
    answers, verdict = diagnosis.weighed.answers, diagnosis.verdict
    odd = max(answers.odd_runs, key=lambda run: answers.odd_runs[run], default="")
    return PendulumConclusion(
        verdict.outcome,
        cause_names(verdict.best),
        answers.by_answer[UNKNOWN],
        odd if verdict.outcome == ODD_RUN else "",
        open_causes(diagnosis.weighed, verdict),
        turned_runs(diagnosis.problem, diagnosis.settled),
    )


def ranking(answers: Answers) -> Iterator[tuple[str, float]]:
    """Yield the answers that are not out of the question, the most probable first."""
    ranked = sorted(answers.by_answer.items(), key=lambda row: -row[1])
    for at, (answer, share) in enumerate(ranked[:_SHOWN]):
        if share > _LEAST or not at:
            yield _SAID.get(answer, " and ".join(answer.split("+"))), share


def classes(verdict: Verdict) -> Iterator[tuple[str, float]]:
    """Yield classes and single causes that are not out of the question, and both verdicts."""
    for name, share in {**verdict.by_class, **verdict.by_cause}.items():
        if share > _LEAST or name in (NONE, UNKNOWN):
            yield name, share


def parameters(best: Fit) -> dict[str, dict[str, dict[str, float]]]:
    """Return each cause's parameters: value and standard uncertainty."""
    spread = best.posterior.covariance.diagonal() ** 0.5
    causes: dict[str, dict[str, dict[str, float]]] = {}
    for at, axis in enumerate(best.axes):
        rows = causes.setdefault(best.names[best.effect_index[at]], {})
        value = axis.value(float(best.units[at]))
        each = axis.deviation * (abs(value) if axis.is_log else 1.0)
        rows[axis.parameter.name] = {"value": value, "uncertainty": each * float(spread[at])}
    return causes


def fitted(best: Fit) -> Iterator[str]:
    """Yield each parameter with the half of its 95 % interval."""
    for name, values in parameters(best).items():
        for key, estimate in values.items():
            yield f"{name}: {key} = {estimate['value']:.4g} ± {2.0 * estimate['uncertainty']:.2g}"
