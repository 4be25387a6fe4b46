"""Whether cycles can be fitted together, and whether they determine all terms."""

import math
from collections import Counter
from collections.abc import Iterator, Sequence

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_model import CycleProblem
from analysis.coefficients.term_waves import MOVES
from analysis.coefficients.terms import (
    ANGLES,
    HEEL_LETTER,
    ROLL,
    SURGE,
    Term,
    letter_of,
    name_of_term,
)
from analysis.kinematics.body_frame import HEEL
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.setpoint import Medium
from hardware.description.words import joined

_STILL = 1e-3  # of a term's typical size: pure yaw has less of v v r than this up to 20 degrees
_APART = 1e-2  # least over greatest singular value of the terms' scaled columns


def named_twice(cycles: Sequence[BodyCycle]) -> list[str]:
    """Return what is wrong with the runs' names.

    Raises
    ------
    ConfigurationError
        If there is no run.
    """
    if not cycles:
        raise ConfigurationError("no run was given; one or more are needed")
    twice = [name for name, count in Counter(cycle.name for cycle in cycles).items() if count > 1]
    return [f"two runs are called {name!r}; rename one" for name in twice]


def other_geometry(cycle: BodyCycle, first: BodyCycle) -> Iterator[str]:
    """Yield where a run was made with other lengths of the rig than the first one."""
    for name in ("half_spacing_m", "point_ahead_m"):
        value, first_value = getattr(cycle, name), getattr(first, name)
        if value != first_value:
            yield f"{cycle.name} has {name} = {value:g}, {first.name} {first_value:g}"


def check_cycles(cycles: Sequence[BodyCycle], orders: tuple[int, ...]) -> None:
    """Refuse cycles that cannot be fitted together.

    Raises
    ------
    ConfigurationError
        Naming every run and what does not fit.
    """
    faults = named_twice(cycles)
    for cycle in cycles:
        faults += _unfit(cycle, cycles[0])
        moves = cycle.frequency_hz > 0.0
        if moves and cycle.orders < max(orders):
            faults.append(
                f"{cycle.name} was resolved up to harmonic {cycle.orders}, {max(orders)} is needed"
            )
        if 0 not in orders and not moves:
            faults.append(f"{cycle.name} is static and tells through its mean alone")
    if faults:
        raise ConfigurationError("the runs do not belong together: " + "; ".join(faults))


def _unfit(cycle: BodyCycle, first: BodyCycle) -> Iterator[str]:
    if cycle.plane is not first.plane:
        yield f"{cycle.name} is {cycle.plane}, {first.name} {first.plane}"
    yield from other_geometry(cycle, first)
    if cycle.medium is not Medium.WATER:
        yield f"{cycle.name} was run in air; take it off as a dry run"
    if not np.isfinite(cycle.phasors.values).all():
        yield f"{cycle.name} has values that are not finite; leave the run out"


def check_determined(problem: CycleProblem) -> None:
    """Refuse terms that the cycles do not determine separately.

    Raises
    ------
    DataError
        Naming the terms of each load that go together and what run would tell them apart.
    """
    of_heel = [term for term in problem.terms if term.of_roll and term.row != ROLL]
    if of_heel and HEEL not in problem.numbers.channels:
        names = ", ".join(name_of_term(term, problem.numbers.cycles[0].plane) for term in of_heel)
        raise DataError(f"{names}: these runs have no heel; state [heel] in the campaign file")
    for row, columns in problem.rows:
        if row == SURGE and not all(cycle.has_surge for cycle in problem.numbers.cycles):
            lacking = [cycle.name for cycle in problem.numbers.cycles if not cycle.has_surge]
            raise DataError(
                f"X terms need the channel force_x, which {joined(lacking)} did not record"
            )
        if row == ROLL and not all(cycle.has_roll for cycle in problem.numbers.cycles):
            lacking = [cycle.name for cycle in problem.numbers.cycles if not cycle.has_roll]
            raise DataError(missing_roll_gauge(lacking))
        matrix = problem.weighted(problem.nominal[0][..., columns], row)
        _check_apart(problem, matrix, [problem.terms[k] for k in columns])


