"""What is there besides the effect: the noise-free reality beside one that nothing moves.

A finite drive gives way to the load, gauges that need a stiffness give way a little, and ripple,
drift, hum and an uneven carriage are on in every run. None of it may be seen, and not all of it
together: it is measured as a whole, from the noise-free runs themselves.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tests.sealed.generator.parameters import FloatArray, P
from tests.sealed.generator.signatures import Projection, Situation
from tests.sealed.generator.sizing import Sized

# Of all that is always there together, and of what an effect's own parts bring, in sigma.
QUIET, QUIET_PARTS = 0.95, 0.8
_UNMOVED = 1e12  # inertia of a shaft that no load moves, kg m2
_TRIES = 5


@dataclass(frozen=True)
class Background:
    """Measures how far a noise-free reality is from the ideal of the same hull and geometry."""

    situation: Situation
    projection: Projection

    @cached_property
    def _ideal(self) -> FloatArray:
        p = self.situation.parameters.copy()
        p[P.CRANK_INERTIA] = _UNMOVED
        return self.situation.features_of(p, None)

    def of(self, p: FloatArray) -> float:
        """Return the distance of all runs together under parameters ``p``, in sigma."""
        return self.projection.snr(self.situation.features_of(p, None) - self._ideal)

    def of_parts(self, found: Sized) -> float:
        """Return what an effect's own drive, gauges or frame bring before it has a size."""
        if not found.effect.own_base:
            return 0.0
        return self.of(found.effect.put(self.situation.parameters, 0.0, found.drawn))

    def quieted(
        self, still: FloatArray, always: tuple[Sized, ...]
    ) -> tuple[tuple[Sized, ...], float]:
        """Return the nuisances, all made smaller alike until the whole is quiet, and the whole.

        Parameters
        ----------
        still
            Parameters without the nuisances.
        """
        for _ in range(_TRIES):
            total = self.of(with_all(still, always))
            if total < QUIET:
                return always, total
            always = tuple(smaller(sized, 0.8 * QUIET / total) for sized in always)
        return (), self.of(still)


def with_all(p: FloatArray, always: Sequence[Sized]) -> FloatArray:
    """Return the parameters with all of these in them."""
    for sized in always:
        p = sized.put(p)
    return np.asarray(p)


def smaller(sized: Sized, share: float) -> Sized:
    """Return a small effect at a share of its size; its norm goes with the size."""
    return replace(sized, size=share * sized.size, snr=share * sized.snr)
