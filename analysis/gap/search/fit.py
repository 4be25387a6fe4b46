"""Fit hypotheses through the simulator: effects where they physically act, coefficients free."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from analysis.gap.forward.candidate import STEP, Axis, Candidate
from analysis.gap.forward.problem import ComparedProblem, built
from analysis.gap.inference.answers import answer_of
from analysis.gap.inference.gaussian import Posterior, any_size, misfit, posterior
from analysis.gap.inference.hypothesis import bounded_mode
from analysis.gap.search.slopes import FINE, bounds, slopes, usual_steps
from hardware.description.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class Fit:
    """One hypothesis, fitted.

    Attributes
    ----------
    candidates
        One for a single effect, two for a pair.
    units
        The parameters in units of their priors, shape ``(p,)``.
    columns
        Change of the observations per prior unit there, in sigma, shape ``(observations, p)``.
    signature
        What the effect changes there, in sigma.
    cost
        Chi-square that is left, coefficients fitted too, and that of the parameters' priors.
    shared
        Log determinant of the nuisances.
    forms
        What the other forms of its effects' families change, in sigma, ``(observations, any)``.
    """

    candidates: tuple[Candidate, ...]
    units: FloatArray
    columns: FloatArray
    signature: FloatArray
    cost: float
    posterior: Posterior
    shared: float
    forms: FloatArray

    @property
    def names(self) -> tuple[str, ...]:
        """The effects' names."""
        return tuple(candidate.name for candidate in self.candidates)

    @property
    def answer(self) -> str:
        """The effects in alphabetical order, as an answer names them."""
        return answer_of(self.names)

    @property
    def stages(self) -> tuple[str, ...]:
        """Where each effect acts."""
        return tuple(candidate.stage for candidate in self.candidates)

    @property
    def log_evidence(self) -> float:
        """Natural log of the density of the data by Laplace, but for a constant that all share."""
        return -0.5 * (self.cost + self.shared) + self.log_volume

    @cached_property
    def log_volume(self) -> float:
        """Log of what is left of the priors' volume, whatever the scale of the effects' sizes."""
        return self.posterior.log_volume + any_size(self.posterior, self.sizes, self.reaches)

    @property
    def sizes(self) -> list[BoolArray]:
        """Which parameters are sizes, for each effect, shape ``(p,)``; those share their scale."""
        sizes = np.array([axis.is_size for axis in self.axes], dtype=bool)
        return [sizes & (self.effect_index == number) for number in range(len(self.candidates))]

    @property
    def reaches(self) -> list[float]:
        """Largest plausible standard deviation of each effect's sizes, in prior deviations."""
        return [candidate.reach for candidate in self.candidates]

    @property
    def axes(self) -> tuple[Axis, ...]:
        """The free parameters of all effects, in the order of ``units``."""
        return tuple(axis for candidate in self.candidates for axis in candidate.axes)

    @property
    def effect_index(self) -> NDArray[np.intp]:
        """Number of the effect that each parameter belongs to, shape ``(p,)``."""
        counts = [len(candidate.axes) for candidate in self.candidates]
        return np.repeat(np.arange(len(counts)), counts)

    @property
    def repeats(self) -> bool:
        """Whether all effects repeat with the shaft."""
        return all(candidate.repeats for candidate in self.candidates)

    @property
    def is_costly(self) -> bool:
        """Whether one of the effects is run in time until it repeats."""
        return any(candidate.costly for candidate in self.candidates)

    @property
    def effects(self) -> tuple[Any, ...]:
        """The effects with the fitted parameters."""
        return built(self.candidates, self.units)

    def linearised(self, residual: FloatArray) -> FloatArray:
        """Return the residual that belongs to the effect linearised where it was fitted."""
        return residual - self.signature + self.columns @ self.units


def most_probable(fit: Fit) -> FloatArray:
    """Return the most probable parameters within the plausible ranges, to first order."""
    return bounded_mode(fit.posterior, bounds(fit.candidates))


