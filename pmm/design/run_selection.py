"""From a design's file to the runs: which, what each buys, and what cannot be had."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, islice
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.design.candidate import CandidateRun
from analysis.design.expectation import REPEATS, SCATTER, ExpectedCoefficient, expected, made_up
from analysis.design.regression import prospects
from analysis.design.selection import select
from pmm.design.design_file import DesignFile
from pmm.design.grid import costs_s
from pmm.plan.duration import duration_rows
from pmm.plan.run_plan import RunPlan

_HARDER: Final = (1.0, 1.1, 1.25, 1.5, 2.0)  # times as much is asked for


@dataclass(frozen=True)
class DesignStep:
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
    known: tuple[ExpectedCoefficient, ...]


@dataclass(frozen=True)
class Design:
    """Which runs to make, most telling first.

    Attributes
    ----------
    steps
        One for each set of settings.
    now
        What is known of each coefficient before the first of them.
    known
        What is expected of each coefficient after all of them.
    why
        Of each target that is not met, why.
    """

    steps: tuple[DesignStep, ...]
    now: tuple[ExpectedCoefficient, ...]
    known: tuple[ExpectedCoefficient, ...]
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
    now = _known(file)
    chosen: list[tuple[int, int]] = []
    if not (now and file.targets and all(one.met for one in now)):
        chosen = _chosen(file)
    steps = _steps(file, chosen)
    after = steps[-1].known if steps else now
    used_s = math.fsum(_costs_s(file, chosen))
    why = tuple(_why(one, file, used_s) for one in after if not one.met)
    return Design(steps, now, after, why)


def _chosen(file: DesignFile) -> list[tuple[int, int]]:
    """Return the places of the runs to make, each with its number of repeats.

    The search takes scatter for known, and runs that were made for what is believed of them. Where
    its runs do not do by what is expected of the fit, more is asked for.
    """
    candidates = (*file.grid.candidates, *file.made)
    known = prospects(candidates, file.belief, file.noise, file.stated)
    made = tuple(range(len(file.grid.candidates), len(candidates)))
    runs: tuple[int, ...] = ()
    for harder in _HARDER:
        asked = [
            replace(one, standard_uncertainty=one.standard_uncertainty / harder)
            for one in file.targets
        ]
        found = select(known, asked, file.time_s, made)
        if runs and not found.met:
            break  # asked for more than can be had, it would only cost more
        runs = found.chosen or runs
        if runs and (not found.met or _suffice(file, [candidates[k] for k in runs])):
            break
    return list(Counter(runs).items())


def _suffice(file: DesignFile, more: Sequence[CandidateRun]) -> bool:
    return all(one.met for one in foreseen(file, more))


def _known(file: DesignFile) -> tuple[ExpectedCoefficient, ...]:
    """Return what the runs that were made tell, or will tell that are made in any case."""
    if not file.made:
        return ()
    cycles = file.cycles or made_up(file.made, file.belief, file.noise)
    return expected(file.made, cycles, file.targets, file.belief, file.stated)


def _steps(file: DesignFile, chosen: list[tuple[int, int]]) -> tuple[DesignStep, ...]:
    """Return the steps: the runs that were made, or are made in any case, come before them."""
    order = [*file.made]
    ends = []
    for candidate, repeats in chosen:
        order += [file.grid.candidates[candidate]] * repeats
        ends.append(len(order))
    if not chosen:
        return ()
    cycles = _cycles(file, order)
    start_s = math.fsum(duration_rows(file.fixed, file.rig)) or _closing_s(file)
    return tuple(
        DesignStep(
            file.grid.runs[candidate],
            repeats,
            start_s + time_s,
            expected(order[:end], cycles[:end], file.targets, file.belief, file.stated),
        )
        for (candidate, repeats), end, time_s in zip(
            chosen, ends, accumulate(_costs_s(file, chosen)), strict=True
        )
    )


def _closing_s(file: DesignFile) -> float:
    """Return the tank time of the zero run behind the last run."""
    zero = file.tables.zero
    return 0.0 if zero is None else zero.duration_s + file.tables.defaults.pause_s


def _costs_s(file: DesignFile, chosen: Sequence[tuple[int, int]]) -> list[float]:
    """Return the tank time of each run that is chosen with its repeats, made in this order."""
    order = [file.grid.runs[k] for k, repeats in chosen for _ in range(repeats)]
    costs = iter(costs_s(order, file.fixed[-1] if file.fixed else None, file.rig, file.tables.zero))
    return [math.fsum(islice(costs, repeats)) for _, repeats in chosen]


def foreseen(file: DesignFile, more: Sequence[CandidateRun]) -> tuple[ExpectedCoefficient, ...]:
    """Return what is expected of each coefficient after some runs beside those that were made."""
    order = [*file.made, *more]
    return expected(order, _cycles(file, order), file.targets, file.belief, file.stated)


def _cycles(file: DesignFile, order: Sequence[CandidateRun]) -> list[BodyCycle]:
    """Return the cycles of runs of which the first were made: those as measured."""
    return [*file.cycles, *made_up(order[len(file.cycles) :], file.belief, file.noise)]


def beyond_runs(one: ExpectedCoefficient) -> bool:
    """Whether a target cannot be met by any runs: what they do not lower is beyond it alone."""
    return not one.message and _left(one) <= 0.0


def _left(one: ExpectedCoefficient) -> float:
    """Return the variance that the scatter may have where the target is met."""
    scatter = sum(one.shares.get(name, 0.0) for name in (SCATTER, REPEATS))
    return one.wanted**2 - (1.0 - scatter) * one.standard_uncertainty**2


def _why(one: ExpectedCoefficient, file: DesignFile, used_s: float) -> str:
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
    left = _left(one)
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
