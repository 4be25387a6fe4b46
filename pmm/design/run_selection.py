"""From a design's file to the runs: which, what each buys, and what cannot be had."""

import math
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.design.candidate import CandidateRun
from analysis.design.design_fits import DesignTarget
from analysis.design.expectation import (
    REPEATS,
    SCATTER,
    ExpectedCoefficient,
    expected_coefficients,
    made_up,
)
from analysis.design.regression import Prospects, prospects
from analysis.design.selection import select
from pmm.design.design_file import DesignFile
from pmm.plan.duration import run_s
from pmm.plan.run_plan import RunPlan

_SOME: Final = 4  # runs of a frequency and speed, evenly drawn, that show what all leave unknown
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
    targets
        Those that runs are chosen for: a target that no run can meet is none of them.
    beyond
        Of each target that no run can meet, why.
    """

    steps: tuple[DesignStep, ...]
    expected_now: tuple[ExpectedCoefficient, ...]
    expected_coefficients: tuple[ExpectedCoefficient, ...]
    why: tuple[str, ...]
    targets: tuple[DesignTarget, ...]
    beyond: tuple[str, ...] = ()

    def in_reach(self, rows: Sequence[ExpectedCoefficient]) -> Iterator[ExpectedCoefficient]:
        """Yield those of some coefficients that runs are chosen for."""
        names = {target.name for target in self.targets}
        yield from (row for row in rows if row.name in names and math.isfinite(row.wanted))

    @property
    def met(self) -> bool:
        """Whether all targets are expected to be met."""
        return not self.why


def design(file: DesignFile) -> Design:
    """Return the runs that a design asks for; a target that no run can meet asks for none.

    Raises
    ------
    DataError
        If a run of the grid cannot be reached, or its loads not be told without an X gauge.
    """
    choices: list[tuple[int, int]] = []
    sought, beyond = file, dict[tuple[str, str], str]()
    candidates = (*file.grid.candidates, *file.made_runs)
    known = cache(lambda: prospects(candidates, file.belief, file.noise, file.stated))
    while sought.targets or not file.targets:
        choices = _chosen(sought, known)
        rows = [row for row in _after(sought, choices) if not row.met and _is_beyond_runs(row)]
        if not rows:
            break
        beyond |= {(row.name, row.where): _unmet_reason(row, file, 0.0) for row in rows}
        names = {name for name, _ in beyond}
        targets = (target for target in sought.targets if target.name not in names)
        choices, sought = [], replace(sought, targets=tuple(targets))
    steps, now = _steps(file, choices), _expected_now(file)
    after = _with_untold(file, steps[-1].expected_coefficients if steps else now)
    used_s = steps[-1].time_s - file.tank_time_s() if steps else 0.0
    reasons = tuple(
        beyond.get((row.name, row.where)) or _unmet_reason(row, file, used_s)
        for row in after
        if not row.met
    )
    return Design(steps, now, after, reasons, sought.targets, tuple(beyond.values()))


def _chosen(file: DesignFile, known: Callable[[], Prospects]) -> list[tuple[int, int]]:
    """Return the places of the runs to make, each with its number of repeats."""
    now = _expected_now(file)
    if now and file.targets and all(coefficient.met for coefficient in now):
        return []
    choices, before_s = list(Counter(_selected(file, known())).items()), file.tank_time_s()
    while choices and file.tank_time_s(_entries(file, choices)) - before_s > file.time_s:
        candidate, repeats = choices.pop()
        choices += [(candidate, repeats - 1)] if repeats > 1 else []
    return choices


def _entries(file: DesignFile, choices: Sequence[tuple[int, int]]) -> list[list[RunPlan]]:
    return [[file.grid.runs[candidate]] * repeats for candidate, repeats in choices]


def shortest_s(file: DesignFile) -> float:
    """Return the longest that the shortest plan with one run of the grid may take."""
    runs = file.grid.candidates
    return min((run.cost_s + run.setting_s for run in runs), default=math.inf) + _ends_s(file)


def _ends_s(file: DesignFile) -> float:
    """Return what zero and control runs at a plan's ends take beside the runs' shares of them."""
    if not file.grid.runs:
        return 0.0
    run, cost_s = file.grid.runs[0], file.grid.candidates[0].cost_s
    alone_s = file.tank_time_s([[run]]) - file.tank_time_s() - run_s(run, None, file.rig)
    return max(alone_s - (cost_s - run_s(run, run, file.rig)), 0.0)


def _selected(file: DesignFile, known: Prospects) -> tuple[int, ...]:
    """Return the places of the runs to make, one that is to be repeated more than once.

    The search takes scatter for known, and runs that were made for what is believed of them. Where
    its runs do not do by what is expected of the fit, more is asked for.
    """
    made_places = tuple(range(len(file.grid.candidates), len(known.candidates)))
    runs: tuple[int, ...] = ()
    time_s = file.time_s - _ends_s(file)
    for harder in _HARDER:
        targets = [
            replace(target, standard_uncertainty=target.standard_uncertainty / harder)
            for target in file.targets
        ]
        selection = select(known, targets, time_s, made_places)
        if runs and not selection.met:
            break  # asked for more than can be had, it would only cost more
        runs = selection.chosen or runs
        made = runs or made_places
        if made and (not selection.met or _suffice(file, [known.candidates[k] for k in runs])):
            break
    return runs


def _suffice(file: DesignFile, extra_runs: Sequence[CandidateRun]) -> bool:
    """Whether all is met that these runs determine: more of them determine nothing else."""
    return all(row.met or row.message for row in expected_after(file, extra_runs))


def _expected_now(file: DesignFile) -> tuple[ExpectedCoefficient, ...]:
    """Return what the runs that were made tell, or will tell that are made in any case."""
    if not file.made_runs:
        return ()
    cycles = file.cycles or made_up(file.made_runs, file.belief, file.noise)
    rows = expected_coefficients(file.made_runs, cycles, file.targets, file.belief, file.stated)
    return _with_untold(file, rows)


def _after(file: DesignFile, choices: Sequence[tuple[int, int]]) -> tuple[ExpectedCoefficient, ...]:
    runs = [file.grid.candidates[candidate] for candidate, times in choices for _ in range(times)]
    return expected_after(file, runs) if runs else _expected_now(file)


def _with_untold(
    file: DesignFile, rows: tuple[ExpectedCoefficient, ...]
) -> tuple[ExpectedCoefficient, ...]:
    """Return coefficients with those that are asked for where no run is, as unknown."""
    if rows and all(target.band_hz is None for target in file.targets):
        return rows
    return (*rows, *_untold(file, rows))


def _untold(file: DesignFile, told: Sequence[ExpectedCoefficient]) -> Iterator[ExpectedCoefficient]:
    """Yield as unknown what is asked for and is none of what is told: the grid does not tell it."""
    conditions: dict[tuple[float, float], list[CandidateRun]] = {}
    for run in file.grid.candidates:
        key = (run.point.frequency_hz, run.point.carriage_speed_m_s)
        conditions.setdefault(key, []).append(run)
    some = [run for runs in conditions.values() for run in runs[:: 1 + (len(runs) - 1) // _SOME]]
    for row in _of_runs(replace(file, made_runs=(), cycles=()), some):
        if (row.name, row.where) not in {(each.name, each.where) for each in told}:
            yield replace(
                row,
                value=math.nan,
                standard_uncertainty=math.inf,
                shares={},
                message=row.message or "no run is made that tells it",
            )


def _steps(file: DesignFile, choices: list[tuple[int, int]]) -> tuple[DesignStep, ...]:
    """Return the steps: the runs that were made, or are made in any case, come before them."""
    order, ends = [*file.made_runs], list[int]()
    for candidate, repeats in choices:
        order += [file.grid.candidates[candidate]] * repeats
        ends.append(len(order))
    cycles, entries = _cycles(file, order) if choices else [], _entries(file, choices)
    return tuple(
        DesignStep(
            file.grid.runs[candidate],
            repeats,
            file.tank_time_s(entries[:count]),
            expected_coefficients(
                order[:end], cycles[:end], file.targets, file.belief, file.stated
            ),
        )
        for count, ((candidate, repeats), end) in enumerate(zip(choices, ends, strict=True), 1)
    )


def expected_after(
    file: DesignFile, extra_runs: Sequence[CandidateRun]
) -> tuple[ExpectedCoefficient, ...]:
    """Return what is expected of each coefficient after some runs beside those that were made."""
    return _with_untold(file, _of_runs(file, [*file.made_runs, *extra_runs]))


def _of_runs(file: DesignFile, runs: Sequence[CandidateRun]) -> tuple[ExpectedCoefficient, ...]:
    """Return what is expected of each coefficient after some runs, the first of them made."""
    return expected_coefficients(runs, _cycles(file, runs), file.targets, file.belief, file.stated)


def _cycles(file: DesignFile, order: Sequence[CandidateRun]) -> list[BodyCycle]:
    """Return the cycles of runs of which the first were made: those as measured."""
    return [*file.cycles, *made_up(order[len(file.cycles) :], file.belief, file.noise)]


def _is_beyond_runs(coefficient: ExpectedCoefficient) -> bool:
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
