"""Harmonic balance of the force laws with the mounting's deflection: compiled.

The same as sweeping :func:`sim.model.forces.law_harmonics` by :func:`sim.solve.relaxation.relax`,
for laws in a table. Loaded when it is first needed, because numba is. Complex harmonics of the laws
are kept as real and imaginary parts, ``(orders + 1, 2, columns)``.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.law_response import respond
from sim.model.law_table import LawTable
from sim.solve.array_loops import copy, inner, largest, solve
from sim.solve.compilation import compile_loop
from sim.solve.corners import gauss
from sim.solve.period import Period
from sim.solve.relaxation import MOST_SWEEPS, ROUNDING, STALLED, TOLERANCE

_DEPTH = 4


@dataclass(frozen=True, eq=False)
class LawBalance:
    """The laws over a period of a model on its mounting.

    Attributes
    ----------
    parts
        The table's hull in parts (:attr:`sim.model.system.HullSystem.parts`).
    give
        What the model gives way per rigid load, ``None`` for not at all: ``(orders + 1, 2, 2)``.
    impedance
        Force per displacement of the model, as large.
    """

    table: LawTable
    parts: tuple[FloatArray, FloatArray]
    give: ComplexArray | None
    impedance: ComplexArray
    period: Period
    speed_m_s: float

    def answer(self, y: ComplexArray, laws: ComplexArray) -> ComplexArray:
        """Return what the laws ask for where the model gives way to ``laws``.

        Parameters
        ----------
        y
            Harmonics of the struts, ``(orders + 1, 2)``.
        laws
            Of the laws at the struts and along the model, ``(orders + 1, 3)``.
        """
        harmonics_given = np.stack([laws.real, laws.imag], axis=1)
        answer = np.empty_like(harmonics_given)
        _answer(self._arguments(y), harmonics_given, answer)
        harmonics: ComplexArray = answer[:, 0] + 1j * answer[:, 1]
        return harmonics

    def force(self, y: ComplexArray) -> ComplexArray | None:
        """Return the forces once nothing changes, the laws' in them; ``None`` without such.

        Shape ``(orders + 1, 3)``: at the struts and along the model.
        """
        force = np.empty((len(y), 3), dtype=np.complex128)
        settled = _balance(self._arguments(y), self.give is not None, force)
        return force if settled else None

    def _arguments(self, y: ComplexArray) -> tuple[Any, ...]:
        return *self._laws, y, *self._whatever_moves

    @cached_property
    def _laws(self) -> tuple[Any, ...]:
        """The table, rows of it without corners, the hull in parts, and whether corners move."""
        laws, _, arguments, corners = self.table
        cornered = set(corners[:, 0].tolist())
        smooth = laws[[row for row in range(len(laws)) if row not in cornered]]
        moving = bool(arguments[:, :, 8:].any())
        return laws, arguments, corners, smooth, *self.parts, moving

    @cached_property
    def _whatever_moves(self) -> tuple[Any, ...]:
        period = self.period
        waves = _waves(period.orders, period.points)
        way = np.zeros_like(self.impedance) if self.give is None else self.give
        linear = (way, self.impedance, period.s)
        return *linear, *waves, gauss(period.orders), period.step_s, self.speed_m_s


@lru_cache(maxsize=16)
def _waves(orders: int, points: int) -> tuple[FloatArray, FloatArray]:
    angle = 2.0 * np.pi * np.outer(np.arange(points), np.arange(orders + 1)) / points
    return np.cos(angle), np.sin(angle)


@compile_loop
def _unladen(
    y: ComplexArray, give: ComplexArray, impedance: ComplexArray, s: ComplexArray
) -> ComplexArray:
    """Return h, h', h'' and linear force without the laws, two columns each."""
    free = np.empty((s.size, 8), dtype=np.complex128)
    for n in range(s.size):
        for i in range(2):
            free[n, 6 + i] = impedance[n, i, 0] * y[n, 0] + impedance[n, i, 1] * y[n, 1]
        for i in range(2):
            free[n, i] = y[n, i] + give[n, i, 0] * free[n, 6] + give[n, i, 1] * free[n, 7]
            free[n, 2 + i] = s[n] * free[n, i]
            free[n, 4 + i] = s[n] * free[n, 2 + i]
        for i in range(2):
            free[n, 6 + i] = impedance[n, i, 0] * free[n, 0] + impedance[n, i, 1] * free[n, 1]
    return free


@compile_loop
def _per_law(give: ComplexArray, impedance: ComplexArray, s: ComplexArray) -> ComplexArray:
    """Return what a law's harmonic adds to them, shape ``(orders + 1, 8, 2)``."""
    by_laws = np.empty((s.size, 8, 2), dtype=np.complex128)
    for n in range(s.size):
        for i in range(2):
            for j in range(2):
                by_laws[n, i, j] = give[n, i, j]
                by_laws[n, 2 + i, j] = s[n] * give[n, i, j]
                by_laws[n, 4 + i, j] = s[n] * by_laws[n, 2 + i, j]
                by_laws[n, 6 + i, j] = (
                    impedance[n, i, 0] * give[n, 0, j] + impedance[n, i, 1] * give[n, 1, j]
                )
    return by_laws


