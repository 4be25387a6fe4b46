"""The periodic steady state with a clearance: run until one period repeats the last.

A clearance that opens twice a period has no balance of harmonics that sweeps could find; it is run
in time instead, with steps that fit its fastest vibration.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np

from hardware.description.arrays import FloatArray
from sim.solve.period import Period

_STEP_RAD: Final = 0.3  # of the fastest vibration, at most
_SUBSTEP_RAD: Final = 0.3
_DAMPED: Final = 0.1  # damping ratio from which what a clearance gives back settles at any step
_MOST_DOUBLED: Final = 10
_SETTLED: Final = 1e-7  # what solving sample by sample leaves is below 3e-8
_MOST_PERIODS: Final = 64
_AVERAGED: Final = 32  # periods, where they never become the same


def fine_enough(period: Period, rates: FloatArray) -> Period:
    """Return the period with points that follow the fastest vibration of a linear system.

    What only decays needs no points: the steps are exact for it.
    """
    fastest = float(np.abs(np.linalg.eigvals(rates).imag).max(initial=0.0))
    points = period.points
    for _ in range(_MOST_DOUBLED):
        if fastest / (points * period.frequency_hz) <= _STEP_RAD:
            break
        points *= 2
    return replace(period, points=points)


def substeps(rates: FloatArray, step_s: float) -> int:
    """Return into how many steps to part one for a clearance in a linear system.

    What the clearance gives back goes on between samples by the polynomial of those before. With a
    vibration that the samples do not follow and that hardly decays, that feeds it.
    """
    eigenvalues = np.linalg.eigvals(rates)
    ringing = eigenvalues[
        (eigenvalues.imag > 0.0) & (-eigenvalues.real < _DAMPED * np.abs(eigenvalues))
    ]
    return max(math.ceil(step_s * float(ringing.imag.max(initial=0.0)) / _SUBSTEP_RAD), 1)


def last_period(
    run: Callable[[Any, int], tuple[Any, Mapping[str, FloatArray]]],
    start: Any,
    watched: tuple[str, ...],
    ahead: Callable[[Any, Any], Any] = lambda _, after: after,
) -> dict[str, FloatArray]:
    """Return the signals over a period after which they repeat.

    What never repeats, because it bounces otherwise every time, is averaged over the last periods,
    as an analysis of a record does.

    Parameters
    ----------
    run
        Takes a state and the number of the period; returns the state after it and its signals.
    watched
        The signals that have to repeat.
    ahead
        Takes the states at both ends of a period; returns the one to begin the next period from.
        What dies out slowly and is linear need not be waited for.
    """
    state, before, periods = start, None, []
    for turn in range(_MOST_PERIODS):
        after, values = run(state, turn)
        state = ahead(state, after)
        now = np.array([values[name] for name in watched])
        if before is not None:
            size = np.abs(now).max(axis=1, keepdims=True)
            if (np.abs(now - before) <= _SETTLED * size).all():
                return dict(values)
        before = now
        if turn >= _MOST_PERIODS - _AVERAGED:
            periods.append(values)
    return {name: np.mean([period[name] for period in periods], axis=0) for name in periods[0]}
