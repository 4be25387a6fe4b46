"""An answer in the format of docs/sealed.md, as every control and peer writes it."""

import math
from collections.abc import Mapping
from typing import Any

from sim.effects.catalogue import catalogue

NONE, COEFFICIENTS, UNKNOWN = "none", "coefficients", "unknown"


def sheet(
    case: str,
    probabilities: Mapping[str, float],
    stages: Mapping[str, float],
    foretold: tuple[Mapping[str, Any], Mapping[str, Any]] = ({}, {}),
) -> dict[str, Any]:
    """Return an answer; both kinds of shares are made to sum to 1.

    Parameters
    ----------
    foretold
        ``before`` and ``after``; both empty where nothing is foretold.
    """
    return {
        "schema": "sealed-answer-1",
        "case": case,
        "probabilities": _normal(probabilities),
        "stages": _normal(stages),
        "classes": [],
        "effects": [],
        "before": dict(foretold[0]),
        "after": dict(foretold[1]),
        "shrinkage": {"value": 0.0, "low": 0.0, "high": 0.0},
        "next_run": None,
    }


def _normal(shares: Mapping[str, float]) -> dict[str, float]:
    total = math.fsum(shares.values())
    return {name: share / total for name, share in shares.items() if share > 0.0}


def weighed(costs: Mapping[str, float]) -> dict[str, float]:
    """Return shares that go with ``exp(-cost / 2)``, as those of BIC do; they sum to 1."""
    least = min(costs.values())
    shares = {name: math.exp(-0.5 * min(cost - least, 700.0)) for name, cost in costs.items()}
    total = math.fsum(shares.values())
    return {name: share / total for name, share in shares.items()}


def stages_of(shares: Mapping[str, float]) -> dict[str, float]:
    """Return the stages of what is named, by their shares; empty where next to nothing is."""
    out: dict[str, float] = {}
    for answer, share in shares.items():
        names = [name for name in answer.split("+") if name in catalogue()]
        for name in names:
            stage = catalogue()[name].stage.value
            out[stage] = out.get(stage, 0.0) + share / len(names)
    return out if math.fsum(out.values()) > 1e-6 else {}
