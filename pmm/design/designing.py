"""From a design's file to the runs: which, what each buys, and what cannot be had."""

import math
from collections import Counter
from dataclasses import dataclass
from itertools import accumulate

from analysis.design.expectation import REPEATS, SCATTER, Expected, expected, made_up
from analysis.design.regression import Candidate, prospects
from analysis.design.selection import select
from pmm.design.design_file import DesignFile
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan


@dataclass(frozen=True)
class Step:
    """The design up to one of its runs.

    Attributes
    ----------
    run, repeats
        What is added, and how often.
    time_s
        Tank time of all runs so far, those made in any case among them.
    known
        What is expected of each coefficient then.
    """

    run: RunPlan
    repeats: int
    time_s: float
    known: tuple[Expected, ...]


@dataclass(frozen=True)
class Design:
    """Which runs to make, most telling first.

    Attributes
    ----------
    steps
        One for each set of settings.
    known
        What is expected of each coefficient after all of them.
    why
        Of each target that is not met, why.
    """

    steps: tuple[Step, ...]
    known: tuple[Expected, ...]
    why: tuple[str, ...]

    @property
    def met(self) -> bool:
        """Whether all targets are expected to be met."""
        return not self.why


def design(file: DesignFile) -> Design:
    """Return the runs that a design asks for.

    Raises
    ------
    DataError
        If a run of the grid cannot be reached, or its loads not be told without an X gauge.
    """
    candidates = (*file.grid.candidates, *file.made)
    first = len(file.grid.candidates)
    known = prospects(candidates, file.belief, file.noise, file.stated)
    made = range(first, len(candidates))
    found = select(known, file.targets, file.time_s, tuple(made))
    counts = Counter(found.chosen)
    steps = _steps(file, list(counts.items()))
    after = steps[-1].known if steps else _known(file, file.made)
    used_up = sum(candidates[k].cost_s for k in found.chosen)
    why = tuple(_why(one, file, used_up) for one in after if not one.met)
    return Design(steps, after, why)


def _known(file: DesignFile, runs: tuple[Candidate, ...]) -> tuple[Expected, ...]:
    if not runs:
        return ()
    cycles = made_up(runs, file.belief, file.noise)
    return expected(runs, cycles, file.targets, file.belief, file.stated)


def _steps(file: DesignFile, chosen: list[tuple[int, int]]) -> tuple[Step, ...]:
    """Return the steps: the runs made in any case come before them."""
    order = [*file.made]
    ends = []
    for candidate, repeats in chosen:
        order += [file.grid.candidates[candidate]] * repeats
        ends.append(len(order))
    if not order:
        return ()
    cycles = made_up(order, file.belief, file.noise)
    start_s = math.fsum(duration_rows(file.fixed, file.rig))
    costs = [file.grid.candidates[k].cost_s * repeats for k, repeats in chosen]
    return tuple(
        Step(
            file.grid.runs[candidate],
            repeats,
            start_s + time_s,
            expected(order[:end], cycles[:end], file.targets, file.belief, file.stated),
        )
        for (candidate, repeats), end, time_s in zip(chosen, ends, accumulate(costs), strict=True)
    )


def _why(one: Expected, file: DesignFile, used_s: float) -> str:
    """Return why a target is not met, and what would help."""
    where = f" at {one.where}" if one.where else ""
    limited = math.isfinite(file.time_s)
    if one.message:
        hint = "; limits.time_h may leave no time for it" if limited else ""
        return f"{one.name}{where}: {one.message}{hint}"
    scatter = sum(one.shares.get(name, 0.0) for name in (SCATTER, REPEATS))
    rest = {name: share for name, share in one.shares.items() if name not in (SCATTER, REPEATS)}
    expected_u, wanted = one.standard_uncertainty, one.wanted
    text = f"{one.name}{where}: {expected_u:.3g} {one.unit} is expected, {wanted:.3g} is asked for"
    left = wanted**2 - (1.0 - scatter) * expected_u**2
    if left <= 0.0:
        most = max(rest, key=lambda name: rest[name])
        return (
            f"{text}; {100.0 * rest[most]:.0f} % of the variance is {most}, which no run lowers: "
            "state it better, or ask for less"
        )
    more = scatter * expected_u**2 / left
    if limited:
        return (
            f"{text}; the scatter needs about {more:.2g} times these {used_s / 3600.0:.2g} h of "
            "runs: raise limits.time_h, or ask for less"
        )
    return f"{text}; no further run of the grid helps: widen it, or ask for less"
