"""The non-linear fits of one speed and frequency: several runs, quasi-steady, single runs, X."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_plan import Request, set_heel_of
from analysis.coefficients.campaign_records import HIGHER_ORDER, JOINT, FormChoice, Missing
from analysis.coefficients.cycle_fit import FIRST, HIGHER, QUASI_STEADY, CycleFit, fit_cycles
from analysis.coefficients.form_choice import (
    DESCRIBES,
    LINEAR_FORM,
    forms_of,
    rival_forms,
)
from analysis.coefficients.identifiability import velocity_sizes
from analysis.coefficients.line_cycles import names_of_lines
from analysis.coefficients.resistance_form import fit_surge, with_further_term
from analysis.coefficients.speed_form import choose_speed_form
from analysis.coefficients.terms import LOAD_WORDS, ROLL, VELOCITY_LETTERS, letter_of_load
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane

FIRST_HARMONICS = "first harmonics, several runs"
QUASI = "quasi-steady"
SINGLE_RUN = "single run"
STATIC_DRIFT = "static drift"
SURGE_FORCES = "surge"

_LEFT_OUT = "other motion left out"
_MOVES = 0.05  # of the larger motion at the struts: less tells nothing of its terms


@dataclass(eq=False)
class GroupFits:
    """Fits of the runs of one group, collected as they are made.

    Attributes
    ----------
    fits
        With the method of each.
    richest
        For each load the fit of all runs with the smallest residuals; arrangements are judged by
        it.
    """

    fits: list[tuple[str, CycleFit]] = field(default_factory=list)
    choices: list[FormChoice] = field(default_factory=list)
    missing: list[Missing] = field(default_factory=list)
    richest: list[CycleFit] = field(default_factory=list)


def nonlinear_fits(cycles: Sequence[BodyCycle], request: Request) -> GroupFits:
    """Return the fits of force and moment in the form that the data support, and of X."""
    group = GroupFits()
    fits, missing = group.fits, group.missing
    motions, cross = _motions(cycles)
    orders = tuple(n for n in HIGHER if n <= min(cycle.orders for cycle in cycles))
    plane, joint = cycles[0].plane, any(cycle.lines for cycle in cycles)
    for row in load_rows(cycles):
        angles = _moving_heel(cycles, motions, orders, cross=cross)
        try:
            choice, richest, speed = choose_speed_form(
                cycles, row, motions, orders, cross=cross, angles=angles
            )
        except DataError as error:
            missing.append(Missing(f"{letter_of_load(plane, row)} terms", str(error)))
            continue
        fails = joint and choice.dispersion > DESCRIBES  # coefficients that go with frequency
        group.choices.append(choice if fails else _with_lines(choice, cycles))
        group.richest.append(richest)
        if fails or (joint and choice.fitted == LINEAR_FORM):
            continue  # each line by itself tells more
        of_all: list[tuple[str, CycleFit]] = []
        for method, of, chosen in _methods(cycles, orders):
            angles = _moving_heel(cycles, motions, chosen, cross=cross)
            forms = forms_of(plane, row, motions, cross=cross, angles=angles)
            try_form(of_all, missing, method, of, forms, choice, chosen, request, speed)
        fits += of_all
        for _, joint_fit in of_all[: int(not joint)]:
            fits += _single_runs(joint_fit, row, choice, orders, request, speed)
    if all(cycle.has_surge for cycle in cycles):
        _surge(group, cycles, motions, cross, request)
    return group


def _with_lines(choice: FormChoice, cycles: Sequence[BodyCycle]) -> FormChoice:
    """Return a choice that holds for each line of its runs too."""
    lines = (name for cycle in cycles for name in (cycle.name, *names_of_lines(cycle)))
    return replace(choice, runs=tuple(dict.fromkeys(lines)))


def load_rows(cycles: Sequence[BodyCycle]) -> tuple[int, ...]:
    """Return the loads across, about and, where all runs have a gauge for it, in roll."""
    return (0, 1, *((ROLL,) if all(cycle.has_roll for cycle in cycles) else ()))


def _moving_heel(
    cycles: Sequence[BodyCycle], motions: str, orders: Sequence[int], *, cross: bool
) -> tuple[str, ...]:
    """Return the factors of heel that oscillations show at some harmonics, odd together."""
    sizes = {round(abs(set_heel_of(cycle)), 4) for cycle in cycles}
    if sizes == {0.0}:
        return ()
    v, r = tuple(VELOCITY_LETTERS[cycles[0].plane])
    letters = [letter for letter, motion in ((v, "v"), (r, "r")) if motion in motions]
    even = [f"{letter}{letter}phi" for letter in letters] + ([f"{v}{r}phi"] if cross else [])
    odd = [f"{letter}phiphi" for letter in letters] if len(sizes) > 1 else []
    return (*(even if 2 in orders else ()), *odd)


def _single_runs(
    joint_fit: CycleFit,
    row: int,
    choice: FormChoice,
    orders: tuple[int, ...],
    request: Request,
    of_speed_m_s: float | None,
) -> list[tuple[str, CycleFit]]:
    """Return each run's own fit; what its other motion does, by the fit of all, is left open."""
    fits: list[tuple[str, CycleFit]] = []
    for cycle in joint_fit.problem.numbers.cycles:
        motions, cross = _motions([cycle])
        forms = forms_of(cycle.plane, row, motions, cross=cross)
        run_fits: list[tuple[str, CycleFit]] = []
        try_form(run_fits, [], SINGLE_RUN, [cycle], forms, choice, orders, request, of_speed_m_s)
        fits += [
            (method, fit.with_input(_LEFT_OUT, _left_out(fit, joint_fit)))
            for method, fit in run_fits
        ]
    return fits


