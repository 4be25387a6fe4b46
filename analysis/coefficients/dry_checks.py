"""The model's inertia by runs in air beside the stated one: air adds next to nothing to it."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_checks import Pair, consistency_checks
from analysis.coefficients.campaign_records import ConsistencyCheck
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.ideal_rig import mass_matrix
from analysis.uncertainty.values import Contribution, UncertainValues, stacked
from hardware.description.body import Body
from hardware.description.errors import DataError

DRY: Final = "dry runs"
_NAMES: Final = ("m", "m x_G", "I")
_AIR: Final = 1.2e-3  # density over water's: what air moves along is about so much of the model
_REMEDY: Final = (
    "correct [model], or take it out so that the dry runs are taken off line by line; if it is the "
    "gauges that are off, pmm gap tells"
)


def dry_checks(
    dry: Sequence[BodyCycle], body: Body, stated: StatedUncertainties, level: float
) -> tuple[ConsistencyCheck, ...]:
    """Return the checks of mass, its moment and inertia that the runs in air allow.

    Parameters
    ----------
    dry
        Cycles in air, of which the stated model is taken off.
    stated
        With the uncertainties of the model itself.
    """
    moving = [run for run in dry if run.frequency_hz]
    if not moving:
        return ()
    try:
        found = linear_fit(moving, Form.SEAKEEPING, stated)
    except DataError:  # one motion with a mixture of both, or none that moves
        return ()
    inertial = [k for k, place in enumerate(found.places) if place.inertial]
    places = [found.places[k] for k in inertial]
    own, differences = mass_matrix(body, dry[0].plane), found.fit.uncertain.select(inertial)
    told = np.array([own[place.row, place.column] for place in places])
    sizes = np.sqrt(np.diag(own))
    carried = [_AIR * sizes[place.row] * sizes[place.column] for place in places]
    air = Contribution("air", np.inf, np.arange(len(places)), np.diag(carried))
    by_runs = replace(
        differences,
        values=told + differences.values,
        contributions=(*differences.contributions, air),
    )
    texts = (f"{len(dry)} runs in air", "[model]")
    pairs = [
        Pair(
            DRY,
            _NAMES[place.row + place.column],
            place.unit,
            texts,
            stacked([by_runs.select([k]), UncertainValues(told[[k]])]),
        )
        for k, place in enumerate(places)
    ]
    return tuple(
        check if check.agrees else replace(check, message=f"{check.message}; {_REMEDY}")
        for check in consistency_checks(pairs, level)
    )