def linearised_at(
    problem: ComparedProblem,
    parts: tuple[Candidate, ...],
    units: FloatArray,
    *,
    roughly: bool = False,
    signature: FloatArray | None = None,
) -> Fit:
    """Linearise a hypothesis at some parameters and weigh it.

    Parameters
    ----------
    roughly
        Take an effect of one size as proportional to it: no further simulation for the slope.
    signature
        What it changes there, in sigma, if it has been simulated.

    Raises
    ------
    PmmError
        If the simulator cannot run it.
    """
    if signature is None:
        signature = problem.signature(parts, units)
    found = (
        [signature / units[0]]
        if roughly and is_sized(parts, units)
        else slopes(problem, parts, units, signature, usual_steps(parts, units))
    )
    columns = np.column_stack([signature[:, None][:, :0], *found])
    return weighed_at(problem, parts, units, columns, signature)


def relinearised(problem: ComparedProblem, fit: Fit) -> Fit:
    """Return a fit with slopes found where it is, as fine as its parameters are known.

    What is simulated in time has a digitiser's steps, and keeps to the usual ones.

    Raises
    ------
    PmmError
        If nothing can be simulated aside of it.
    """
    steps = usual_steps(fit.candidates, fit.units)
    if fit.repeats:
        steps = np.minimum(steps, FINE / np.sqrt(np.diagonal(fit.posterior.precision)))
    found = slopes(problem, fit.candidates, fit.units, fit.signature, steps)
    columns = np.column_stack([fit.columns[:, :0], *found])
    return weighed_at(problem, fit.candidates, fit.units, columns, fit.signature)


def is_sized(parts: tuple[Candidate, ...], units: FloatArray) -> bool:
    """Tell whether a hypothesis has one parameter, and that one is the size of its signature."""
    axes = [axis for part in parts for axis in part.axes]
    sized = len(axes) == 1 and axes[0].centre == 0.0 and not axes[0].is_log
    return sized and parts[0].repeats and abs(float(units[0])) > STEP


def no_effect(problem: ComparedProblem) -> Fit:
    """Return the hypothesis of no effect."""
    none = np.zeros_like(problem.residual)
    return weighed_at(problem, (), np.empty(0), none[:, None][:, :0], none)


def weighed_at(
    problem: ComparedProblem,
    parts: tuple[Candidate, ...],
    units: FloatArray,
    columns: FloatArray,
    signature: FloatArray,
) -> Fit:
    """Weigh a hypothesis whose columns and signature are known."""
    remainder = problem.residual - signature
    estimate = posterior(remainder + columns @ units, columns, problem.nuisances)
    cost = misfit(remainder, problem.nuisances) + float(units @ units)
    shared = problem.nuisances.log_determinant
    return Fit(parts, units, columns, signature, cost, estimate, shared, columns[:, :0])


def joined(problem: ComparedProblem, first: Fit, second: Fit) -> Fit:
    """Put two linearised hypotheses together as if their effects did not act on each other."""
    return weighed_at(
        problem,
        first.candidates + second.candidates,
        np.concatenate((first.units, second.units)),
        np.hstack((first.columns, second.columns)),
        first.signature + second.signature,
    )


def expected_evidence(problem: ComparedProblem, fit: Fit) -> float:
    """Return the evidence that one step from here promises, kept within the plausible ranges.

    For a first look at many effects: it takes no further simulation.
    """
    cost = linear_cost(problem, fit, most_probable(fit))
    return -0.5 * (cost + fit.shared) + fit.log_volume


def linear_cost(problem: ComparedProblem, fit: Fit, units: FloatArray) -> float:
    """Return what a fit would cost at other parameters, to first order."""
    remainder = fit.linearised(problem.residual) - fit.columns @ units
    return misfit(remainder, problem.nuisances) + float(units @ units)


def moved_fit(problem: ComparedProblem, fit: Fit, units: FloatArray) -> Fit:
    """Return the fit at other parameters, with the slopes that it has."""
    signature = problem.signature(fit.candidates, units)
    return weighed_at(problem, fit.candidates, units, fit.columns, signature)


def learned(problem: ComparedProblem, fit: Fit, better: Fit) -> Fit:
    """Return a moved fit with slopes that would have told where it came to (Broyden's update).

    They change by the least, each parameter counted by how well it is known.
    """
    way = better.units - fit.units
    towards = fit.posterior.precision @ way
    beyond = better.signature - fit.signature - fit.columns @ way
    columns = fit.columns + np.outer(beyond, towards) / float(way @ towards)
    return weighed_at(problem, fit.candidates, better.units, columns, better.signature)
