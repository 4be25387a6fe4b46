"""Whether a name foretells: against predictions that are made so that it must, or cannot."""

from collections.abc import Sequence

import numpy as np
import pytest

from analysis.gap.regimes import Regime
from analysis.gap.withheld import Predicted, foretells

COUNT = 50


def told(*gaps_u: float) -> tuple[Predicted, ...]:
    """Return regimes that leave these gaps, the noise's own 1 besides."""
    return tuple(
        Predicted(
            Regime("run", str(at), (at,)),
            np.ones(COUNT, dtype=bool),
            np.full(COUNT, np.sqrt(1.0 + gap**2)),
            0.0,
        )
        for at, gap in enumerate(gaps_u)
    )


@pytest.mark.parametrize(
    ("before_u", "after_u", "is_foretold"),
    [
        ((20.0, 20.0, 20.0), (0.0, 0.5, 0.9), True),
        ((20.0, 20.0, 20.0), (9.0, 8.0, 15.0), True),  # of the last it leaves more than half
        ((20.0, 20.0, 20.0), (0.0, 15.0, 15.0), False),
        ((20.0, 20.0), (40.0, 40.0), False),
        ((20.0, 20.0), (0.0, 15.0), True),  # half of two
        ((20.0,), (15.0,), True),  # one alone may itself be off
        ((20.0, 20.0, 20.0), (20.0, 20.0, 15.0), True),  # it speaks of one regime only
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), True),
        ((), (), True),
    ],
)
def test_at_least_half_of_what_it_speaks_of(
    before_u: Sequence[float], after_u: Sequence[float], is_foretold: bool
) -> None:
    assert foretells(told(*before_u), told(*after_u)) is is_foretold
