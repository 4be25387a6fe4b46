"""A fit as one equation weighs it: linear about where it is, with its families' other forms."""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.gap.forward.candidate import Axis
from analysis.gap.forward.problem import ComparedProblem, Problem
from analysis.gap.inference.gaussian import left_over
from analysis.gap.inference.hypothesis import Evidence, Hypothesis
from analysis.gap.search.fit import Fit, expected_evidence, weighed_at
from analysis.gap.search.refinement import follow, in_reach, refine
from analysis.gap.search.slopes import bounds
from sim.effects.effect import Effect

_BETTER: Final = 3.0  # log evidence that fitting the form has to promise: it is seldom needed


def with_forms(problem: Problem, fit: Fit) -> Fit:
    """Return a fit with what the other forms of its effects change, where they repeat."""
    simulator, effects = problem.simulator, fit.effects
    forms = list(_other_forms(fit))
    base = simulator.predict(effects) if forms else fit.signature
    columns = [np.zeros((len(base), 0))]
    for number, form in forms:
        rest = [effect for at, effect in enumerate(effects) if at != number]
        changed = simulator.predict((*rest, form))
        columns.append(problem.whitened(changed - base)[:, None])
    return replace(fit, forms=np.hstack(columns))


def _other_forms(fit: Fit) -> Iterator[tuple[int, Effect]]:
    """Yield other forms of a fit's effects, each with its effect's number, but for those fitted.

    What has to be simulated in time has none.
    """
    if not fit.repeats or fit.is_costly:
        return
    for number, (candidate, effect) in enumerate(zip(fit.candidates, fit.effects, strict=True)):
        fitted = {axis.parameter.name for axis in candidate.axes}
        for form in effect.forms():
            if not set(_changed(effect, form)) <= fitted:
                yield number, form


def _changed(effect: Effect, form: Effect) -> list[str]:
    names = [parameter.name for parameter in effect.parameters()]
    return [name for name in names if getattr(form, name) != getattr(effect, name)]


def in_form(problem: Problem, fit: Fit, least: float = math.inf) -> Fit:
    """Return a fit in the form of its family that suits it, where that is much better.

    Where a rig shows an effect well, its other forms are no small change about the one that is
    held. What tells of the form is fitted then, as the other parameters are, with one deviation for
    its other form: one parameter after the other, since forms may exclude each other.

    Parameters
    ----------
    fit
        With its :func:`with_forms`, as is what is returned.
    least
        Cost of a rival; what no form can bring down to it stays as it is.
    """
    best = fit
    while freed := [
        free_fit
        for column, free_fit in zip(best.forms.T, _freed_fits(problem, best), strict=True)
        if free_fit is not None and in_reach(best, left_over(column, problem.nuisances), least)
    ]:
        start = max(freed, key=lambda free_fit: expected_evidence(problem, free_fit))
        if expected_evidence(problem, start) < best.log_evidence + _BETTER:
            break
        refined = refine(problem, follow(problem, start))
        if refined.log_evidence < best.log_evidence + _BETTER:
            break
        best = with_forms(problem, refined)
    return best


def _freed_fits(problem: Problem, fit: Fit) -> Iterator[Fit | None]:
    """Yield for each form the fit with its parameter free; ``None`` if it is more than one."""
    for column, (number, form) in zip(fit.forms.T, _other_forms(fit), strict=True):
        effect = fit.effects[number]
        names = _changed(effect, form)
        declared = {
            parameter.name: parameter for parameter in effect.parameters() if parameter.forms
        }
        if len(names) != 1 or names[0] not in declared:
            yield None
        else:
            held, form_value = getattr(effect, names[0]), getattr(form, names[0])
            axis = Axis(
                declared[names[0]], held, abs(form_value - held), is_log=False, is_form=True
            )
            parts = list(fit.candidates)
            parts[number] = parts[number].with_free(axis)
            behind = int(np.sum(fit.effect_index <= number))
            units = np.insert(fit.units, behind, 0.0)
            columns = np.insert(fit.columns, behind, np.sign(form_value - held) * column, axis=1)
            yield weighed_at(problem, tuple(parts), units, columns, fit.signature)


def hypothesis(problem: ComparedProblem, fit: Fit) -> Hypothesis:
    """Return a fit as one equation weighs it, against the rig as it is stated."""
    return Hypothesis(
        fit.names,
        fit.linearised(problem.stated),
        fit.columns,
        fit.forms,
        bounds(fit.candidates),
        fit.sizes,
        fit.reaches,
    )


def settled_fit(fit: Fit, evidence: Evidence) -> Fit:
    """Return a fit whose parameters are as they are beside what suits it best."""
    signature = fit.signature + fit.columns @ (evidence.units - fit.units)
    return replace(fit, units=evidence.units, signature=signature, posterior=evidence.posterior)
