"""The row's answer to a case: searched as the diagnosis does, weighed by one equation."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from analysis.gap.diagnose import problem_of
from analysis.gap.free import free_numbers
from analysis.gap.gaussian import Nuisances
from analysis.gap.hypotheses import weigh
from pmm.gap.prepare import prepare
from sim.effects.catalogue import catalogue
from tests.sealed.one_equation.evidence import Beside
from tests.sealed.one_equation.tolerated import smooth_changes
from tests.sealed.one_equation.weights import weigh_again
from tests.sealed.peers.sheet import sheet


def one_equation(case: Path) -> dict[str, Any]:
    """Answer a case's folder; nothing is foretold of the withheld runs."""
    ready = prepare(case, dict(catalogue()))
    free = free_numbers(ready.there.rig, ready.case.priors)
    stated = problem_of(ready.there.rig, ready.fitted, ready.settings, free)
    own = stated.nuisances.columns
    smooth = smooth_changes(stated.simulator.stack, free, own.T[: len(free)], ready.settings.priors)
    problem = replace(stated, nuisances=Nuisances(np.column_stack((own, *smooth))))
    searched = weigh(problem, ready.settings.catalogue, free=free)
    sought = np.array([one.is_sought for one in free], dtype=bool)
    moved = np.array([ready.there.units.get(one.name, 0.0) for one in free])
    found = weigh_again(searched, Beside.of(problem, searched.looked, sought, moved))
    return sheet(case.name, found.by_answer, found.stages)
