"""pysindy: a sparse regression of the force residual on laws of each strut's motion."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np

from tests.sealed.peers.scene import scene
from tests.sealed.peers.sheet import NONE, UNKNOWN, sheet, stages_of
from tests.sealed.peers.terms import TERMS, added, force_rows, library

LIMIT = 5.0  # sigma that a law has to explain to stay
RIDGE = 1.0  # of a law in sigma: laws that are much alike over these runs share what they explain
EXPLAINED = 0.5  # share of the chi-square below which nothing is named


def pysindy_stlsq(case: Path) -> dict[str, Any]:
    """Answer by the law that keeps most after sequentially thresholded least squares."""
    import pysindy  # type: ignore[import-not-found, unused-ignore]

    seen = scene(case)
    rows = force_rows(seen.fitting)
    sigma = seen.fitting.sigma[rows]
    left, laws = seen.fitting.values[rows] / sigma, library(seen.fitting) / sigma[:, None]
    size = np.maximum(np.linalg.norm(laws, axis=0), 1e-12)
    fit = pysindy.STLSQ(threshold=LIMIT, alpha=RIDGE, normalize_columns=False)
    scaled = laws / size
    with warnings.catch_warnings():
        # Where no law stays it warns; that is the answer "no gap".
        warnings.filterwarnings("ignore", message="Sparsity parameter is too big")
        fit.fit(scaled, left[:, None])
    kept = np.asarray(fit.coef_)[0]
    foretold = seen.foretold(added(seen, kept / size))
    if not np.any(kept):
        return sheet(case.name, {NONE: 1.0}, {}, foretold)
    shares: dict[str, float] = {}
    for number, term in enumerate(TERMS.values()):
        own = float(kept[2 * number] ** 2 + kept[2 * number + 1] ** 2)
        shares[term.effect] = shares.get(term.effect, 0.0) + own
    rest = 1.0 - float(np.sum((left - scaled @ kept) ** 2) / np.sum(left**2))
    if rest < EXPLAINED:
        return sheet(case.name, {UNKNOWN: 1.0}, stages_of(shares), foretold)
    return sheet(case.name, shares, stages_of(shares), foretold)
