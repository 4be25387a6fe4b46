"""Effects whose parameters have either sign, planted at some sigma with each."""

from collections.abc import Iterator
from dataclasses import fields

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import left_over
from hardware.description.errors import PmmError
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect

_HALVINGS = 30


def signed_kinds() -> dict[str, tuple[str, ...]]:
    """Return the effects with parameters of either sign that are no phases, and these."""
    found = {
        kind.name: tuple(
            one.name
            for one in kind.parameters()
            if one.low == -one.high and not (one.unit == "rad" and one.high > 3.0)
        )
        for kind in catalogue().values()
    }
    return {name: own for name, own in found.items() if own}


def planted(problem: Problem, kind: type[Effect], sigma: float, sign: float) -> Effect | None:
    """Return the effect with its signed parameters at the size that leaves as many sigma.

    ``None`` where even the largest plausible size does not: it passes for free numbers there.
    """
    low, high = 0.0, 1.0
    largest = _sized(problem, kind, sign * high)
    if largest is None or largest[1] < sigma:
        return None
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        found = _sized(problem, kind, sign * middle)
        low, high = (middle, high) if found is None or found[1] < sigma else (low, middle)
    found = _sized(problem, kind, sign * high)
    return None if found is None else found[0]


def _sized(problem: Problem, kind: type[Effect], share: float) -> tuple[Effect, float] | None:
    """Return the effect at a share of its ranges, and its sigma after the free numbers."""
    try:
        effect = kind(**dict(_values(kind, share)))
        change = problem.simulator.predict((effect,)) - problem.simulator.nominal
    except PmmError:
        return None
    return effect, left_over(problem.whitened(change), problem.nuisances)


def _values(kind: type[Effect], share: float) -> Iterator[tuple[str, float]]:
    """Yield the signed parameters: a size rises with the share, and a length falls to its least."""
    own = signed_kinds()[kind.name]
    for one, field in zip(kind.parameters(), fields(kind), strict=True):
        if one.name not in own or (one.typical == 0.0 and len(own) > 1):
            continue
        value = one.least / share if one.least else share * one.high
        yield field.name, min(max(value, one.low), one.high)
