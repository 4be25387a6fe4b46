"""What an effect and the free coefficients do together beyond the sum of what each does alone.

Coefficients are free to first order, about the nominal rig. A gain of 3 % also multiplies what an
added mass that is 20 % off changes, and a phase of 0.03 rad turns it: some sigma in a good record.
Left alone, a second effect would take the credit for that.
"""

from collections.abc import Sequence

from analysis.gap.forward.free_numbers import Free, with_coefficients
from analysis.gap.forward.problem import Problem, built
from analysis.gap.search.fit import Fit, most_probable, weighed_at
from hardware.description.arrays import FloatArray
from hardware.description.errors import PmmError

_ROUNDS = 2


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
        best = moved
    return best if best.log_evidence > fit.log_evidence else fit


def _round(problem: Problem, free: Sequence[Free], fit: Fit) -> Fit:
    shared = problem.nuisances.fitted(problem.residual - fit.signature)[: len(free)]
    units = fit.units
    for _ in range(2):  # once with the parameters as they are, once with those that then fit
        signature = signature_on(problem, free, shared, fit, units)
        found = weighed_at(problem, fit.candidates, units, fit.columns, signature)
        units = most_probable(found)
    return found


def signature_on(
    problem: Problem, free: Sequence[Free], shared: FloatArray, fit: Fit, units: FloatArray
) -> FloatArray:
    """Return what the effects change on the rig as its coefficients are fitted, in sigma.

    What has to be simulated in time is taken from the rig as it is believed to be.

    Parameters
    ----------
    shared
        Coefficients and settings in units of their priors, shape ``(free,)``.
    units
        Parameters of the effects, as those of the fit.
    """
    effects = built(fit.candidates, units)
    values = [float(unit) * one.deviation for unit, one in zip(shared, free, strict=True)]
    settings = tuple(
        one.effect(value) for one, value in zip(free, values, strict=True) if one.effect
    )
    simulator = problem.simulator
    moving = tuple(one for one in effects if not one.repeats)
    beside = simulator.predict(moving) - simulator.nominal if moving else 0.0
    simulator = simulator.with_rig(with_coefficients(simulator.rig, free, list(shared)))
    steady = tuple(one for one in effects if one.repeats)
    change = simulator.steady((*settings, *steady)) - simulator.steady(settings)
    return problem.whitened(change + beside)
