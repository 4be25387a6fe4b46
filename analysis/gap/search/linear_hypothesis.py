"""A fit as one equation weighs it: linear about where it is, with its families' other forms."""

from dataclasses import replace

import numpy as np

from analysis.gap.forward.problem import Compared, Problem
from analysis.gap.inference.hypothesis import Evidence, Hypothesis
from analysis.gap.search.fit import Fit, bounds


def with_forms(problem: Problem, fit: Fit) -> Fit:
    """Return a fit with what the other forms of its effects change, where they repeat."""
    if not fit.repeats or fit.is_costly:
        return fit
    simulator, effects = problem.simulator, fit.effects
    base = simulator.predict(effects)
    found = [np.zeros((len(base), 0))]
    for number, one in enumerate(effects):
        rest = [other for at_, other in enumerate(effects) if at_ != number]
        for form in one.forms():
            changed = simulator.predict((*rest, form))
            found.append(problem.whitened(changed - base)[:, None])
    return replace(fit, forms=np.hstack(found))


def hypothesis(problem: Compared, fit: Fit) -> Hypothesis:
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


def settled(fit: Fit, found: Evidence) -> Fit:
    """Return a fit whose parameters are as they are beside what suits it best."""
    signature = fit.signature + fit.columns @ (found.units - fit.units)
    return replace(fit, units=found.units, signature=signature, posterior=found.posterior)
