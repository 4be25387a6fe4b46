"""What an effect and the free coefficients do together beyond the sum of what each does alone.

Coefficients are free to first order, about the nominal rig. A gain of 3 % also multiplies what an
added mass that is 20 % off changes, and a phase of 0.03 rad turns it: some sigma in a good record.
Left alone, a second effect would take the credit for that.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from analysis.gap.forward.free_numbers import Free, with_coefficients
from analysis.gap.forward.problem import Problem, built
from analysis.gap.forward.simulator import Simulator
from analysis.gap.inference.gaussian import left_over
from analysis.gap.search.fit import Fit, most_probable, weighed_at
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError
from sim.effects.effect import Effect

_ROUNDS = 2
_LEVEL: Final = 0.1  # sigma of all observations together, below which a change is none


def together(problem: Problem, free: Sequence[Free], fit: Fit) -> Fit:
    """Return a fit whose signature holds what effect and coefficients do together.

    A pair with an effect that is costly to simulate is left as it is.

    Parameters
    ----------
    free
        The nuisances' first columns; without any the fit is returned as it is.
    """
    dear = len(fit.candidates) > 1 and fit.is_costly
    if dear or not free or not any(one.repeats for one in fit.candidates):
        return fit
    best = fit
    for _ in range(_ROUNDS):
        try:
            moved = _round(problem, free, best)
        except PmmError:
            break
        change, best = moved.signature - best.signature, moved
        if left_over(change, problem.nuisances) < _LEVEL:
            break
    return best if best.log_evidence > fit.log_evidence else fit


def _round(problem: Problem, free: Sequence[Free], fit: Fit) -> Fit:
    shared = problem.nuisances.fitted(problem.residual - fit.signature)[: len(free)]
    units, there = fit.units, FittedRig.of(problem, free, shared)
    for _ in range(2):  # once with the parameters as they are, once with those that then fit
        signature = there.signature(fit, units)
        found = weighed_at(problem, fit.candidates, units, fit.columns, signature)
        way, units = most_probable(found) - units, most_probable(found)
        if left_over(fit.columns @ way, problem.nuisances) < _LEVEL:
            break
    return found


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
            one.effect(float(unit) * one.deviation)
            for unit, one in zip(shared, free, strict=True)
            if one.effect
        )
        rig = with_coefficients(problem.simulator.rig, free, list(shared))
        return cls(problem, problem.simulator.with_rig(rig), settings)

    @cached_property
    def _base(self) -> FloatArray:
        return self.simulator.steady(self.settings)

    def signature(self, fit: Fit, units: FloatArray) -> FloatArray:
        """Return what effects change at some parameters, in sigma, shape ``(observations,)``.

        What has to be simulated in time is taken from the rig as it is believed to be.
        """
        effects = built(fit.candidates, units)
        moving = tuple(one for one in effects if not one.repeats)
        steady = tuple(one for one in effects if one.repeats)
        believed = self.problem.simulator
        beside = believed.predict(moving) - believed.nominal if moving else 0.0
        change = self.simulator.steady((*self.settings, *steady)) - self._base
        return self.problem.whitened(change + beside)
