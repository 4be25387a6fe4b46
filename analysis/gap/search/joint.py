"""What an effect and the free coefficients do together beyond the sum of what each does alone.

Coefficients are free to first order, about the nominal rig. A gain of 3 % also multiplies what an
added mass that is 20 % off changes, and a phase of 0.03 rad turns it: some sigma in a good record.
Left alone, a second effect would take the credit for that.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Axis, Candidate
from analysis.gap.forward.free_numbers import Free, with_coefficients
from analysis.gap.forward.problem import Problem, built
from analysis.gap.forward.simulator import Simulator
from analysis.gap.inference.gaussian import Nuisances, left_over
from analysis.gap.search.fit import Fit, weighed_at
from analysis.gap.search.refinement import follow, in_reach, relinearised_or_same
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.effects.effect import Effect, Parameter

_LEVEL: Final = 1.0  # sigma of all observations together, below which slopes are as they were
_STEPS: Final = 6


def fit_jointly(problem: Problem, free: Sequence[Free], fit: Fit, least: float = math.inf) -> Fit:
    """Return a fit whose signature holds what effect and coefficients do together.

    All of them are fitted at once, each step simulated on the rig as its coefficients then are. A
    pair with an effect that is costly to simulate is left as it is.

    Parameters
    ----------
    free
        The nuisances' first columns; without any the fit is returned as it is.
    least
        Cost of a rival. What the coefficients cannot bring down to it is simulated once.
    """
    if _is_dear(fit) or not free or not any(candidate.repeats for candidate in fit.candidates):
        return fit
    joint_problem, count = _JointProblem(problem, free), len(free)
    columns = problem.nuisances.columns[:, :count]
    shared = problem.nuisances.fitted(problem.residual - fit.signature)[:count]
    try:
        joint_fit = joint_problem.initial_fit(fit, shared)
    except PmmError:
        return fit
    beyond = left_over(joint_fit.signature - fit.signature - columns @ shared, problem.nuisances)
    if beyond > _LEVEL and in_reach(joint_fit, beyond, least):
        joint_fit = follow(joint_problem, relinearised_or_same(joint_problem, joint_fit), _STEPS)
    effect_units, shared = joint_fit.units[:-count], joint_fit.units[-count:]
    signature = joint_fit.signature - columns @ shared
    return weighed_at(
        problem, fit.candidates, effect_units, joint_fit.columns[:, :-count], signature
    )


def with_numbers(problem: Problem, free: Sequence[Free], fit: Fit) -> Fit:
    """Return a fit with the free numbers as parameters behind its own, linearised where they are.

    Of a pair with an effect that is costly to simulate the slopes stay as they were.

    Parameters
    ----------
    free
        The nuisances' first columns.
    """
    joint_problem = _JointProblem(problem, free)
    shared = problem.nuisances.fitted(problem.residual - fit.signature)[: len(free)]
    try:
        joint_fit = joint_problem.initial_fit(fit, shared)
    except PmmError:  # beyond what a rig can be; as it is believed to be it has been simulated
        joint_fit = joint_problem.initial_fit(fit, np.zeros(len(free)))
    return joint_fit if _is_dear(fit) else relinearised_or_same(joint_problem, joint_fit)


def _is_dear(fit: Fit) -> bool:
    return len(fit.candidates) > 1 and fit.is_costly


@dataclass(frozen=True, eq=False)
class _JointProblem:
    """A problem whose free numbers are fitted as an effect's parameters are."""

    problem: Problem
    free: Sequence[Free]

    @property
    def residual(self) -> FloatArray:
        return self.problem.residual

    @property
    def stated(self) -> FloatArray:
        return self.problem.stated

    @cached_property
    def nuisances(self) -> Nuisances:
        nuisances, count = self.problem.nuisances, len(self.free)
        return Nuisances(nuisances.columns[:, count:], nuisances.names[count:], nuisances.always_on)

    @cached_property
    def numbers(self) -> Candidate:
        """The free numbers, in units of their priors, as what stands beside the effects."""
        limits = (-math.inf, math.inf)
        each = (Parameter(number.name, "1", 0.0, *limits, number.name) for number in self.free)
        axes = tuple(Axis(parameter, 0.0, 1.0, is_log=False) for parameter in each)
        return Candidate(Free, axes, {}, "")

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """Return what the effects and the free numbers change together."""
        effect_units, shared = units[: -len(self.free)], units[-len(self.free) :]
        rig = FittedRig.of(self.problem, self.free, shared)
        return rig.change(built(parts[:-1], effect_units))

    def initial_fit(self, fit: Fit, shared: FloatArray) -> Fit:
        """Return a fit with the free numbers at some units, each with the slopes that it has.

        Raises
        ------
        PmmError
            If they cannot be simulated together.
        """
        parts, units = (*fit.candidates, self.numbers), np.concatenate((fit.units, shared))
        columns = self.problem.nuisances.columns[:, : len(shared)]
        signature = self.signature(parts, units)
        return weighed_at(self, parts, units, np.hstack((fit.columns, columns)), signature)


@dataclass(frozen=True, eq=False)
class FittedRig:
    """A rig as its coefficients are fitted.

    Attributes
    ----------
    problem
        The rig as it is believed to be.
    simulator, settings
        The rig with the coefficients, and its settings.
    """

    problem: Problem
    simulator: Simulator
    settings: tuple[Effect, ...]

    @classmethod
    def of(cls, problem: Problem, free: Sequence[Free], shared: FloatArray) -> "FittedRig":
        """Return the rig with coefficients and settings in units of their priors, ``(free,)``."""
        settings = tuple(
            number.effect(float(unit) * number.deviation)
            for unit, number in zip(shared, free, strict=True)
            if number.effect
        )
        rig = with_coefficients(problem.simulator.rig, free, list(shared))
        return cls(problem, problem.simulator.with_rig(rig), settings)

    def signature(self, parts: Sequence[Candidate], units: FloatArray) -> FloatArray:
        """Return what effects change there at some parameters, in sigma, ``(observations,)``."""
        return self.change(built(parts, units)) - self.change(())

    def change(self, effects: Sequence[Effect]) -> FloatArray:
        """Return what all of it changes of the rig as it is believed to be, with effects on, too.

        What has to be simulated in time is taken from the rig as it is believed to be.
        """
        moving = tuple(effect for effect in effects if not effect.repeats)
        steady = tuple(effect for effect in effects if effect.repeats)
        believed = self.problem.simulator
        beside = believed.predict(moving) - believed.nominal if moving else 0.0
        change = self.simulator.steady((*self.settings, *steady)) - self.problem.steady
        return self.problem.whitened(change + beside)
