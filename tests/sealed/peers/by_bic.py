"""lmfit: force laws fitted one by one and in pairs, weighed by the BIC."""

from collections.abc import Iterator, Sequence
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.sealed.peers.scene import scene
from tests.sealed.peers.sheet import COEFFICIENTS, NONE, UNKNOWN, sheet, stages_of, weighed
from tests.sealed.peers.terms import TERMS, added, force_rows, library

FloatArray = NDArray[np.float64]


def lmfit_bic(case: Path) -> dict[str, Any]:
    """Answer by the BIC of laws in the force residual; all laws at once stand for "unknown"."""
    seen = scene(case)
    rows = force_rows(seen.fitting)
    sigma = seen.fitting.sigma[rows]
    left, laws = seen.fitting.values[rows] / sigma, library(seen.fitting) / sigma[:, None]
    costs: dict[str, float] = {}
    best: tuple[float, FloatArray] = (np.inf, np.zeros(laws.shape[1]))
    for name, terms in _hypotheses():
        cost, fitted = _fitted(left, laws, terms)
        costs[name] = min(cost, costs.get(name, np.inf))
        best = min(best, (cost, fitted), key=lambda one: one[0])
    return sheet(case.name, weighed(costs), stages_of(weighed(costs)),
                 seen.foretold(added(seen, best[1])))  # fmt: skip


def _hypotheses() -> Iterator[tuple[str, tuple[int, ...]]]:
    names = [term.effect for term in TERMS.values()]
    yield NONE, ()
    for i, name in enumerate(names):
        yield name, (i,)
    for i, j in combinations(range(len(names)), 2):
        pair = sorted({names[i], names[j]} - {COEFFICIENTS})
        yield "+".join(pair), (i, j)
    yield UNKNOWN, tuple(range(len(names)))


def _fitted(left: FloatArray, laws: FloatArray, terms: Sequence[int]) -> tuple[float, FloatArray]:
    """Return the BIC and the coefficients of some laws, those of the others zero."""
    import lmfit  # type: ignore[import-not-found, unused-ignore]

    out = np.zeros(laws.shape[1])
    if not terms:
        return len(left) * float(np.log(np.mean(left**2))), out
    own = [column for term in terms for column in (2 * term, 2 * term + 1)]
    size = np.linalg.norm(laws[:, own], axis=0)
    own = [column for column, one in zip(own, size, strict=True) if one > 0.0]
    scaled = laws[:, own] / np.linalg.norm(laws[:, own], axis=0)
    parameters = lmfit.Parameters()
    for column in own:
        parameters.add(f"c{column}", value=0.0)

    def misfit(now: Any) -> FloatArray:
        return np.asarray(left - scaled @ np.array([one.value for one in now.values()]))

    found = lmfit.minimize(misfit, parameters)
    values = np.array([one.value for one in found.params.values()])
    out[own] = values / np.linalg.norm(laws[:, own], axis=0)
    return float(found.bic), out
