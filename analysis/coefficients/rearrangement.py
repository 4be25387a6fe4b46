"""The coefficients if the rig were arranged otherwise than stated, and the evidence for it.

The fit is a function of the arrangement: joint, pivot, gauges and the way a drift is set. Each fit
of a campaign is made once more under each alternative of one key, with the same weights.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Final

import numpy as np

from analysis.coefficients.body_axes import parts_of_struts
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.form_choice import DESCRIBES
from analysis.coefficients.hull_cycle import (
    TURNS,
    HullParts,
    by_turn,
    inputs_of,
    loads_asked,
    stated_at_instants,
    to_point,
)
from analysis.coefficients.phasors import interleaved
from analysis.coefficients.tare import Tare
from analysis.kinematics.body_frame import CHANNELS, HEEL, HEELED, LOADS
from analysis.kinematics.cycle import harmonics, instants_of, waves
from analysis.kinematics.geometry import Geometry
from hardware.description.arrangement import Arrangement, Joint
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.heel import HeelGauges

_OF_STRUTS: Final = ("joint", "pivot")  # what a turntable has not


@dataclass(frozen=True, eq=False)
class Refits:
    """Fits under one alternative arrangement.

    Attributes
    ----------
    key, alternative
        The arrangement's key, and its value in place of the one that is stated.
    values
        Of the coefficients, in the order of the fits, shape ``(n,)``; NaN where the recordings do
        not let them be reckoned.
    evidence
        Natural logarithm of the likelihood over that of what is stated.
    """

    key: str
    alternative: str
    values: FloatArray
    evidence: float


def alternatives(arrangement: Arrangement) -> tuple[tuple[str, Arrangement], ...]:
    """Return each arrangement that differs in one key, with that key's name.

    A turntable is no alternative to two struts, nor they to it: their channels are others.
    """
    arrangements = []
    table = arrangement.joint is Joint.YAW_TABLE
    for key in (
        field.name for field in fields(arrangement) if not (table and field.name in _OF_STRUTS)
    ):
        stated = getattr(arrangement, key)
        ways = [way for way in type(stated) if way not in (stated, Joint.YAW_TABLE)]
        arrangements += [(key, replace(arrangement, **{key: way})) for way in ways]
    return tuple(arrangements)


def refits(
    cycles: Sequence[BodyCycle], fits: Sequence[CycleFit], judged: Sequence[CycleFit]
) -> tuple[Refits, ...]:
    """Return fits under each alternative; none where a run's readings are not known.

    Parameters
    ----------
    cycles
        Of all fits.
    judged
        The fits that tell by what they leave over: one for each load, of all runs, in the richest
        form, so that a wrong form does not speak for an arrangement.
    """
    if not all(len(cycle.readings) for cycle in cycles):
        return ()
    arrangement = cycles[0].arrangement
    ways = alternatives(arrangement)
    table = _parts(cycles, [way for _, way in ways])
    refitted = [_refitted(fit, table)[0] for fit in fits]
    values = np.concatenate(refitted, axis=1) if fits else np.zeros((len(ways), 0))
    evidence = sum((_evidence(fit, table) for fit in judged), np.zeros(len(ways)))
    return tuple(
        Refits(key, str(getattr(way, key)), values[k], float(evidence[k]))
        for k, (key, way) in enumerate(ways)
    )


def _parts(cycles: Sequence[BodyCycle], ways: Sequence[Arrangement]) -> dict[str, FloatArray]:
    """Return the hull's interleaved parts by run and arrangement, ``(2 n, ways)`` of each run."""
    by_kind: dict[tuple[object, ...], list[BodyCycle]] = {}
    for cycle in cycles:
        by_kind.setdefault((cycle.channels, cycle.readings.shape), []).append(cycle)
    parts_of_key: dict[str, FloatArray] = {}
    for kind_cycles in by_kind.values():
        gross, tares = zip(*(_gross(kind_cycles, way) for way in ways), strict=True)
        parts = _on_hull(np.stack(gross), Tare.stacked(tares), kind_cycles)
        parts_of_key |= {part.name: parts[:, k].T for k, part in enumerate(kind_cycles)}
    return parts_of_key


