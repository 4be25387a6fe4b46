"""From the resolver's harmonics to phasors of the struts, with the covariance between channels.

Both struts feel the same carriage and the same waves, so their scatter is not independent.
"""

from collections.abc import Sequence

import numpy as np

from analysis.coefficients.body_axes import at_order, labels
from analysis.coefficients.phasors import Phasors
from analysis.ideal_rig import strut_displacements
from analysis.resolver.harmonics import Harmonics
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENTS
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint

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


def asked_motion(
    oscillator: Oscillator, set_point: SetPoint, measured: Phasors, orders: int
) -> Phasors:
    """Return what is asked of the struts that were not measured, in step with one that was.

    The phase may come from that strut itself, and be 0 at its upward crossing: so the motion asked
    for is set later until both agree on the fundamental of the strut that was measured.
    """
    asked = strut_displacements(oscillator, set_point, max(orders, 1))[: orders + 1]
    asked[0] = asked[0].imag  # H[0] = i A0
    turned = 0.0
    for k, name in enumerate(at_order(strut, 1) for strut in DISPLACEMENTS):
        if name in measured.names:
            turned = float(
                np.angle(measured.values[measured.names.index(name)] * asked[1, k].conj())
            )
    asked *= np.exp(1j * turned * np.arange(orders + 1))[:, None]
    names = [at_order(strut, n) for n in range(orders + 1) for strut in DISPLACEMENTS]
    whole = Phasors.of(tuple(names), ("m",) * len(names), asked.ravel())
    return whole.select([name for name in names if name not in measured.names])
