"""The swing at rest: centre of gravity from tilts under calibration weights (eqs 1 to 3, 8 to 13).

    tan(alpha) = m_W (d_W - h_W tan(alpha - offset)) / S [+ offset],      S = m_S d_S + m_M d_M

with the weights h_W below the pivot, is linear in 1/S, so one solve takes any number of levers at
once and needs no starting value; where the weights do not hang at the pivot's height, an offset is
put in again. Gravity cancels. F1 has no offset; F2, with one, is the better.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.inertia.elementary_functions import Value
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate, exactly, joint, require_positive
from analysis.uncertainty.redundancy import Redundancy, best_fit, scattered_fit
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_MOMENT = ("first_moment_kg_m",)
_ROUNDS = 3  # for the offset in the pull: each leaves a hundredth of what it was off or less


@dataclass(frozen=True)
class LeverSeries:
    """Tilts at one lever.

    Attributes
    ----------
    lever_m
        Horizontal distance of the weights from the pivot.
    weight_kg, tilt_rad
        Shape ``(readings,)``; tilts towards the weights are positive.
    drop_m
        Depth of the points that the weights hang from below the pivot, at rest.
    """

    name: str
    lever_m: float
    weight_kg: FloatArray
    tilt_rad: FloatArray
    drop_m: float = 0.0

    def pull_kg_m(self, offset: float) -> FloatArray:
        """Return weight times lever as it is at each tilt, whose tangent at rest is ``offset``."""
        turned = np.tan(self.tilt_rad) - offset
        return np.asarray(self.weight_kg * (self.lever_m - self.drop_m * turned))


@dataclass(frozen=True)
class StaticMoment:
    """First moment of the swing (with model) about the pivot.

    Attributes
    ----------
    moment
        ``S`` in kg m; a distance follows by division by the mass.
    offset_rad
        Tangent of the tilt without weights; 0 for F1.
    residual_rms_rad
        Standard deviation of the tangents about the line.
    """

    moment: Estimate
    offset_rad: Estimate
    residual_rms_rad: float
    series: tuple[str, ...]


@dataclass(frozen=True)
class StaticResult:
    """The fit of all levers together, and of each lever alone.

    Attributes
    ----------
    pooled
        One fit to all readings; its uncertainty grows by the scatter between the series.
    alone
        Each series by itself.
    redundancy
        How the readings scatter about the pooled fit, and how the levers agree.
    """

    pooled: StaticMoment
    alone: tuple[StaticMoment, ...]
    redundancy: tuple[Redundancy, ...]
    flags: tuple[Flag, ...]


def fit_static(series: Sequence[LeverSeries], *, with_offset: bool = True) -> StaticResult:
    """Fit F2 (or F1) to all levers at once and compare the series.

    Raises
    ------
    ConfigurationError
        For a lever that is not above zero.
    DataError
        For no readings, fewer than three in a series, weights all the same, or a tilt that does not
        grow with the weight.
    """
    if not series:
        raise DataError("no lever series; at least one is needed")
    for levers in series:
        _check(levers)
    pooled = _fit(series, with_offset)
    single_fits = tuple(_fit([levers], with_offset) for levers in series)
    wider, between = _between_levers(pooled, single_fits)
    agreements = (_readings(series, with_offset, pooled.offset_rad.value), *between)
    return StaticResult(wider, single_fits, agreements, _flags(series, agreements))


def distance(moment: Estimate, mass_kg: Estimate) -> Estimate:
    """Return the distance of the centre of gravity below the pivot, in metres.

    Raises
    ------
    ConfigurationError
        For a mass of zero or less.
    """
    require_positive("swing", mass_kg=mass_kg)
    inputs = {"moment_kg_m": moment, "mass_kg": mass_kg}
    return derived("CG below the pivot", _depth, "m", **inputs)


def _depth(moment_kg_m: Value, mass_kg: Value) -> Value:
    return moment_kg_m / mass_kg


def _check(levers: LeverSeries) -> None:
    require_positive(f"series {levers.name!r}", lever_m=levers.lever_m)
    if levers.weight_kg.size < 3 or not np.ptp(levers.weight_kg) > 0.0:
        raise DataError(
            f"series {levers.name!r}: {levers.weight_kg.size} reading(s), weights from "
            f"{levers.weight_kg.min(initial=np.inf):g} kg; at least 3 with different weights are "
            "needed"
        )
    if not (np.isfinite(levers.tilt_rad).all() and levers.tilt_rad.size == levers.weight_kg.size):
        raise DataError(f"series {levers.name!r}: a tilt is missing; leave that reading out")
    largest = float(np.abs(levers.tilt_rad).max())
    if largest > 0.7:
        raise DataError(
            f"series {levers.name!r}: a tilt of {largest:.3g} rad is {np.degrees(largest):.0f} deg "
            "(limit 0.7 rad): it seems to be degrees given as radians; convert them"
        )
    if float(np.polyfit(levers.weight_kg, levers.tilt_rad, 1)[0]) <= 0.0:
        raise DataError(
            f"series {levers.name!r}: the tilt falls with the weight; tilts towards the weights "
            "are positive: turn the sign of the inclinometer"
        )


def _columns(
    series: Sequence[LeverSeries], with_offset: bool, offset: float
) -> tuple[FloatArray, FloatArray]:
    pull = np.concatenate([levers.pull_kg_m(offset) for levers in series])
    tangent = np.concatenate([np.tan(levers.tilt_rad) for levers in series])
    return np.column_stack([pull, np.ones(pull.size)][: 1 + with_offset]), tangent


def _fit(series: Sequence[LeverSeries], with_offset: bool) -> StaticMoment:
    solved = np.zeros(2)
    for _ in range(_ROUNDS):
        matrix, tangent = _columns(series, with_offset, float(solved[1]) if with_offset else 0.0)
        inverse = np.linalg.inv(matrix.T @ matrix)
        solved = inverse @ (matrix.T @ tangent)
    residual = tangent - matrix @ solved
    freedom = max(tangent.size - matrix.shape[1], 1)
    variance = float(residual @ residual) / freedom
    slope, spread = float(solved[0]), float(np.sqrt(inverse[0, 0] * variance))
    moment = Estimate.of(1.0 / slope, spread / slope**2, "kg m", float(freedom))
    offset = exactly(0.0, "rad")
    if with_offset:
        error = float(np.sqrt(inverse[1, 1] * variance))
        offset = Estimate.of(float(solved[1]), error, "rad", float(freedom))
    return StaticMoment(
        moment, offset, float(np.sqrt(variance)), tuple(levers.name for levers in series)
    )


def _readings(series: Sequence[LeverSeries], with_offset: bool, offset: float) -> Redundancy:
    """Return how the readings scatter about the pooled fit."""
    matrix, tangent = _columns(series, with_offset, offset)
    names = [
        f"{levers.name} with {weight:g} kg" for levers in series for weight in levers.weight_kg
    ]
    subject = f"tilts under weights ({', '.join(levers.name for levers in series)})"
    agreement = scattered_fit(matrix, tangent, subject=subject, results=_MOMENT, data=names)
    return agreement.of(_MOMENT, lambda unknowns: 1.0 / unknowns[..., :1])


def _between_levers(
    pooled: StaticMoment, single_fits: tuple[StaticMoment, ...]
) -> tuple[StaticMoment, tuple[Redundancy, ...]]:
    """Let the scatter between levers into the uncertainty, where it is the larger."""
    if len(single_fits) < 2:
        return pooled, ()
    moments = joint(single.moment for single in single_fits)
    names = [single.series[0] for single in single_fits]
    unit_column = np.ones((len(single_fits), 1))
    _, agreement = best_fit(unit_column, moments, subject="levers", results=_MOMENT, data=names)
    between = float(moments.values.std(ddof=1)) / np.sqrt(len(single_fits))
    pooled_moment = pooled.moment
    wider = between > pooled_moment.uncertainty
    if wider:
        moment = Estimate.of(
            pooled_moment.value, float(between), pooled_moment.unit, float(len(single_fits) - 1)
        )
        pooled = replace(pooled, moment=moment)
    widening = (
        float(between / pooled_moment.uncertainty)
        if wider and pooled_moment.uncertainty > 0.0
        else 1.0
    )
    cause = "the scatter between the levers" if wider else ""
    return pooled, (replace(agreement, widening=widening, cause=cause),)


def _flags(series: Sequence[LeverSeries], redundancy: tuple[Redundancy, ...]) -> tuple[Flag, ...]:
    flags = []
    if len({levers.lever_m for levers in series}) < 2:
        message = (
            f"only one lever ({series[0].lever_m:g} m): a series that is wrong as a whole would "
            "not be seen (one was by 8 %); measure at a second lever"
        )
        flags.append(Flag("single_lever", Severity.WARNING, message))
    flags += [flag for agreement in redundancy for flag in agreement.flags()]
    return tuple(flags)