def _gross(cycles: Sequence[BodyCycle], way: Arrangement) -> tuple[FloatArray, Tare]:
    """Return gross parts and ``tare``; NaN where the alternative does not let them be had."""
    speed, drift = np.array([[cycle.speed_m_s, cycle.drift_rad] for cycle in cycles]).T[..., None]
    stated_parts = np.stack([interleaved(cycle.phasors.values) for cycle in cycles])
    rests = Tare.stacked([cycle.tare for cycle in cycles])
    stated = cycles[0].arrangement
    if not drift.any() and replace(way, drift_by=stated.drift_by) == stated:
        return stated_parts, rests
    first = cycles[0]
    rolling = len([name for name in first.channels if name in HEELED[len(CHANNELS) :]])
    heeled = first.heel is not None and first.heel.gauges is HeelGauges.HEELED
    varies = np.stack(
        [cycle.varies_m_s * np.ones(instants_of(first.orders + 1)) for cycle in cycles]
    )
    half = first.half_spacing_m
    geometry = Geometry(first.plane, half, way, speed, drift, heeled, varies)
    omega = np.array([2.0 * np.pi * cycle.frequency_hz for cycle in cycles])
    readings = np.stack([cycle.readings for cycle in cycles])
    try:
        return parts_of_struts(readings, geometry, omega, rolling)
    except DataError:  # no force_x, or the struts cannot reach
        return np.full_like(stated_parts, np.nan), rests


def _refitted(fit: CycleFit, table: Mapping[str, FloatArray]) -> tuple[FloatArray, FloatArray]:
    problem = fit.problem
    parts = np.stack(
        [problem.numbers.of_cycle(cycle, table[cycle.name]) for cycle in problem.numbers.cycles]
    )
    return fit.refitted(np.moveaxis(parts, -1, 0))


def _evidence(fit: CycleFit, table: Mapping[str, FloatArray]) -> FloatArray:
    """Half the difference of the squares, less by what even the better leaves over.

    Where the better leaves more than :data:`DESCRIBES` allows, the form is wrong whatever the
    arrangement is, and the squares are no evidence of it.
    """
    squares, row = _refitted(fit, table)[1], fit.terms[0].row
    spare = fit.data[row] - len(fit.terms)
    if not spare > 0.0:
        return np.zeros(len(squares))
    stated = fit.chi_square[row]
    dispersion = np.maximum(1.0, np.minimum(squares[:, row], stated) / spare)
    difference = (stated - squares[:, row]) / (2.0 * dispersion)
    return np.where(dispersion > DESCRIBES, 0.0, difference)


def _on_hull(gross: FloatArray, tare: Tare, cycles: Sequence[BodyCycle]) -> FloatArray:
    """Return the parts of :func:`analysis.coefficients.hull_cycle.on_hull` alone, of many runs.

    Parameters
    ----------
    gross, tare
        In place of the runs' own, with leading axes ``(several, runs)``.
    cycles
        Of one plane, with as many orders and the same channels.
    """
    channels, plane = cycles[0].channels, cycles[0].plane
    count = cycles[0].orders + 1
    loads = [LOADS.index(name) for name in channels if name in LOADS]
    omega = np.array([2.0 * math.pi * cycle.frequency_hz for cycle in cycles])
    rates = [
        omega[:, None, None] ** times * waves(gross, len(channels), times) for times in range(3)
    ]
    moved = np.stack(
        [rates[times][..., channel, :] for channel, times in inputs_of(channels)], axis=-2
    )
    turns = np.array([cycle.turn_rate_rad_s for cycle in cycles])
    moved[..., inputs_of(channels).index(TURNS), :] += turns[:, None]
    stated = np.stack(
        [
            stated_at_instants(
                cycle.body, cycle.drift_rad, plane, cycle.medium, cycle.heel, cycle.heel_rad
            )
            for cycle in cycles
        ]
    )
    inputs = (
        moved,
        np.broadcast_to(stated, (*moved.shape[:-2], stated.shape[-2], moved.shape[-1])),
    )
    restoring = np.stack([cycle.restoring for cycle in cycles])
    waves_in = np.concatenate(inputs, axis=-2)
    asked_waves = loads_asked(waves_in, plane, tare, restoring, HEEL in channels)[..., loads, :]
    net = HullParts(count, channels).parts(gross, harmonics(asked_waves, count - 1))
    turned = np.empty_like(net)
    for k, cycle in enumerate(cycles):
        pace, speed = float(omega[k]), cycle.speed_m_s
        shift, *_ = to_point(count, channels, cycle.point_ahead_m, plane, pace, speed)
        turned[:, k] = net[:, k] @ shift.T
        of_turn = by_turn(plane, cycle.point_ahead_m, cycle.turn_rate_rad_s)
        turned[:, k, 2 * channels.index("across")] += of_turn
    return turned
