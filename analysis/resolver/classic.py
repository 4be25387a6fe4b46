"""The two measuring modes of 1963 and the switch between them.

Kept because users of such rigs know them and have decades of results from them; the whole-period
estimator (:mod:`analysis.resolver.estimate`) is better wherever there is a mean, a drift
or an edge between samples . Use

* :mod:`analysis.resolver.classic_average`, the needles of the running average, above 0.5 Hz;
* :mod:`analysis.resolver.classic_gate`, the integral over m periods with hold and reset, below;
* :mod:`analysis.resolver.classic_recording` for either on a whole recording, and for the gate cut
  to whole samples, as a warning only.

``docs/modes-of-1963.md`` states the error that each of them has.
"""

from enum import StrEnum

import numpy as np

from analysis.resolver.basis import harmonic_basis
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError

SWITCH_HZ = 0.5


class ClassicMode(StrEnum):
    """The measuring modes of 1963."""

    RUNNING_AVERAGE = "running average"
    GATED_INTEGRATION = "gated integration"


def mode_for(frequency_hz: float) -> ClassicMode:
    """Return the mode in which the apparatus of 1963 was used at a frequency.

    Gated integration where the period exceeds 2 s (below 0.5 Hz, on both oscillators), else the
    running average.

    Raises
    ------
    ConfigurationError
        If the frequency is not a positive number.
    """
    check_frequency(frequency_hz)
    if frequency_hz < SWITCH_HZ:
        return ClassicMode.GATED_INTEGRATION
    return ClassicMode.RUNNING_AVERAGE


def products(values: FloatArray, cycles: FloatArray, harmonics: int) -> FloatArray:
    """Return what the resolver hands to the integrators, with a gain of 2.

    It is ``y 2 sin(theta), y 2 cos(theta), y 2 sin(2 theta), ...``, shape ``(channels, 2 *
    harmonics, samples)``; their means are ``S_1, C_1, S_2, ...``.

    Parameters
    ----------
    values
        Shape ``(channels, samples)``.
    cycles
        Revolutions of the shaft at the samples, shape ``(samples,)``.
    """
    basis = harmonic_basis(cycles, np.arange(1.0, harmonics + 1.0))[1:]
    return 2.0 * values[:, None, :] * basis


def check_frequency(frequency_hz: float) -> None:
    """Refuse what is no frequency.

    Raises
    ------
    ConfigurationError
        With the value.
    """
    if not (frequency_hz > 0.0 and np.isfinite(frequency_hz)):
        raise ConfigurationError(
            f"frequency_hz = {frequency_hz:g}: must be above 0; give the oscillator's frequency"
        )


def check_harmonics(harmonics: int) -> None:
    """Refuse a number of harmonics below one.

    Raises
    ------
    ConfigurationError
        With the value and the limit.
    """
    if harmonics < 1:
        raise ConfigurationError(f"harmonics = {harmonics}: at least 1 is needed")


def check_values(values: FloatArray, channel_names: tuple[str, ...]) -> None:
    """Refuse a block whose rows are not the channels.

    Raises
    ------
    ConfigurationError
        With the shape that came and the channels that were announced.
    """
    if values.ndim != 2 or len(values) != len(channel_names):
        raise ConfigurationError(
            f"a block of shape {values.shape} came where {len(channel_names)} rows are due, "
            f"one for each of {', '.join(channel_names)}"
        )
