"""From the resolver's harmonics to phasors of the struts, with the covariance between channels.

Both struts feel the same carriage and the same waves, so their scatter is not independent.
"""

from collections.abc import Sequence

import numpy as np

from analysis.coefficients.body_axes import labels
from analysis.coefficients.phasors import Phasors
from analysis.resolver.harmonics import Harmonics
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

MOTION_ASKED = Flag(
    "motion_from_set_point",
    Severity.NOTE,
    "no strut displacements were measured: the set-point's are used, without uncertainty; state "
    "those of amplitude, strut phase and the photocell's latency",
)
STRUT_ASKED = Flag(
    "strut_from_set_point",
    Severity.NOTE,
    "one strut's displacement alone was measured: the other's is the set-point's, in step with it "
    "and without uncertainty; state those of amplitude and strut phase",
)

CHANNELS_INDEPENDENT = Flag(
    "channels_independent",
    Severity.NOTE,
    "tapered gates have no periods: the channels' scatter is taken as independent",
)


def reading_phasors(reading: Harmonics, names: Sequence[str], orders: int) -> Phasors:
    """Return mean and harmonics of some channels of a reading, as :func:`labels` orders them.

    Raises
    ------
    DataError
        If the reading has no such channel or harmonic.
    """
    missing = [name for name in names if name not in reading.channel_names]
    if missing or not 0 <= orders <= reading.order:
        raise DataError(
            f"{reading.run}: no harmonic {orders} of {', '.join(missing or names)}; resolved are "
            f"harmonics up to {reading.order} of {', '.join(reading.channel_names)}"
        )
    rows = [reading.channel_names.index(name) for name in names]
    values, parts = _ordered(reading.coefficients[rows], orders), reading.deviations[rows]
    by_order = _ordered(parts, orders).reshape(-1, parts.shape[2])
    freedom = float(reading.degrees_of_freedom[2 * orders])
    scatter = Contribution(f"scatter of {reading.run}", freedom, np.arange(len(by_order)), by_order)
    units = tuple(reading.units[row] for row in rows) * (orders + 1)
    return Phasors(labels(names, orders), units, UncertainValues(values.ravel(), (scatter,)))


def _ordered(coefficients: FloatArray, orders: int) -> FloatArray:
    """Return S and C by order and channel: ``(channels, K, ...)`` to ``(orders + 1, ..., 2, ...)``.

    The mean counts as the in-phase part of order 0.
    """
    ordered = np.zeros((orders + 1, len(coefficients), 2, *coefficients.shape[2:]))
    ordered[0, :, 0] = coefficients[:, 0]
    for n in range(1, orders + 1):
        ordered[n] = coefficients[:, 2 * n - 1 : 2 * n + 1]
    return ordered
