"""The self-propulsion point: where the propeller's thrust balances what is left of the resistance.

On straight course ``-X_c - F_D = (1 - t_P) T``, with the hull's load X_c and the friction's
deduction F_D; the revolutions are those at which the propeller has that thrust in its wake.
"""

from dataclasses import dataclass

import numpy as np

from analysis.steering.inflow import Inflow, wake_name
from analysis.steering.load_factors import LoadFactors
from analysis.steering.observations import Particulars, SteeringRuns
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError

_STEP = 1e-6


@dataclass(frozen=True)
class SelfPropulsion:
    """One speed.

    Attributes
    ----------
    resistance_n
        Of the hull, against the motion: -X_c, rudder amidships and without a propeller; below 0
        where a sign is wrong.
    rate_hz, thrust_n, advance
        Of the propeller there; NaN where no revolutions have that thrust.
    resistance_u, rate_u, thrust_u
        Standard uncertainties.
    """

    speed_m_s: float
    resistance_n: float
    resistance_u: float
    thrust_n: float
    thrust_u: float
    rate_hz: float
    rate_u: float
    advance: float


def self_propulsion(
    condition: int,
    runs: SteeringRuns,
    particulars: Particulars,
    loads: LoadFactors,
    flow: Inflow,
    excess: float,
    towing_force_n: float,
) -> SelfPropulsion:
    """Return the point of one condition of straight course.

    Parameters
    ----------
    excess
        What the standard uncertainties are multiplied by: the residuals' excess.

    Raises
    ------
    DataError
        If the towing force leaves the propeller nothing to do.
    """
    hull, wake = 4 + condition, flow.names.index(wake_name(condition))
    nominal = np.array([loads.values[0], loads.values[hull], flow.values[wake]])
    slopes = np.stack((loads.by_data[0], loads.by_data[hull], flow.by_data[wake]))
    spread = runs.following_slopes(slopes)
    speed = float(runs.motions[0, condition])
    if towing_force_n >= -nominal[1] > 0.0:
        raise DataError(
            f"towing_force_n = {towing_force_n:g} is not below the resistance of {-nominal[1]:.4g} "
            f"N at {speed:.4g} m/s: nothing is left for the propeller; state F_D, the friction's "
            "deduction"
        )

    def point(at: FloatArray) -> FloatArray:
        thrust = (-at[1] - towing_force_n) / at[0]
        return np.array([-at[1], thrust, _rate(thrust, speed * (1.0 - at[2]), particulars)])

    values = point(nominal)
    steps = np.diag(_STEP * np.fmax(np.abs(nominal), _STEP))
    by_own = np.stack(
        [(point(nominal + step) - point(nominal - step)) / (2.0 * step.sum()) for step in steps],
        axis=1,
    )
    u = excess * np.sqrt(((by_own @ spread) ** 2).sum(axis=1))
    advance = speed * (1.0 - nominal[2]) / (values[2] * particulars.diameter_m)
    (resistance, thrust, rate), (resistance_u, thrust_u, rate_u) = values.tolist(), u.tolist()
    return SelfPropulsion(
        speed, resistance, resistance_u, thrust, thrust_u, rate, rate_u, float(advance)
    )


def _rate(thrust_n: float, inflow_m_s: float, particulars: Particulars) -> float:
    """Return the revolutions with a thrust: the larger root of K_T's quadratic in n."""
    k0, k1, k2 = particulars.thrust
    pace = inflow_m_s / particulars.diameter_m
    wanted = thrust_n / particulars.density_kg_m3 / particulars.diameter_m**4
    under = (k1 * pace) ** 2 - 4.0 * k0 * (k2 * pace**2 - wanted)
    return (-k1 * pace + np.sqrt(under)) / (2.0 * k0) if under >= 0.0 and k0 > 0.0 else np.nan
