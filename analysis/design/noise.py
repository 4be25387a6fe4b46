"""What the resolver leaves open of a run: scatter that falls with the time, and what does not.

Least squares at a known frequency over a time T gives both parts of harmonic n a variance of
``S(n f) / T``, and a mean half of it at zero frequency, where S is the noise's one-sided spectral
density: white up to a corner below which it rises as 1/f,

    S(f) = 2 sigma^2 / f_s (1 + f_c / f).

Of white noise it is the Cramer-Rao bound ``2 sigma^2 / N`` of an amplitude (S. M. Kay, Fundamentals
of Statistical Signal Processing: Estimation Theory, 1993, section 4.4).
"""

from dataclasses import dataclass

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.repeats import Repeatability, with_repeats
from analysis.design.belief import CHANNELS, ORDERS
from analysis.uncertainty.values import Contribution


@dataclass(frozen=True)
class Noise:
    """Noise of the channels, the same of both struts.

    Attributes
    ----------
    force_n, displacement_m
        Standard deviation of a sample of a gauge and of a displacement.
    sample_rate_hz
        At which these hold.
    corner_hz
        Below it the noise's density rises as 1/f.
    repeat_relative
        What a repeated run differs by beyond its scatter, over the size of the load.
    """

    force_n: float
    sample_rate_hz: float
    displacement_m: float = 0.0
    corner_hz: float = 0.0
    repeat_relative: float = 0.0

    def scatter(self, name: str, frequency_hz: float, periods: float) -> Contribution:
        """Return the scatter of the struts' phasors of a run that oscillates.

        It is a source of :func:`analysis.design.belief.believed_cycle`, with the degrees of freedom
        of the periods' own scatter.
        """
        order = np.maximum(np.arange(ORDERS + 1), 1)
        density = 2.0 / self.sample_rate_hz * (1.0 + self.corner_hz / (order * frequency_hz))
        deviations = np.sqrt(density * frequency_hz / periods)
        sizes = [
            self.displacement_m if "displacement" in channel else self.force_n
            for channel in CHANNELS
        ]
        spread = np.repeat(deviations[:, None] * np.array(sizes), 2, axis=1)
        spread[0] *= np.tile((np.sqrt(0.5), 0.0), len(CHANNELS))
        flat = spread.ravel()
        return Contribution(
            f"scatter of {name}", max(periods - 1.0, 1.0), np.arange(len(flat)), np.diag(flat)
        )

    def repeating(self, cycle: BodyCycle) -> BodyCycle:
        """Return a cycle with what its repeats would differ by as one more source."""
        load_spreads = np.full(2, self.repeat_relative)
        return with_repeats(cycle, Repeatability(load_spreads, np.inf, ()))
