"""GM by zero runs at several heels beside the stated one: a model that is held there rights itself.

What holds it at the heel phi exerts ``m g (GM + BM tan(phi)^2 / 2) sin(phi)`` beside what its gauge
reads at no heel.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.coefficients.campaign_checks import Pair, consistency_checks
from analysis.coefficients.campaign_records import ConsistencyCheck
from analysis.coefficients.phasors import Phasors
from analysis.uncertainty.redundancy import best_fit
from analysis.uncertainty.values import UncertainValues, stacked
from hardware.description.body import Body
from hardware.description.channels import HEEL_ANGLE, ROLL_MOMENT
from hardware.description.heel import Heel, righting_moment
from hardware.description.units import STANDARD_GRAVITY_M_S2

RIGHTING: Final = "righting"
_FEWEST: Final = 3  # zero runs, at as many heels: what is left of a line shows how well they fit
_KNOWN: Final = 0.05  # of GM: an inclining test's own
_REMEDY: Final = "correct gm_m in [heel], or turn the roll gauge's sign if that is what differs"


def righting_checks(
    zeros: Sequence[tuple[str, float, Phasors]], heel: Heel | None, body: Body | None, level: float
) -> tuple[ConsistencyCheck, ...]:
    """Return the check of GM that zero runs at several heels allow; none without them.

    Parameters
    ----------
    zeros
        Of each zero run: its name, the heel that is stated in rad, and means of its channels; the
        heel that was measured goes before the stated one.
    """
    runs = [zero for zero in zeros if ROLL_MOMENT.name in zero[2].names]
    heels = [_heel(stated, means) for _, stated, means in runs]
    if heel is None or heel.gm_m is None or body is None or len(np.unique(heels)) < _FEWEST:
        return ()
    weight = body.mass_kg * STANDARD_GRAVITY_M_S2
    moments = stacked([means.select([ROLL_MOMENT.name]).real.select([0]) for *_, means in runs])
    angles = np.array(heels)
    curved = righting_moment(0.0, weight * heel.bm_m, angles)
    linear = UncertainValues(moments.values - curved, moments.contributions)
    matrix = np.column_stack((np.ones(len(runs)), weight * np.sin(angles)))
    found, _ = best_fit(
        matrix, linear, subject="GM", results=("zero", "gm_m"), data=[name for name, *_ in runs]
    )
    stated_gm = UncertainValues(np.array([heel.gm_m])).plus("GM", np.array([_KNOWN * heel.gm_m]))
    estimates = stacked([found.select([1]), stated_gm])
    pair = Pair(RIGHTING, "GM", "m", (f"{len(runs)} zero runs", "[heel]"), estimates)
    return tuple(
        check if check.agrees else replace(check, message=f"{check.message}; {_REMEDY}")
        for check in consistency_checks([pair], level)
    )


def _heel(stated_rad: float, means: Phasors) -> float:
    measured = HEEL_ANGLE.name in means.names
    return float(means[HEEL_ANGLE.name].real) if measured else stated_rad
