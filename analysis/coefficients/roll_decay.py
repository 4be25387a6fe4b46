"""K_p and K_pdot from roll decays: the damped period and damping ratio of a model afloat.

With the restoring moment C per heel, m g GM less what the flow adds (K_phi), and the moment of
inertia I about the roll axis,

    w_0 = 2 pi / (T sqrt(1 - zeta^2))      K_pdot = I - C/w_0^2      K_p = -2 zeta C/w_0
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.coefficients.alike import is_same_speed
from analysis.coefficients.campaign_records import ROLL_DECAY, CoefficientEntry
from analysis.coefficients.campaign_result import CampaignCoefficients, TrialColumns
from analysis.kinematics.complex_step import pointwise
from analysis.kinematics.geometry import Waves
from analysis.uncertainty.values import Contribution, UncertainValues, stacked
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel

NAMES: Final = ("K_p", "K_pdot")
_UNITS: Final = ("N m s", "kg m2")


@dataclass(frozen=True)
class RollDecay:
    """What was found of decays at one speed, as ``pmm inertia`` tells it of their records.

    Attributes
    ----------
    period_s, u_period_s
        Damped period, and its standard uncertainty.
    damping_ratio, u_damping_ratio
        Share of critical damping.
    u_gm_m, u_inertia_kg_m2
        Standard uncertainties of metacentric height and inertia of ``[heel]``.
    period_degrees_of_freedom, damping_degrees_of_freedom
        Of the standard uncertainties of both.

    Raises
    ------
    ConfigurationError
        If a period is not above 0 or a damping ratio not between -1 and 1.
    """

    period_s: float
    damping_ratio: float
    u_period_s: float = 0.0
    u_damping_ratio: float = 0.0
    u_gm_m: float = 0.0
    u_inertia_kg_m2: float = 0.0
    speed_m_s: float = 0.0
    period_degrees_of_freedom: float = math.inf
    damping_degrees_of_freedom: float = math.inf

    def __post_init__(self) -> None:
        if not (self.period_s > 0.0 and abs(self.damping_ratio) < 1.0):
            raise ConfigurationError(
                f"roll_decays: period_s = {self.period_s:g} must be above 0 and damping_ratio = "
                f"{self.damping_ratio:g} between -1 and 1"
            )


def with_decays(
    coefficients: CampaignCoefficients,
    decays: Sequence[RollDecay],
    heel: Heel | None,
    body: Body | None,
) -> CampaignCoefficients:
    """Return the campaign with K_p and K_pdot of its decays; K_phi of the same speed counts.

    Raises
    ------
    ConfigurationError
        If mass, inertia about the roll axis or metacentric height are not known.
    """
    for decay in decays:
        uncertain = _of_decay(coefficients, decay, heel, body)
        entries = tuple(
            CoefficientEntry(
                name, unit, ROLL_DECAY, 0.0, decay.speed_m_s, 0.0, 0.0, (), math.nan, math.nan
            )
            for name, unit in zip(NAMES, _UNITS, strict=True)
        )
        trials, empty = coefficients.trials, np.full(len(entries), np.nan)
        columns = (trials.standard_uncertainty, trials.low, trials.high)
        coefficients = replace(
            coefficients,
            entries=(*coefficients.entries, *entries),
            uncertain=stacked([coefficients.uncertain, uncertain]),
            trials=TrialColumns(trials.count, *(np.append(column, empty) for column in columns)),
        )
    return coefficients


def _of_decay(
    coefficients: CampaignCoefficients, decay: RollDecay, heel: Heel | None, body: Body | None
) -> UncertainValues:
    if body is None or heel is None or heel.gm_m is None or heel.inertia_kg_m2 is None:
        raise ConfigurationError(
            "roll_decays: K_p takes mass_kg of [model], and inertia_kg_m2 and gm_m of [heel]; "
            "state them in the campaign file"
        )
    per_metre, _ = replace(heel, gm_m=1.0).righting(body)
    rows = [
        k
        for k in coefficients.rows("K_phi")
        if is_same_speed(coefficients.entries[k].speed_m_s, decay.speed_m_s)
    ]
    flow = coefficients.uncertain.select(rows[:1])
    k_phi = float(flow.values[0]) if rows else 0.0

    def damping_and_added(inputs: Waves) -> Waves:
        period, ratio, metacentric, inertia, of_flow = np.moveaxis(inputs, -2, 0)
        omega = 2.0 * np.pi / (period * np.sqrt(1.0 - ratio**2))
        stiff = per_metre * metacentric - of_flow
        return np.stack([-2.0 * ratio * stiff / omega, inertia - stiff / omega**2], axis=-2)

    point = np.array([decay.period_s, decay.damping_ratio, heel.gm_m, heel.inertia_kg_m2, k_phi])
    values, slopes = (dual[..., 0] for dual in pointwise(damping_and_added, point[:, np.newaxis]))
    stated = {
        f"period of the roll decay at {decay.speed_m_s:g} m/s": (
            decay.u_period_s,
            decay.period_degrees_of_freedom,
        ),
        f"damping ratio of the roll decay at {decay.speed_m_s:g} m/s": (
            decay.u_damping_ratio,
            decay.damping_degrees_of_freedom,
        ),
        "gm_m": (decay.u_gm_m, np.inf),
        "inertia_x_kg_m2": (decay.u_inertia_kg_m2, np.inf),
    }
    both_rows = np.arange(len(NAMES))
    contributions = [
        Contribution(label, freedom, both_rows, spread * slopes[:, [k]])
        for k, (label, (spread, freedom)) in enumerate(stated.items())
        if spread > 0.0
    ]
    contributions += [
        replace(contribution, rows=both_rows, parts=slopes[:, [-1]] @ contribution.dense(1))
        for contribution in flow.contributions
    ]
    return UncertainValues(values, tuple(contributions))
