"""What a decay is made of, and what dry friction does to its phase.

A decay that is left alone goes by ``dA/dt = -(c_0 + c_1 A + c_2 A^2)``: Coulomb friction, linear
and quadratic damping, none of them negative. With friction each half swing is exact about a middle
that lies ``c = c_0 pi/(2 omega)`` towards where it comes from. Its turning points keep time, but
its fundamental is late: over half a swing the middle adds ``4 c/pi`` in quadrature, of which an
amplitude that falls evenly explains ``c/pi``, so that the phase stays behind by

    3 c/(pi A) = 3 c_0/(2 omega A)

which grows as the swing dies: without it the period would seem longer the smaller the amplitude.
Linear damping delays evenly, and what quadratic damping does goes with the square of the amplitude.
"""

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.inertia.amplitude import amplitude_integral
from analysis.inertia.local_periods import LocalPeriods

_SURE: Final = 4.0  # standard uncertainties that friction has to be above none


@dataclass(frozen=True)
class OwnDecay:
    """Rates at which an amplitude falls: evenly, in proportion to itself, and to its square.

    Attributes
    ----------
    friction
        ``c_0``, in the record's unit per second.
    viscous_1_s
        ``c_1``.
    quadratic
        ``c_2``, per unit and second.
    """

    friction: float
    viscous_1_s: float
    quadratic: float

    def undamped(self, period_s: float) -> float:
        """Return the undamped period of a small swing: ``T / sqrt(1 + (c_1 T/(2 pi))^2)``."""
        return period_s / float(np.hypot(1.0, self.viscous_1_s * period_s / (2.0 * np.pi)))


def own_decay(local: LocalPeriods) -> OwnDecay:
    """Fit the amplitudes of a record's parts; friction is none where it is not seen for sure."""
    from scipy.optimize import nnls

    time, amplitude = local.time_s, local.amplitude
    size, duration = float(amplitude.max()), float(time[-1] - time[0])
    columns = [np.ones(time.size)]
    columns += [-amplitude_integral(local, p) / size**p / duration for p in (1, 2)]
    columns += [-(time - time[0]) / duration]
    (smooth, less), (solved, least) = (
        nnls(np.column_stack(columns[:count]), amplitude / size) for count in (3, 4)
    )
    if less**2 - least**2 < _SURE**2 * least**2 / max(time.size - 4, 1):
        solved = np.append(smooth, 0.0)
    _, viscous, quadratic, friction = (solved / duration).tolist()
    return OwnDecay(friction * size, viscous, quadratic / size)


def without_lag(local: LocalPeriods, decay: OwnDecay) -> LocalPeriods:
    """Return the phases and periods that the parts would have without friction."""
    omega = local.omega_rad_s
    late = 1.5 * decay.friction / (omega * local.amplitude)
    falls = decay.friction / local.amplitude + decay.viscous_1_s + decay.quadratic * local.amplitude
    return replace(
        local,
        phase_rad=local.phase_rad + late,
        period_s=2.0 * np.pi / (omega + late * falls),
    )