def missing_roll_gauge(runs: Sequence[str]) -> str:
    """Return what is wrong with runs that do not tell K."""
    return (
        f"a missing roll gauge: K terms need the channel roll_moment, which {joined(runs)} did "
        "not record; record it, and state [heel] in the campaign file"
    )


def _check_apart(problem: CycleProblem, matrix: np.ndarray, terms: list[Term]) -> None:
    plane, runs = (
        problem.numbers.cycles[0].plane,
        joined([cycle.name for cycle in problem.numbers.cycles]),
    )
    size = np.sqrt((matrix**2).sum(axis=0))
    still = [
        t for t, s in zip(terms, size, strict=True) if not s > _STILL * _typical_size(t, problem)
    ]
    if still:
        names = ", ".join(name_of_term(term, plane) for term in still)
        raise DataError(
            f"{names} cannot be determined from {runs}: nothing there moves in that way; add "
            f"{_remedy(still, problem)}"
        )
    _, singular, right = np.linalg.svd(np.linalg.qr(matrix / size, mode="r"))
    least = singular[-1] if len(singular) == len(terms) else 0.0
    if least > _APART * singular[0]:
        return
    tied = [t for t, part in zip(terms, right[-1], strict=True) if abs(part) > 0.1]
    names = " and ".join(name_of_term(term, plane) for term in tied)
    raise DataError(
        f"{names} cannot be told apart from {runs} (ratio of singular values "
        f"{least / singular[0]:.2g}, limit {_APART:g}); add {_remedy(tied, problem)}"
    )


def _typical_size(term: Term, problem: CycleProblem) -> float:
    """Size of a term if both motions moved the struts as much as the greatest one does."""
    half = problem.numbers.cycles[0].half_spacing_m
    across, turn = np.abs(problem.numbers.moved[:, 1:3]).max(axis=(0, 2))
    pace = float(max(across, half * turn))
    omega = 2.0 * np.pi * max(cycle.frequency_hz for cycle in problem.numbers.cycles)
    letters = [letter_of(factor) for factor in term.factors]
    turning, rolling = letters.count("r"), letters.count("p")
    sizes = np.abs(problem.numbers.moved).max(axis=(0, 2))
    laid = math.prod(float(sizes[MOVES.index(letter)]) for letter in letters if letter in ANGLES)
    if rolling:
        laid *= float(sizes[MOVES.index("p")]) ** rolling
    return float(laid * pace ** (term.degree - rolling) * omega**term.rates / half**turning)


def _remedy(terms: Sequence[Term], problem: CycleProblem) -> str:
    """Return which run would tell terms apart, or from nothing."""
    if any(term.angles for term in terms):
        heeled = any(HEEL_LETTER in letter_of(factor) for term in terms for factor in term.factors)
        return "runs at other " + ("heel angles" if heeled else "angles of the rudder")
    if any("p" in letter_of(factor) for term in terms for factor in term.factors):
        return "a roll decay"
    if not any(cycle.frequency_hz > 0.0 for cycle in problem.numbers.cycles):
        return "static runs at another drift angle"
    letters = {f.replace("dot", "").strip("|") for term in terms for f in term.factors}
    mixed = [t for t in terms if {"v", "r"} <= {f.replace("dot", "").strip("|") for f in t.factors}]
    vertical = problem.numbers.cycles[0].plane.value == "vertical"
    sway, yaw = ("heave", "pitch") if vertical else ("sway", "yaw")
    if mixed:
        return f"runs in {yaw} with drift, or with strut phases between pure {sway} and pure {yaw}"
    if any(term.degree == 0 for term in terms):
        return "a run at another drift angle, or take zero runs off and leave the constant out"
    motion = " and ".join({"v": sway, "r": yaw}[letter] for letter in sorted(letters, reverse=True))
    if any(term.degree > 1 for term in terms):
        return f"a run in {motion} at another amplitude, or fit third harmonics as well"
    return f"a run in {motion} at another strut phase"
