"""How far to trust coefficients: weights of the runs, misfit, digits lost, what was left out."""

import math
from collections.abc import Sequence

import numpy as np

from analysis.coefficients.determined import ALONE, motion_words
from analysis.coefficients.model import Problem
from analysis.coefficients.names import Form, Place
from analysis.coefficients.phasors import ComplexArray, FloatArray, real_form
from analysis.coefficients.run import LOADS, MOTIONS, Run
from analysis.motion import incidence, mass_matrix, weight_matrix
from hardware.description.flags import Flag, Severity

_NOTICED = 1e-3
_DIGIT = 0.1
_DISAGREE = 3.0
_POOLED_FREEDOM = 20.0


def run_weights(problem: Problem) -> FloatArray:
    """Return one over the scatter of each run's residual, shape ``(runs, 2)``; 1 if unknown.

    Scalars by run and load, and not whole matrices: a covariance from a few periods makes a poor
    metric, while any fixed weights leave the result unbiased and its propagated covariance right.
    A run's own variance counts as far as its degrees of freedom go beside :data:`_POOLED_FREEDOM`
    of the runs' mean: weights that follow the luck of three periods would be too sure of it.
    """
    variance = residual_spread(problem, problem.nominal()) ** 2
    if not np.isfinite(variance).all():
        return np.ones_like(variance)
    variance = trusted(variance, np.array([_fewest(run) for run in problem.runs])[:, None])
    sizes = np.stack([np.abs(run.loads.values) for run in problem.runs])
    floor = 1e-9 * sizes.max(axis=0) + 1e-300
    return np.asarray(floor / np.maximum(np.sqrt(variance), floor))


def trusted(variance: FloatArray, degrees_of_freedom: FloatArray) -> FloatArray:
    """Return variances of runs (first axis) shrunk towards their mean; see :func:`run_weights`."""
    trust = 1.0 / (1.0 + _POOLED_FREEDOM / np.maximum(degrees_of_freedom, 1e-9))
    return np.asarray(trust * variance + (1.0 - trust) * variance.mean(axis=0))


def _fewest(run: Run) -> float:
    return min((source.degrees_of_freedom for source in run.phasors.sources), default=math.inf)


def residual_spread(problem: Problem, matrices: FloatArray) -> FloatArray:
    """Return the standard deviation of ``load - (B + i omega A) velocity``, shape ``(runs, 2)``."""
    carry = problem.to_point[1]
    known = np.stack([run.known() for run in problem.runs])
    slope = np.concatenate((-carry @ known - asked_load(problem, matrices), carry), axis=2)
    forms = np.stack([real_form(one) for one in slope])
    spread = np.einsum("rij,rjk,rik->ri", forms, _covariances(problem.runs), forms)
    return np.asarray(np.sqrt(spread.reshape(-1, 2, 2).mean(axis=2)))


def _covariances(runs: Sequence[Run]) -> FloatArray:
    """Of motions and loads of each run, shape ``(runs, 8, 8)``."""
    return np.stack([run.phasors.select((*MOTIONS, *LOADS)).covariance for run in runs])


def asked_load(problem: Problem, matrices: FloatArray) -> ComplexArray:
    """Return ``(B + i omega A)`` times what makes the form's velocities of the motion.

    Of each run, shape ``(runs, 2, 2)``.
    """
    turns = []
    for run in problem.runs:
        turn = 1j * run.omega * np.eye(2)
        if problem.form is Form.MANOEUVRING:
            turn = turn + run.speed_m_s * math.cos(run.drift_rad) * incidence(run.plane)
        turns.append(turn)
    turned = np.stack(turns) @ problem.to_point[0]
    omega = np.array([run.omega for run in problem.runs])
    dynamic = matrices[..., 1] + 1j * omega[:, None, None] * matrices[..., 0]
    return np.asarray(dynamic @ turned[:, list(problem.columns)])


