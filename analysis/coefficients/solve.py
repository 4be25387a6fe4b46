"""Coefficients from one run or from several at one frequency.

A run in heave alone tells the coefficients of heave, one in pitch those of pitch; runs in which
both move (pure pitch at forward speed moves the midpoint too) are solved together, by least squares
with the weight of each run's scatter. What the runs cannot tell is refused, with the run it takes.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from analysis.coefficients.determined import check_together, lacking, mixed, told_apart
from analysis.coefficients.model import Problem, Stated
from analysis.coefficients.names import Form, name_of, place_of
from analysis.coefficients.quality import misfit_of, quality_flags, retained_parts, run_weights
from analysis.coefficients.result import Coefficients, Conditions
from analysis.coefficients.run import Run
from analysis.coefficients.uncertainty import freedom, linear_shares
from hardware.description.errors import DataError


def solve(
    runs: Sequence[Run],
    form: Form = Form.SEAKEEPING,
    *,
    stated: Stated = Stated(),  # noqa: B008 - frozen
    wanted: Sequence[str] | None = None,
) -> Coefficients:
    """Return all coefficients that the runs determine.

    Parameters
    ----------
    runs
        Of one oscillator, at one frequency and speed, with what is known to be taken off
        (:meth:`analysis.coefficients.run.Run.without`).
    stated
        Standard uncertainties of what all runs share.
    wanted
        Names that have to be there, and no others; by default all that can be had.

    Raises
    ------
    ConfigurationError
        If the runs do not belong together, or a name is unknown.
    DataError
        If a wanted coefficient is not determined: the message says which run would do it.
    """
    check_together(runs)
    for name in wanted or ():
        place_of(name, runs[0].plane, form)
    problem = _problem(tuple(runs), form, wanted)
    matrices = problem.nominal()
    covariance, shares = linear_shares(problem, stated)
    places = problem.places()
    names = tuple(name_of(place, problem.plane, form) for place in places)
    values = problem.flat(matrices[None])[0]
    retained = retained_parts(problem, matrices)
    misfit = misfit_of(problem, matrices)
    flags = quality_flags(problem, names, places, retained, misfit, covariance)
    result = Coefficients(
        form,
        _conditions(problem),
        names,
        tuple(place.unit for place in places),
        values,
        covariance,
        freedom(shares, len(values)),
        shares,
        retained,
        misfit,
        flags=flags,
    )
    return result if wanted is None else _only(result, wanted)


def problem_of(runs: Sequence[Run], form: Form = Form.SEAKEEPING) -> Problem:
    """Return the problem that :func:`solve` solves, for a Monte Carlo beside it.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`solve`.
    """
    check_together(runs)
    return _problem(tuple(runs), form, None)


def _problem(runs: tuple[Run, ...], form: Form, wanted: Sequence[str] | None) -> Problem:
    everything = Problem(runs, form, (0, 1), np.ones((len(runs), 2)))
    velocity, _ = everything.velocities()
    moved = velocity * np.array([1.0, runs[0].half_spacing_m])
    columns = told_apart(runs, moved)
    for name in wanted or ():
        place = place_of(name, runs[0].plane, form)
        if place.column not in columns:
            raise DataError(lacking(name, place, runs, form, moved))
    if not columns:
        raise DataError(mixed(runs, form, moved))
    first = Problem(runs, form, columns, np.ones((len(runs), 2)))
    return Problem(runs, form, columns, run_weights(first))


def _conditions(problem: Problem) -> Conditions:
    first = problem.runs[0]
    motion = np.abs(np.stack([run.motion.values for run in problem.runs])).max(axis=0)
    return Conditions(
        problem.plane,
        first.frequency_hz * first.order,
        first.speed_m_s,
        float(motion[0]),
        float(motion[1]),
        first.point_ahead_m,
        tuple(run.name for run in problem.runs),
    )


def _only(result: Coefficients, wanted: Sequence[str]) -> Coefficients:
    rows = [result.index(name) for name in wanted]
    left_out = set(result.names) - set(wanted)
    return replace(
        result,
        names=tuple(wanted),
        units=tuple(result.units[k] for k in rows),
        values=result.values[rows],
        covariance=result.covariance[np.ix_(rows, rows)],
        degrees_of_freedom=result.degrees_of_freedom[rows],
        shares=tuple(replace(share, variance=share.variance[rows]) for share in result.shares),
        retained=result.retained[rows],
        flags=tuple(flag for flag in result.flags if flag.channel not in left_out),
    )
