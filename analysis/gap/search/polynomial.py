"""The free polynomial control: what a force law without physics makes of the same gap.

Each strut's force may have any polynomial of third degree in that strut's displacement and
velocity, and its acceleration, in water and in air alike. It is fitted and judged on the withheld
regimes as the effects are. An effect that predicts no better than that explains nothing.
"""

from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import left_over, misfit, posterior
from analysis.gap.observe.components import Component, GapRun, Part, Stack
from analysis.gap.search.fit import Fit
from hardware.description.arrays import BoolArray, ComplexArray, FloatArray
from hardware.description.channels import FORCES

Moved = tuple[FloatArray, FloatArray, FloatArray]

DEGREE: Final = 3
_POINTS: Final = 128
_SIZES: Final = (1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0)  # of a term's prior, in sigma


def polynomial(problem: Problem, fitted: BoolArray | None = None) -> Fit:
    """Return the control as a hypothesis without a name, its prior as wide as fits best.

    Parameters
    ----------
    fitted
        Observations by which to judge that, shape ``(observations,)``; all if not given.
    """
    return _fit(problem, _scaled_terms(problem, problem.simulator.stack, fitted))


def polynomial_ahead(problem: Problem, problem_ahead: Problem) -> FloatArray:
    """Return the control's columns at further runs, in the units that it has in the campaign.

    Shape ``(observations there, terms)``.
    """
    return _scaled_terms(problem, problem_ahead.simulator.stack)


def _scaled_terms(problem: Problem, stack: Stack, fitted: BoolArray | None = None) -> FloatArray:
    """Return all terms over the runs of a stack, each as wide as its prior in the campaign."""
    rows = np.ones(len(problem.residual), dtype=bool) if fitted is None else fitted
    raw = _raw_terms(problem.simulator.stack, problem.simulator.stack)
    sizes = np.array([left_over(column, problem.nuisances) for column in raw.T])
    shown = sizes > 1e-6
    unit = raw[:, shown] / sizes[shown]
    size = max(_SIZES, key=lambda width: log_evidence(problem, width * unit, rows))
    return np.asarray(size * _raw_terms(problem.simulator.stack, stack)[:, shown] / sizes[shown])


def _raw_terms(made: Stack, stack: Stack) -> FloatArray:
    """Return each term's components over a stack in sigma, scaled by the motions that were made."""
    terms = [term for channel in FORCES for term in _terms(made, stack, channel)]
    return np.asarray(np.column_stack(terms) / stack.uncertainty[:, None])


def _fit(problem: Problem, columns: FloatArray) -> Fit:
    """Return the hypothesis that the residual is a sum of columns with unit normal weights."""
    estimate = posterior(problem.residual, columns, problem.nuisances)
    signature = columns @ estimate.mean
    cost = misfit(problem.residual - signature, problem.nuisances)
    cost += float(estimate.mean @ estimate.mean)
    shared = problem.nuisances.log_determinant
    return Fit((), estimate.mean, columns, signature, cost, estimate, shared, columns[:, :0])


def log_evidence(problem: Problem, columns: FloatArray, rows: BoolArray) -> float:
    """Return the evidence of a sum of columns with unit normal weights, on some observations."""
    part, residual = problem.nuisances.among(rows), problem.residual[rows]
    estimate = posterior(residual, columns[rows], part)
    cost = misfit(residual - columns[rows] @ estimate.mean, part) + float(
        estimate.mean @ estimate.mean
    )
    return -0.5 * (cost + part.log_determinant) + estimate.log_volume


def motion(run: GapRun, channel: str) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return displacement, velocity and acceleration of a force's strut over a period.

    Returns
    -------
    tuple
        In m, m/s and m/s², each of shape ``(points,)``, from shaft angle 0 on.
    """
    point = run.set_point
    ahead = point.strut_phase_rad if channel == FORCES[1] else 0.0
    angle = 2.0 * np.pi * np.arange(_POINTS) / _POINTS + ahead
    omega, radius = 2.0 * np.pi * point.frequency_hz, point.eccentricity_m
    return (
        radius * np.sin(angle),
        radius * omega * np.cos(angle),
        -radius * omega**2 * np.sin(angle),
    )


def scaled_motion(stack: Stack, channel: str, made: Stack | None = None) -> list[Moved]:
    """Return each run's motion over the largest of a campaign, the runs' own by default."""
    usual = [motion(run, channel) for run in (made or stack).runs]
    scale = [
        max(float(np.abs(run_motion[at]).max()) for run_motion in usual) or 1.0 for at in range(3)
    ]
    return [
        (x / scale[0], v / scale[1], a / scale[2])
        for x, v, a in (motion(run, channel) for run in stack.runs)
    ]


def _terms(made: Stack, stack: Stack, channel: str) -> list[FloatArray]:
    moved = scaled_motion(stack, channel, made)
    laws = [(i, j) for i in range(DEGREE + 1) for j in range(DEGREE + 1 - i) if i + j]
    terms = []
    for i, j in laws:
        forces = [x**i * v**j for x, v, _ in moved]
        terms.append(components_of(stack, channel, forces))
    terms.append(components_of(stack, channel, [a for _, _, a in moved]))
    return terms


def components_of(stack: Stack, channel: str, forces: Sequence[FloatArray]) -> FloatArray:
    """Return the components of a force that is given over a period of each run.

    Parameters
    ----------
    forces
        For each run, shape ``(points,)``, from shaft angle 0 on.

    Returns
    -------
    FloatArray
        Shape ``(observations,)``; 0 in other channels and in what does not repeat.
    """
    spectra = [np.fft.rfft(force) / len(force) for force in forces]
    return np.array(
        [
            _part(component, spectra[run]) if component.channel == channel else 0.0
            for component, run in zip(stack.components, stack.run, strict=True)
        ]
    )


def _part(component: Component, spectrum: ComplexArray) -> float:
    if component.part is Part.MEAN:
        return float(spectrum[0].real)
    if component.part is Part.IN_PHASE:
        return -2.0 * float(spectrum[component.order].imag)
    if component.part is Part.QUADRATURE:
        return 2.0 * float(spectrum[component.order].real)
    return 0.0
