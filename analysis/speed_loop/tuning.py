"""Gains of a speed loop: as much integral action as its margins allow.

The integral gain is what a slow load meets: the speed that a load step takes in all, integrated, is
one over it. It is made as large as it goes while L keeps clear of the point -1:
``|1 / (1 + L)| <= M`` and ``|L / (1 + L)| <= M`` at every frequency
(Astrom and Hagglund 1995, Astrom, Panagopoulos and Hagglund 1998). Both are quadratic in the
integral gain where the proportional one is given, so that it is found without a search.
"""

import math
from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.speed_loop.loop import ShaftLoop
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.motor import Servo, ShuntMotor, SpeedLoop

LARGEST_SENSITIVITY: Final = 1.4
"""M: gain margin of 3.5 and phase margin of 42 degrees at least (Astrom and Hagglund: 1.2 to 2)."""
_POINTS: Final = 2000
_DECADES: Final = (-2.0, 5.0)  # of the circular frequency, rad/s: from a turn in ten minutes
_GAINS: Final = 400


def proposed(
    motor: Servo | ShuntMotor,
    added_inertias_kg_m2: Sequence[float] = (0.0,),
    delay_s: float = 0.0,
    most: float = LARGEST_SENSITIVITY,
) -> SpeedLoop:
    """Return the gains with the largest integral action that keep the margins.

    Parameters
    ----------
    added_inertias_kg_m2
        What the model adds to the shaft: the margins hold with each of them.
    delay_s
        Dead time in the loop.
    most
        M above, over 1.

    Raises
    ------
    ConfigurationError
        If M is not above 1, or no gains keep the margins.
    """
    if not most > 1.0:
        raise ConfigurationError(
            f"a largest sensitivity of {most:g} has to be above 1; 1.4 is usual, 1.2 is cautious"
        )
    omega = np.logspace(*_DECADES, _POINTS)
    responses = np.stack(
        [
            ShaftLoop(motor, SpeedLoop(1.0, 0.0), added_kg_m2, delay_s).open_response(omega)
            for added_kg_m2 in added_inertias_kg_m2
        ]
    )
    scale = 1.0 / np.abs(responses).max()
    gains = np.logspace(math.log10(scale), math.log10(scale) + 8.0, _GAINS)
    best = max(
        _with_integral(gains, omega, responses, most), key=lambda gains_pair: gains_pair.integral
    )
    if not best.integral > 0.0:
        raise ConfigurationError(
            f"no gains keep a largest sensitivity of {most:g}; allow more, or a shorter delay"
        )
    return best


def _with_integral(
    gains: FloatArray, omega: FloatArray, responses: ComplexArray, most: float
) -> list[SpeedLoop]:
    """Return the largest integral gain to each proportional one, as far as these go from zero."""
    integrals, loops = responses / (1j * omega), [SpeedLoop()]
    circles = ((1.0, 1.0, 1.0 - 1.0 / most**2), (most**2 - 1.0, most**2, most**2))
    for gain in gains.tolist():
        largest = min(_largest(gain * responses, integrals, *circle) for circle in circles)
        if largest < 0.0:
            break
        loops.append(SpeedLoop(gain, largest))
    return loops


def _largest(
    rest: ComplexArray, integral: ComplexArray, square: float, linear: float, constant: float
) -> float:
    """Return up to which k ``square |L|^2 + 2 linear Re L + constant >= 0``; below 0 if nowhere.

    L is ``rest + k integral``; from k = 0 on, at every frequency.
    """
    a = square * np.abs(integral) ** 2
    b = square * np.real(rest * np.conj(integral)) + linear * integral.real
    c = square * np.abs(rest) ** 2 + 2.0 * linear * rest.real + constant
    if np.any(c < 0.0):
        return -1.0
    met = (b < 0.0) & (b**2 > a * c)
    return float((c[met] / (np.sqrt(b[met] ** 2 - a[met] * c[met]) - b[met])).min(initial=np.inf))
