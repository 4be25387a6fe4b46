"""How far the gap on the withheld runs truly shrinks, against the runs as they are without noise.

The gap of a prediction is the root mean square, over the withheld runs, their forces, means and
harmonics, of its distance from the noise-free truth in sigma. Nothing is taken off: no noise is in
it.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from typing import Final

from tests.sealed.scoring.answers import Answer, Forecast, Predicted
from tests.sealed.scoring.keys import TrueChannel, Truth, forces

SEEN: Final = 1.0  # sigma: below it there is nothing that could shrink


@dataclass(frozen=True)
class Shrunk:
    """Gaps before and after, in sigma, with coefficients fitted in both.

    Attributes
    ----------
    rival, polynomial
        After the second best answer and after a free polynomial; ``None`` where not foretold.
    """

    before: float
    after: float
    rival: float | None = None
    polynomial: float | None = None

    @property
    def share(self) -> float:
        """Part of the gap that goes away; negative where it grows."""
        return self.share_of(self.after)

    def share_of(self, after: float) -> float:
        """Part of the gap that goes away where this much is left."""
        return 1.0 - after / self.before


def gap(foretold: Forecast, truth: Truth) -> float:
    """Return the gap of a prediction of all withheld runs, in sigma."""
    squares = [
        part**2
        for name, run in truth.held_out.items()
        for channel in forces(run)
        for part in _parts(foretold[name][channel], run.channels[channel])
    ]
    return math.sqrt(math.fsum(squares) / len(squares))


def _parts(said: Predicted, there: TrueChannel) -> Iterator[float]:
    """Yield each component's distance in sigma; orders that are not foretold count as zero.

    A mean is half as uncertain in variance as a part of a harmonic.
    """
    yield (said.mean - there.mean) / (there.sigma[0] / math.sqrt(2.0))
    for own, true in ((said.in_phase, there.in_phase), (said.quadrature, there.quadrature)):
        for one, value, sigma in zip_longest(own[: len(true)], true, there.sigma, fillvalue=0.0):
            yield (one - value) / sigma


def shrunk(answer: Answer, truth: Truth, before: float) -> Shrunk | None:
    """Return an answer's gaps; ``None`` where it foretells nothing or there is nothing to shrink.

    Where it failed, nothing of the gap goes away.

    Parameters
    ----------
    before
        The smallest gap that any row of the board foretells for this case without an effect, so
        that nobody gains by making the gap larger first.
    """
    if before < SEEN or not (answer.after or answer.failed):
        return None
    if answer.failed:
        return Shrunk(before, before)
    rival, polynomial = (
        gap(there, truth) if there else None
        for there in (answer.after_rival, answer.after_polynomial)
    )
    return Shrunk(before, gap(answer.after, truth), rival, polynomial)
