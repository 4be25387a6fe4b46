"""Every number that decides, with its unit and where it comes from.

``docs/gap-calibration.md`` lists them. Tolerances in physical units are not among them: they are
the user's (:mod:`analysis.gap.forward.tolerances`).
"""

from dataclasses import dataclass
from typing import Final

TAUS: Final = (0.0, 1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1.0)
"""Sizes of a deviation of no particular form, relative to a channel's predicted first harmonic: a
grid of orders of magnitude, from none at all to the whole of it."""

TOLERATED: Final = 1e-3
"""Size up to which a deviation that is smooth over set-points is no gap: ITTC asks 1 % of forces
for an accepted test; a tenth of it is what a good model leaves."""

VISIBLE: Final = 3.0
"""Nats of information that runs have to carry of a deviation; one that they hardly show is none."""

PLAIN: Final = 1e-3
"""Share of a deviation's variance that has no effect's shape: a thirtieth of its size."""

STRANGE: Final = 0.1
"""The same of what is unknown: a third of its size."""

SHAPED: Final = 0.7
"""Probability that what is unknown looks like a stage's effects; else it shows in one kind of
observation alone."""

FORMS: Final = (0.0, 0.3, 1.0)
"""By how much of the way an effect is in another form of its family: in its own, nearer to it, or
anywhere among them, each as probable."""

WIDE: Final = 10.0
"""Tolerances by which coefficients are off where they are the answer: a decade."""

ETA: Final = 0.5
"""Power of the evidence, the only calibrator: fitted on development boards of worlds A and B."""

ALIKE: Final = 0.99
"""Cosine of two effects' signatures, beside the tolerances, above which one is left out of what
stands beside the other."""


@dataclass(frozen=True)
class Odds:
    """Prior probabilities; the catalogue's share is spread evenly over its effects.

    Odds, which need not sum to 1, fitted on development boards of worlds A and B. One campaign in
    three has no gap. Of the gaps one in six is such that no catalogue knows it, and in one of
    three others a further effect is there too; in one campaign of thirty coefficients are off by
    more than anybody thought, and in as many a single run went wrong.
    """

    none: float = 0.6
    single: float = 0.6
    further: float = 0.5
    unknown: float = 0.2
    mistake: float = 0.06


ODDS: Final = Odds()
