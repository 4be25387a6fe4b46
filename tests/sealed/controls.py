"""Trivial answers: what a row of the board is worth that looks at no recording at all."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sim.effects.catalogue import catalogue
from tests.sealed.peers.sheet import COEFFICIENTS, NONE, UNKNOWN, sheet

# By construction: the kinds that are drawn put a zero into two of three twins besides its share of
# the singles.
COMMONEST = "zero-offset"
SEED = 20262

Answerer = Callable[[Path], dict[str, Any]]
"""Takes a case's folder, returns its answer."""


def no_gap(case: Path) -> dict[str, Any]:
    """Always answer "no gap"."""
    return sheet(case.name, {NONE: 1.0}, {})


def commonest(case: Path) -> dict[str, Any]:
    """Always answer the effect that is drawn most often."""
    return sheet(case.name, {COMMONEST: 1.0}, {catalogue()[COMMONEST].stage.value: 1.0})


def at_random(case: Path) -> dict[str, Any]:
    """Answer anything, each effect and verdict as often as another; by case the same each time."""
    rng = np.random.default_rng([SEED, *case.name.encode()])
    names = [NONE, COEFFICIENTS, UNKNOWN, *catalogue()]
    said = names[int(rng.integers(len(names)))]
    stages = sorted({kind.stage.value for kind in catalogue().values()})
    stage = catalogue()[said].stage.value if said in catalogue() else str(rng.choice(stages))
    return sheet(case.name, {said: 1.0}, {} if said in (NONE, COEFFICIENTS) else {stage: 1.0})


CONTROLS: Mapping[str, Answerer] = {
    "no-gap": no_gap,
    "commonest": commonest,
    "random": at_random,
}