@compile_loop
def _response(setup: tuple[Any, ...]) -> tuple[Any, ...]:
    """Return what :func:`sim.model.law_response.respond` takes, but for its last two arguments.

    Parameters
    ----------
    setup
        The laws and whether their corners move, the struts, and the period: see
        :class:`LawBalance`.
    """
    laws, arguments, corners, smooth, smooth_hull, parts, moving, y, give, impedance, s = setup[:11]
    free, by_laws = _unladen(y, give, impedance, s), _per_law(give, impedance, s)
    laws_given = (laws, arguments, corners, smooth, smooth_hull, parts, moving)
    return (*laws_given, free, by_laws, *setup[11:])


@compile_loop
def _answer(setup: tuple[Any, ...], at: FloatArray, answer: FloatArray) -> None:
    """Fill in the harmonics that the laws ask for where they are ``at``."""
    all_arguments: Any = (*_response(setup), at, answer)
    respond(*all_arguments)


@compile_loop
def _balance(setup: tuple[Any, ...], acts_back: bool, force: ComplexArray) -> bool:
    """Fill in the forces under laws that come back unchanged; tell whether there are any."""
    response = _response(setup)
    free, by_laws = response[7], response[8]
    harmonics = np.zeros((free.shape[0], 2, 3))
    settled = _settle(response, acts_back, harmonics)
    for n in range(free.shape[0]):
        for i in range(3):
            force[n, i] = complex(harmonics[n, 0, i], harmonics[n, 1, i])
        first, second = force[n, 0], force[n, 1]
        for i in range(2):
            linear = by_laws[n, 6 + i, 0] * first + by_laws[n, 6 + i, 1] * second
            force[n, i] += free[n, 6 + i] + linear
    return settled


@compile_loop
def _largest_linear(free: ComplexArray) -> float:
    """Return the largest harmonic of the linear force, which columns 6 and 7 hold."""
    size = 0.0
    for n in range(free.shape[0]):
        size = max(size, abs(free[n, 6]), abs(free[n, 7]))
    return size


@compile_loop
def _settle(arguments: tuple[Any, ...], acts_back: bool, laws_found: FloatArray) -> bool:
    """Fill in the laws' harmonics that come back unchanged; tell whether there are any.

    Parameters
    ----------
    arguments
        The arguments of :func:`sim.model.law_response.respond` but for the last two.
    """
    answer, flat, free = np.zeros(laws_found.shape), laws_found.reshape(-1), arguments[7]
    answered = answer.reshape(-1)
    all_arguments: Any = (*arguments, laws_found, answer)
    respond(*all_arguments)
    copy(answered, flat)
    if not acts_back:
        return True
    answers, changes = np.zeros((_DEPTH + 1, flat.size)), np.zeros((_DEPTH + 1, flat.size))
    # Relative to the linear force too, by whose rounding all of what is beyond it is off.
    allowed = TOLERANCE * max(largest(flat), _largest_linear(free), 1e-300)
    best, stalled, count = np.inf, 0, 0
    for _ in range(MOST_SWEEPS):
        respond(*all_arguments)
        if count > _DEPTH:
            count = _DEPTH
            for i in range(_DEPTH):
                copy(answers[i + 1], answers[i])
                copy(changes[i + 1], changes[i])
        copy(answered, answers[count])
        for j in range(flat.size):
            changes[count, j] = answered[j] - flat[j]
        change = largest(changes[count]) / allowed
        stalled = stalled + 1 if change >= best else 0
        best = min(best, change)
        if change <= 1.0 or (change <= ROUNDING / TOLERANCE and stalled >= STALLED):
            return True
        count += 1
        if count > 1:
            mix(answers, changes, count, flat)
        else:
            copy(answers[0], flat)
    return False


@compile_loop
def mix(answers: FloatArray, changes: FloatArray, count: int, at: FloatArray) -> None:
    """Fill in the mean of the answers whose changes cancel best (Anderson); newest last."""
    size = at.size
    steps = np.empty((count - 1, size))
    for i in range(count - 1):
        for j in range(size):
            steps[i, j] = changes[i + 1, j] - changes[i, j]
    gram, right = np.zeros((count - 1, count - 1)), np.zeros(count - 1)
    for i in range(count - 1):
        right[i] = inner(steps[i], changes[count - 1])
        for j in range(count - 1):
            gram[i, j] = inner(steps[i], steps[j])
    weights = solve(gram, right)
    copy(answers[count - 1], at)
    for i in range(count - 1):
        for j in range(size):
            at[j] -= weights[i] * (answers[i + 1, j] - answers[i, j])