def misfit_of(problem: Problem, matrices: FloatArray) -> float:
    """Return the residuals over their expected size; NaN without any left over."""
    spare = 4 * (len(problem.runs) - len(problem.columns))
    if spare == 0:
        return math.nan
    spread = residual_spread(problem, matrices)
    asked = asked_load(problem, matrices)
    residuals = np.stack(
        [
            run.net().values - one @ run.motion.values
            for run, one in zip(problem.runs, asked, strict=True)
        ]
    )
    floor = 1e-9 * np.abs(np.stack([run.loads.values for run in problem.runs])).max(axis=0)
    ratio = np.abs(residuals) / np.maximum(spread, floor + 1e-300)
    return float(np.sqrt((ratio**2).sum() / spare))


def retained_parts(problem: Problem, matrices: FloatArray) -> FloatArray:
    """Return each coefficient's part of the load over the largest it is left from, ``(n,)``."""
    velocity, omega = problem.velocities()
    size = np.abs(velocity)
    found = []
    for place in problem.places():
        run = problem.runs[int(np.argmax(size[:, place.column]))]
        speed = float(size[:, place.column].max())
        if place.inertial:
            speed *= float(omega[0])
        value = matrices[place.row, problem.columns.index(place.column), 0 if place.inertial else 1]
        own = abs(float(value)) * speed
        found.append(own / max(own, _largest_part(run, place.row), 1e-300))
    return np.array(found)


def _largest_part(run: Run, row: int) -> float:
    """Largest of the gross load and what inertia, weight and restoring ask of it."""
    motion = run.motion.values
    parts = [abs(run.loads.values[row]), abs((run.restoring @ motion)[row])]
    if run.body is not None:
        inertia = run.omega**2 * mass_matrix(run.body, run.plane)
        parts += [abs((inertia @ motion)[row])]
        parts += [abs((weight_matrix(run.body, run.plane) @ motion)[row])]
    return float(max(parts))


def quality_flags(
    problem: Problem,
    names: tuple[str, ...],
    places: tuple[Place, ...],
    retained: FloatArray,
    misfit: float,
    covariance: FloatArray,
) -> tuple[Flag, ...]:
    """Return the runs' own flags and what the coefficients add."""
    found = [flag.of(run.name) for run in problem.runs for flag in run.flags]
    own = tuple(run.name for run in problem.runs)
    for name, place, part in zip(names, places, retained, strict=True):
        if part < _DIGIT:
            what = "gain, mass or restoring" if place.inertial else "phase (in radians)"
            text = (
                f"{name} is {100.0 * part:.2g} % of the largest part of the load (limit "
                f"{100 * _DIGIT:g} %): an error in {what} is {1.0 / max(part, 1e-12):.3g} times "
                "as large in it"
            )
            found.append(Flag("digits_lost", Severity.WARNING, text, name, own))
    if misfit > _DISAGREE:
        text = (
            f"the runs differ {misfit:.2g} times as much as their scatter (limit {_DISAGREE:g}): "
            "amplitude, alignment or a force that is not linear; solve them apart"
        )
        found.append(Flag("runs_disagree", Severity.WARNING, text, None, own))
    if not np.isfinite(covariance).all():
        text = "a run has too few periods for scatter: no interval can be given"
        found.append(Flag("no_interval", Severity.WARNING, text, None, own))
    return (*found, *_neglected(problem))


def _neglected(problem: Problem) -> tuple[Flag, ...]:
    if len(problem.columns) == 2:
        return ()
    velocity, _ = problem.velocities()
    moved = np.abs(velocity * np.array([1.0, problem.runs[0].half_spacing_m])).max(axis=0)
    column = problem.columns[0]
    part = moved[1 - column] / moved[column]
    if part <= _NOTICED:
        return ()
    words = motion_words(problem.plane, problem.form)
    text = (
        f"{words[1 - column]} of {100 * part:.2g} % of {words[column]} at the struts was left out "
        f"(limit {100 * ALONE:g} %); add a run in {words[1 - column]} to have it taken off"
    )
    own = tuple(run.name for run in problem.runs)
    return (Flag("other_motion_left_out", Severity.WARNING, text, None, own),)
