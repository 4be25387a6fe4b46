"""A pendulum's diagnosis as a document for programs."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any, Final

from analysis.gap.pendulum.hypothesis import Hypothesis
from analysis.gap.pendulum.verdict import NONE, UNKNOWN, Verdict, told_apart
from pmm.gap.pendulum_conclusion import conclusion_of
from pmm.gap.pendulum_examine import Examined
from pmm.gap.plain import plain_values

SCHEMA: Final = "pmm-gap-pendulum-1"
_SHOWN = 8  # answers
_LEAST = 1e-4  # probability that is worth a row


def document(name: str, examined: Examined, said: Sequence[str]) -> dict[str, Any]:
    """Return everything that was found, as plain numbers and texts; what is not known is null.

    Parameters
    ----------
    said
        The same for people.
    """
    found = examined.diagnosis
    verdict = found.verdict
    told = {
        "schema": SCHEMA,
        "name": name,
        "verdict": conclusion_of(found).verdict,
        "said": list(said),
        "notes": list(examined.notes),
        "best": list(verdict.best),
        "inflation": verdict.inflation,
        "probabilities": {
            "+".join(names) or "none": share
            for names, share in verdict.by_set.items()
            if share > 1e-9
        },
        "classes": verdict.by_class,
        "causes": verdict.by_cause,
        "parameters": parameters(found.settled.best),
        "where": [asdict(one) for one in found.where],
        "laws": [
            {
                "name": law.name,
                "log_ratio": law.log_ratio,
                "withheld_u": list(law.withheld),
                "told_apart": told_apart(found.laws[0], law),
            }
            for law in found.laws
        ],
        "alternatives": [asdict(one) for one in found.alternatives],
        "withheld": [asdict(one) for one in found.regimes],
        "rivals": [list(one.names) for one in found.rivals or ()],
        "next": [{"what": one.what, "gain_ln_evidence": one.gain} for one in found.proposals],
    }
    plain: dict[str, Any] = plain_values(told)
    return plain


def ranking(verdict: Verdict) -> Iterator[tuple[str, float]]:
    """Yield the answers that are not out of the question, the most probable first."""
    for at, (names, share) in enumerate(verdict.by_set.items()):
        if at < _SHOWN and (share > _LEAST or not at):
            yield " and ".join(names) or "no gap", share


def classes(verdict: Verdict) -> Iterator[tuple[str, float]]:
    """Yield classes and single causes that are not out of the question, and both verdicts."""
    for name, share in {**verdict.by_class, **verdict.by_cause}.items():
        if share > _LEAST or name in (NONE, UNKNOWN):
            yield name, share


def parameters(best: Hypothesis) -> dict[str, dict[str, dict[str, float]]]:
    """Return each cause's parameters: value and standard uncertainty (before inflation)."""
    spread = best.posterior.covariance.diagonal() ** 0.5
    found: dict[str, dict[str, dict[str, float]]] = {}
    at = 0
    for one in best.causes:
        rows = found.setdefault(one.name, {})
        for axis in one.axes:
            value = axis.value(float(best.units[at]))
            rows[axis.name] = {"value": value, "uncertainty": axis.deviation * float(spread[at])}
            at += 1
    return found