def _left_out(fit: CycleFit, joint_fit: CycleFit) -> FloatArray:
    """Return how a run's coefficients change by the terms that only the fit of all has, (n, 1).

    Pure yaw has an incidence of the third order in its angle: at 15 degrees 2 % of its own speed.
    """
    out = [k for k, name in enumerate(joint_fit.names) if name not in fit.names]
    problem, row = fit.problem, fit.terms[0].row
    rest = replace(problem, terms=tuple(joint_fit.terms[k] for k in out)).nominal[0]
    load = problem.weighted(rest @ joint_fit.values[out, None], row)
    design = problem.weighted(problem.nominal[0], row)
    return np.asarray(np.linalg.lstsq(design, load, rcond=None)[0])


def _methods(
    cycles: Sequence[BodyCycle], orders: tuple[int, ...]
) -> list[tuple[str, Sequence[BodyCycle], tuple[int, ...]]]:
    if any(cycle.lines for cycle in cycles):
        return [(JOINT, cycles, orders)]
    methods: list[tuple[str, Sequence[BodyCycle], tuple[int, ...]]] = []
    if orders != FIRST:
        methods.append((HIGHER_ORDER, cycles, orders))
    methods.append((FIRST_HARMONICS, cycles, FIRST))
    heeled = any(map(set_heel_of, cycles))  # a mean holds what does not move
    if all(cycle.mean_known for cycle in cycles) and not heeled:
        methods.append((QUASI, cycles, QUASI_STEADY))
    return methods


def try_form(
    fits: list[tuple[str, CycleFit]],
    missing: list[Missing],
    method: str,
    cycles: Sequence[BodyCycle],
    forms: Mapping[str, Sequence[str]],
    choice: FormChoice,
    orders: tuple[int, ...],
    request: Request,
    of_speed_m_s: float | None = None,
) -> None:
    """Fit the form that was chosen, and add what it misfits and others that do as well give."""
    before = len(fits)
    _try(fits, missing, method, cycles, forms[choice.fitted], orders, request, of_speed_m_s)
    for form, weight in rival_forms(choice) if len(fits) > before else ():
        try:
            rival = fit_cycles(cycles, forms[form], orders, of_speed_m_s=of_speed_m_s)
        except DataError:
            continue  # these runs alone do not tell its terms
        taken = fits[-1][1]
        changes = [
            rival[name] - taken[name] if name in rival.names else 0.0 for name in taken.names
        ]
        label = f"form of the {choice.load}: {form}"
        fits[-1] = (method, taken.with_input(label, math.sqrt(weight) * np.array(changes)[:, None]))
    if len(fits) > before:
        fits[-1] = (method, _with_misfit(fits[-1][1], method))


