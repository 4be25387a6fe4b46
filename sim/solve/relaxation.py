"""Parts that act back on each other, solved together by sweeps over a stretch of samples.

Each part answers to a whole stretch at once (vectorised, its linear part exact); what comes back is
fed in again until it no longer changes. Anderson's mixing of the last sweeps makes that quick. What
the sweeps end at does not depend on the length of the stretch, so blocks stay exchangeable.
"""

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Final, TypeAlias, TypeVar

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError

ArrayT = TypeVar("ArrayT", FloatArray, ComplexArray)

# The last samples of a signal, newest last: the part of a state that a hold needs.
Tail: TypeAlias = tuple[tuple[float, ...], ...]

TOLERANCE: Final = 1e-13
ROUNDING: Final = 1e-11  # changes below it that shrink no more are rounding
MOST_SWEEPS: Final = 80
LONGEST_SWEEP: Final = 1024  # samples that are swept together
_DEPTH: Final = 12  # with 8 a motor that turns a model on springs to 25 degrees does not settle
STALLED: Final = 3  # sweeps without a smaller change: mixing now and then makes one worse


def relax(
    respond: Callable[[ArrayT], ArrayT],
    start: ArrayT,
    stage: str,
    scale: FloatArray | float | None = None,
) -> ArrayT:
    """Return the array that ``respond`` gives back unchanged.

    Parameters
    ----------
    scale
        What a change counts relative to, broadcast against the array; its largest magnitude if not
        given.

    Raises
    ------
    ConfigurationError
        If the parts do not come to terms: they act back on each other too strongly.
    """
    size = float(np.abs(start).max(initial=0.0)) if scale is None else scale
    allowed = TOLERANCE * np.maximum(size, np.finfo(np.float64).tiny)
    at, best, settled, stalled = start, math.inf, start, 0
    answers: list[ArrayT] = []
    changes: list[ArrayT] = []
    for _ in range(MOST_SWEEPS):
        answer = respond(at)
        change = answer - at
        largest = float((np.abs(change) / allowed).max(initial=0.0))
        if largest < best:
            best, settled, stalled = largest, answer, 0
        else:
            stalled += 1
        if best <= 1.0 or (best <= ROUNDING / TOLERANCE and stalled >= STALLED):
            return settled
        answers.append(answer)
        changes.append(change)
        del answers[: -_DEPTH - 1], changes[: -_DEPTH - 1]
        at = _mixed(answers, changes, allowed)
    raise ConfigurationError(
        f"{stage}: its parts act back on each other so strongly that {MOST_SWEEPS} sweeps do not "
        f"settle them (change {largest * TOLERANCE:.2g} of the signal); "
        f"sample faster, or make the drive or the mounting stiffer"
    )


def _mixed(answers: list[ArrayT], changes: list[ArrayT], allowed: FloatArray | float) -> ArrayT:
    """Return the mean of the answers, weighted so that their changes cancel best (Anderson)."""
    if len(answers) < 2:
        return answers[-1]
    steps = [((new - old) / allowed).ravel() for old, new in pairwise(changes)]
    newest = (changes[-1] / allowed).ravel()
    gram = np.array([[np.vdot(a, b).real for b in steps] for a in steps])
    right = np.array([np.vdot(a, newest).real for a in steps])
    weights = np.linalg.lstsq(gram, right, rcond=1e-12)[0]
    mixed = answers[-1].copy()
    for weight, (old, new) in zip(weights, pairwise(answers), strict=True):
        mixed -= weight * (new - old)
    return mixed
