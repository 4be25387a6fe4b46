"""From a design's file to the runs: which, what each buys, and what cannot be had."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, islice
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.design.candidate import CandidateRun
from analysis.design.expectation import (
    REPEATS,
    SCATTER,
    ExpectedCoefficient,
    expected_coefficients,
    made_up,
)
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
    expected_coefficients
        What is expected of each coefficient then.
    """

    run: RunPlan
    repeats: int
    time_s: float
    expected_coefficients: tuple[ExpectedCoefficient, ...]


@dataclass(frozen=True)
class Design:
    """Which runs to make, most telling first.

    Attributes
    ----------
    steps
        One for each set of settings.
    expected_now
        What is known of each coefficient before the first of them.
    expected_coefficients
        What is expected of each coefficient after all of them.
    why
        Of each target that is not met, why.
    """

    steps: tuple[DesignStep, ...]
    expected_now: tuple[ExpectedCoefficient, ...]
    expected_coefficients: tuple[ExpectedCoefficient, ...]
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
    now = _expected_now(file)
    choices: list[tuple[int, int]] = []
    if not (now and file.targets and all(coefficient.met for coefficient in now)):
        choices = _chosen(file)
    steps = _steps(file, choices)
    after = steps[-1].expected_coefficients if steps else now
    used_s = math.fsum(_costs_s(file, choices))
    reasons = tuple(
        _unmet_reason(coefficient, file, used_s) for coefficient in after if not coefficient.met
    )
    return Design(steps, now, after, reasons)


def _chosen(file: DesignFile) -> list[tuple[int, int]]:
    """Return the places of the runs to make, each with its number of repeats.

    The search takes scatter for known, and runs that were made for what is believed of them. Where
    its runs do not do by what is expected of the fit, more is asked for.
    """
    candidates = (*file.grid.candidates, *file.made_runs)
    run_prospects = prospects(candidates, file.belief, file.noise, file.stated)
    made_places = tuple(range(len(file.grid.candidates), len(candidates)))
    runs: tuple[int, ...] = ()
    for harder in _HARDER:
        targets = [
            replace(target, standard_uncertainty=target.standard_uncertainty / harder)
            for target in file.targets
        ]
        selection = select(run_prospects, targets, file.time_s, made_places)
        if runs and not selection.met:
            break  # asked for more than can be had, it would only cost more
        runs = selection.chosen or runs
        if runs and (not selection.met or _suffice(file, [candidates[k] for k in runs])):
            break
    return list(Counter(runs).items())


def _suffice(file: DesignFile, extra_runs: Sequence[CandidateRun]) -> bool:
    return all(coefficient.met for coefficient in expected_after(file, extra_runs))


def _expected_now(file: DesignFile) -> tuple[ExpectedCoefficient, ...]:
    """Return what the runs that were made tell, or will tell that are made in any case."""
    if not file.made_runs:
        return ()
    cycles = file.cycles or made_up(file.made_runs, file.belief, file.noise)
    return expected_coefficients(file.made_runs, cycles, file.targets, file.belief, file.stated)


def _steps(file: DesignFile, choices: list[tuple[int, int]]) -> tuple[DesignStep, ...]:
    """Return the steps: the runs that were made, or are made in any case, come before them."""
    order = [*file.made_runs]
    ends = []
    for candidate, repeats in choices:
        order += [file.grid.candidates[candidate]] * repeats
        ends.append(len(order))
    if not choices:
        return ()
    cycles = _cycles(file, order)
    start_s = math.fsum(duration_rows(file.fixed, file.rig)) or _closing_s(file)
    return tuple(
        DesignStep(
            file.grid.runs[candidate],
            repeats,
            start_s + time_s,
            expected_coefficients(
                order[:end], cycles[:end], file.targets, file.belief, file.stated
            ),
        )
        for (candidate, repeats), end, time_s in zip(
            choices, ends, accumulate(_costs_s(file, choices)), strict=True
        )
    )


def _closing_s(file: DesignFile) -> float:
    """Return the tank time of the zero run behind the last run."""
    zero = file.tables.zero
    return 0.0 if zero is None else zero.duration_s + file.tables.defaults.pause_s


def _costs_s(file: DesignFile, choices: Sequence[tuple[int, int]]) -> list[float]:
    """Return the tank time of each run that is chosen with its repeats, made in this order."""
    order = [file.grid.runs[k] for k, repeats in choices for _ in range(repeats)]
    costs = iter(costs_s(order, file.fixed[-1] if file.fixed else None, file.rig, file.tables.zero))
    return [math.fsum(islice(costs, repeats)) for _, repeats in choices]


def expected_after(
    file: DesignFile, extra_runs: Sequence[CandidateRun]
) -> tuple[ExpectedCoefficient, ...]:
    """Return what is expected of each coefficient after some runs beside those that were made."""
    order = [*file.made_runs, *extra_runs]
    return expected_coefficients(
        order, _cycles(file, order), file.targets, file.belief, file.stated
    )


def _cycles(file: DesignFile, order: Sequence[CandidateRun]) -> list[BodyCycle]:
    """Return the cycles of runs of which the first were made: those as measured."""
    return [*file.cycles, *made_up(order[len(file.cycles) :], file.belief, file.noise)]


def beyond_runs(coefficient: ExpectedCoefficient) -> bool:
    """Whether a target cannot be met by any runs: what they do not lower is beyond it alone."""
    return not coefficient.message and _scatter_variance(coefficient) <= 0.0


def _scatter_variance(coefficient: ExpectedCoefficient) -> float:
    """Return the variance that the scatter may have where the target is met."""
    scatter = sum(coefficient.shares.get(name, 0.0) for name in (SCATTER, REPEATS))
    return coefficient.wanted**2 - (1.0 - scatter) * coefficient.standard_uncertainty**2


def _unmet_reason(coefficient: ExpectedCoefficient, file: DesignFile, used_s: float) -> str:
    """Return why a target is not met, and what would help."""
    condition = f" at {coefficient.where}" if coefficient.where else ""
    has_limit = math.isfinite(file.time_s)
    if coefficient.message:
        hint = "; limits.time_h may leave no time for it" if has_limit else ""
        return f"{coefficient.name}{condition}: {coefficient.message}{hint}"
    scatter = sum(coefficient.shares.get(name, 0.0) for name in (SCATTER, REPEATS))
    rest = {
        name: share for name, share in coefficient.shares.items() if name not in (SCATTER, REPEATS)
    }
    expected_u, wanted_u = coefficient.standard_uncertainty, coefficient.wanted
    text = (
        f"{coefficient.name}{condition}: {expected_u:.3g} {coefficient.unit} is expected, "
        f"{wanted_u:.3g} is asked for"
    )
    free_variance = _scatter_variance(coefficient)
    if free_variance <= 0.0:
        largest = max(rest, key=lambda name: rest[name])
        return (
            f"{text}; {100.0 * rest[largest]:.0f} % of the variance is {largest}, which no run "
            "lowers: state it better, or ask for less"
        )
    factor = scatter * expected_u**2 / free_variance
    if has_limit:
        return (
            f"{text}; the scatter needs about {factor:.2g} times these {used_s / 3600.0:.2g} h of "
            "runs: raise limits.time_h, or ask for less"
        )
    return f"{text}; no further run of the grid helps: widen it, or ask for less"
