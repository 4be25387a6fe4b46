"""One group of a campaign, solved: its entries of the table, and what was noticed."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from analysis.coefficients.campaign_nonlinear import SINGLE_RUN, nonlinear_fits, static_fits
from analysis.coefficients.campaign_plan import Group, GroupKind, Request
from analysis.coefficients.campaign_records import LINEAR, Entry, FormChoice, Missing
from analysis.coefficients.campaign_result import TrialColumns, no_trials
from analysis.coefficients.cycle import CHANNELS, Cycle, at_order
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.cycle_trials import cycle_trials
from analysis.coefficients.names import PLACES, Form, name_of
from analysis.coefficients.phasors import parts_of
from analysis.coefficients.result import Coefficients
from analysis.coefficients.solve import problem_of, solve
from analysis.coefficients.stated import STATED
from analysis.coefficients.uncertainty import monte_carlo, slopes
from analysis.uncertainty import Contribution, UncertainValues, added, stacked
from hardware.description.errors import DataError
from hardware.description.flags import Flag


@dataclass(frozen=True, eq=False)
class Block:
    """Entries of one group, ``n`` of them."""

    entries: tuple[Entry, ...]
    uncertain: UncertainValues
    trials: TrialColumns
    choices: tuple[FormChoice, ...] = ()
    missing: tuple[Missing, ...] = ()
    flags: tuple[Flag, ...] = ()


def solve_group(group: Group, request: Request) -> Block:
    """Return what one group determines; what it cannot tell is named, not raised."""
    if group.kind is GroupKind.LINEAR:
        return _linear(group.cycles, request)
    if group.kind is GroupKind.STATIC:
        return _fits_block(static_fits(group.cycles, request), group.cycles, request)
    return _fits_block(nonlinear_fits(group.cycles, request), group.cycles, request)


def _linear(cycles: Sequence[Cycle], request: Request) -> Block:
    runs = [cycle.run() for cycle in cycles]
    try:
        result = solve(runs, request.form, stated=request.stated)
    except DataError as error:
        names = [name_of(place, cycles[0].plane, request.form) for place in PLACES]
        missing = tuple(Missing(name, str(error)) for name in names)
        return Block((), UncertainValues(np.zeros(0)), no_trials(0), missing=missing)
    uncertain = UncertainValues(result.values, _contributions(cycles, request))
    entries = tuple(_entry(result, k) for k in range(len(result.names)))
    trials = no_trials(len(entries))
    if request.trials:
        problem = problem_of(runs, request.form)
        drawn = monte_carlo(
            problem, request.stated, trials=request.trials, seed=request.seed, level=request.level
        )
        trials = TrialColumns(request.trials, drawn.standard_uncertainty, drawn.low, drawn.high)
    missing = tuple(_lacking(result, cycles, request.form))
    return Block(entries, uncertain, trials, missing=missing, flags=result.flags)


def _lacking(result: Coefficients, cycles: Sequence[Cycle], form: Form) -> list[Missing]:
    """Say of each coefficient that these runs do not tell which run would."""
    found = []
    for place in PLACES:
        name = name_of(place, cycles[0].plane, form)
        if name not in result.names:
            try:
                solve([cycle.run() for cycle in cycles], form, wanted=[name])
            except DataError as error:
                found.append(Missing(name, str(error)))
    return found


def _entry(result: Coefficients, k: int) -> Entry:
    here = result.conditions
    return Entry(
        result.names[k],
        result.units[k],
        LINEAR,
        here.frequency_hz,
        here.speed_m_s,
        here.translation_amplitude_m,
        here.rotation_amplitude_rad,
        here.runs,
        float(result.retained[k]),
        float(result.misfit),
    )


def _contributions(cycles: Sequence[Cycle], request: Request) -> tuple[Contribution, ...]:
    """What every input adds, on the deviates of whole cycles, as non-linear fits use them too."""
    problem = problem_of([cycle.run() for cycle in cycles], request.form)
    by_phasor, by_stated = slopes(problem, request.stated)
    rows, found = np.arange(len(by_phasor)), []
    for k, cycle in enumerate(cycles):
        slope = by_phasor[:, 2 * k * len(CHANNELS) : 2 * (k + 1) * len(CHANNELS)]
        places = parts_of([cycle.phasors.index(at_order(name, 1)) for name in CHANNELS])
        for source in cycle.phasors.sources:
            parts = slope @ source.root[places]
            found.append(Contribution(source.label, source.degrees_of_freedom, rows, parts))
    for k, (name, spread) in enumerate(zip(STATED, request.stated.vector, strict=True)):
        if spread > 0.0:
            column = by_stated[:, k, None] * spread
            found.append(Contribution(name, request.stated.freedom(name), rows, column))
    return added(found)


def _fits_block(
    found: tuple[list[tuple[str, CycleFit]], list[FormChoice], list[Missing]],
    cycles: Sequence[Cycle],
    request: Request,
) -> Block:
    fits, choices, missing = found
    entries = tuple(
        _fit_entry(method, fit, k) for method, fit in fits for k in range(len(fit.names))
    )
    uncertain = stacked([fit.uncertain for _, fit in fits])
    flags = tuple(flag.of(cycle.name) for cycle in cycles for flag in cycle.flags)
    trials = _fits_trials(fits, request)
    return Block(entries, uncertain, trials, tuple(choices), tuple(missing), flags)


def _fits_trials(fits: Sequence[tuple[str, CycleFit]], request: Request) -> TrialColumns:
    """Monte Carlo of the fits of several runs; single runs are checks on them."""
    columns = [
        cycle_trials(fit, request.trials, request.seed, request.level)
        if request.trials and method != SINGLE_RUN
        else no_trials(len(fit.names))
        for method, fit in fits
    ]
    if not columns:
        return no_trials(0)
    names = ("standard_uncertainty", "low", "high")
    return TrialColumns(
        request.trials, *(np.concatenate([getattr(one, n) for one in columns]) for n in names)
    )


def _fit_entry(method: str, fit: CycleFit, k: int) -> Entry:
    cycles = fit.problem.cycles
    moving = [cycle.run().motion.values for cycle in cycles if cycle.frequency_hz > 0.0]
    size = np.abs(np.stack(moving)).max(axis=0) if moving else np.zeros(2)
    return Entry(
        fit.names[k],
        fit.terms[k].unit,
        method,
        cycles[0].frequency_hz,
        cycles[0].speed_m_s,
        float(size[0]),
        float(size[1]),
        tuple(cycle.name for cycle in cycles),
        float("nan"),
        fit.misfit(fit.terms[k].row),
    )
