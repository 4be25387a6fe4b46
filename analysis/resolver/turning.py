"""A given frequency that is not the motion's: the phase then turns from period to period."""

import numpy as np

from analysis.resolver.estimate import PeriodValues
from analysis.resolver.reference import PhaseReference, ReferenceSource
from hardware.description.arrays import ComplexArray
from hardware.description.flags import Flag, Severity

_FEWEST = 4  # periods: fewer tell no turning from noise
_NOTABLE_CYCLES = 0.05  # from the first period to the last
_STEADY = 0.95  # mean resultant length of the turns: 1 where all are the same
_STRAIGHT = 0.2  # largest distance from an even turning, of the whole turn


def frequency_flags(
    names: tuple[str, ...], values: PeriodValues, reference: PhaseReference
) -> tuple[Flag, ...]:
    """Return ``frequency_differs`` where the first harmonic turns steadily against a given one.

    Judged by the channel whose first harmonic stands out most from what else its periods do.

    Parameters
    ----------
    names
        The channels of ``values``.
    """
    if reference.source is not ReferenceSource.FREQUENCY:
        return ()
    phasors = values.coefficients[:, :, 1] + 1j * values.coefficients[:, :, 2]
    phasors = phasors[np.isfinite(phasors).all(axis=1)]
    if len(phasors) < _FEWEST:
        return ()
    # Where periods were left out one turn spans several; the median does not mind a few.
    row = _strongest(phasors)
    per_period = _turn(phasors[:, row])
    if per_period is None:
        return ()
    given, fits = reference.frequency_hz, reference.frequency_hz * (1.0 + per_period)
    message = (
        f"the phase turns by {360.0 * per_period:+.3g} degrees a period against the given "
        f"{given:.6g} Hz: {fits:.6g} Hz fits. The harmonics found are too small; give this "
        "frequency, or take the phase from a channel"
    )
    return (Flag("frequency_differs", Severity.WARNING, message, names[row]),)


def _strongest(phasors: ComplexArray) -> int:
    """Row of the channel whose amplitude is largest against its change from period to period."""
    size = np.abs(phasors)
    change = np.abs(np.diff(size, axis=0)).mean(axis=0)
    return int(np.argmax(size.mean(axis=0) / np.maximum(change, 1e-12 * size.max(axis=0) + 1e-300)))


def _turn(phasor: ComplexArray) -> float | None:
    """Cycles by which a phasor turns from one period to the next; ``None`` if not steadily."""
    steps = phasor[1:] * phasor[:-1].conj()
    steps = steps / np.maximum(np.abs(steps), 1e-300)
    if abs(steps.mean()) < _STEADY:
        return None
    turned = np.unwrap(np.angle(phasor)) / (2.0 * np.pi)
    period = np.arange(len(turned)) - (len(turned) - 1) / 2.0
    per_period = float(period @ turned / (period @ period))
    whole = abs(per_period) * (len(turned) - 1)
    away = np.abs(turned - turned.mean() - per_period * period).max()
    return per_period if whole > _NOTABLE_CYCLES and away < _STRAIGHT * whole else None