def _with_misfit(fit: CycleFit, method: str) -> CycleFit:
    """Return a fit whose interval holds what its form leaves of the load beyond scatter."""
    row, cycles = fit.terms[0].row, fit.problem.numbers.cycles
    runs = cycles[0].name if method == SINGLE_RUN else f"at {cycles[0].speed_m_s:g} m/s"
    where = "" if cycles[0].frequency_hz == 0.0 else f", {cycles[0].frequency_hz:.4g} Hz"
    return fit.with_misfit(f"misfit of the {LOAD_WORDS[row]}, {method} {runs}{where}", row)


def _try(
    fits: list[tuple[str, CycleFit]],
    missing: list[Missing],
    method: str,
    cycles: Sequence[BodyCycle],
    names: Sequence[str],
    orders: tuple[int, ...],
    request: Request,
    of_speed_m_s: float | None,
) -> None:
    """Fit, or record which coefficients cannot be determined."""
    try:
        fit = fit_cycles(cycles, names, orders, stated=request.stated, of_speed_m_s=of_speed_m_s)
        fits.append((method, fit))
    except DataError as error:
        missing += [Missing(name, f"{method}: {error}") for name in names]


def _motions(cycles: Sequence[BodyCycle]) -> tuple[str, bool]:
    """Return in what the runs move through the water, and whether any moves in both at once."""
    speeds = []
    for cycle in cycles:
        moved = velocity_sizes(cycle)
        steady = abs(cycle.speed_m_s * math.sin(cycle.drift_rad))
        speeds.append((moved[0] + steady, moved[1]))
    size = np.array(speeds)
    most = size.max()
    motions = "".join(
        letter
        for letter, size_of_letter in zip("vr", size.max(axis=0), strict=True)
        if size_of_letter > _MOVES * most
    )
    return motions, bool((size.min(axis=1) > _MOVES * most).any())


def _surge(
    fits: GroupFits,
    cycles: Sequence[BodyCycle],
    motions: str,
    cross: bool,
    request: Request,
) -> None:
    """X forces: even terms, at the mean and the second harmonic.

    Terms of both motions show at the first harmonic too where one of them is steady.
    """
    v, r = tuple(VELOCITY_LETTERS[cycles[0].plane])
    means = all(cycle.mean_known for cycle in cycles)
    names = ["X_0"] if means else []
    names += [f"X_{letter}{letter}" for letter, motion in ((v, "v"), (r, "r")) if motion in motions]
    names += [f"X_{v}{r}"] if cross else []
    even = (0, 2) if means else (2,)
    orders = (0, 1, 2) if cross and means else even
    if any(map(set_heel_of, cycles)):
        letters = [letter for letter, motion in ((v, "v"), (r, "r")) if motion in motions]
        names += [f"X_{letter}phi" for letter in letters] + (["X_phiphi"] if means else [])
        orders = tuple(sorted({1, *orders}))
    # In the vertical plane it would pass for another joint or pivot at small angles.
    yaws = "r" in motions and cycles[0].plane is Plane.HORIZONTAL
    try_surge(fits, cycles, names, orders, request, "X_udot" if yaws else None)


def try_surge(
    fits: GroupFits,
    cycles: Sequence[BodyCycle],
    names: Sequence[str],
    orders: tuple[int, ...],
    request: Request,
    further: str | None = None,
) -> None:
    """Fit X, or record which of its terms cannot be determined.

    Parameters
    ----------
    further
        A term that is taken where the data ask for it.
    """
    if further is not None:
        names, richer = with_further_term(cycles, names, further, orders)
        fits.choices += [] if richer is None else [richer]
    try:
        fit, choice = fit_surge(cycles, names, orders, stated=request.stated)
    except DataError as error:
        fits.missing += [Missing(name, f"{SURGE_FORCES}: {error}") for name in names]
        return
    fits.fits.append((SURGE_FORCES, _with_misfit(fit, SURGE_FORCES)))
    fits.richest.append(fit)
    fits.choices += [] if choice is None else [choice]
