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
from sim.solve.period import Period, apply
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
        at = _parts(laws)
        answer = np.empty_like(at)
        arguments: Any = (*self._response(y), at, answer)
        respond(*arguments)
        return _complex(answer)

    def settled(self, y: ComplexArray, laws: ComplexArray) -> ComplexArray | None:
        """Return the laws' harmonics that come back unchanged, from ``laws`` on.

        ``None`` without such.
        """
        response, found = self._response(y), _parts(laws)
        # Relative to the linear force too, by whose rounding all of what is beyond it is off.
        size = max(np.abs(laws).max(), np.abs(response[7][:, 6:]).max(), 1e-300)
        return _complex(found) if _settle(response, TOLERANCE * float(size), found) else None

    def _response(self, y: ComplexArray) -> tuple[Any, ...]:
        """Return what :func:`sim.model.law_response.respond` takes, but for its last two."""
        return *self._laws, self._unladen(y), self._per_law, *self._instants

    @cached_property
    def _laws(self) -> tuple[Any, ...]:
        """The table, rows of it without corners, the hull in parts, and whether corners move."""
        laws, _, arguments, corners = self.table
        cornered = set(corners[:, 0].tolist())
        smooth = laws[[row for row in range(len(laws)) if row not in cornered]]
        moving = bool(arguments[:, :, 8:].any())
        return laws, arguments, corners, smooth, *self.parts, moving

    @cached_property
    def _instants(self) -> tuple[Any, ...]:
        period = self.period
        waves = _waves(period.orders, period.points)
        return *waves, gauss(period.orders), period.step_s, self.speed_m_s

    def _unladen(self, y: ComplexArray) -> ComplexArray:
        """Return h, h', h'' and linear force without the laws, two columns each."""
        h = y if self.give is None else y + apply(self.give, apply(self.impedance, y))
        s = self.period.s[:, np.newaxis]
        return np.hstack([h, h * s, h * s**2, apply(self.impedance, h)])

    @cached_property
    def _per_law(self) -> ComplexArray:
        """What a law's harmonic adds to them, shape ``(orders + 1, 8, 2)``."""
        give = np.zeros_like(self.impedance) if self.give is None else self.give
        s = self.period.s[:, np.newaxis, np.newaxis]
        return np.hstack([give, give * s, give * s**2, self.impedance @ give])


def _parts(harmonics: ComplexArray) -> FloatArray:
    parts: FloatArray = np.stack([harmonics.real, harmonics.imag], axis=1)
    return parts


def _complex(parts: FloatArray) -> ComplexArray:
    harmonics: ComplexArray = parts[:, 0] + 1j * parts[:, 1]
    return harmonics


@lru_cache(maxsize=16)
def _waves(orders: int, points: int) -> tuple[FloatArray, FloatArray]:
    angle = 2.0 * np.pi * np.outer(np.arange(points), np.arange(orders + 1)) / points
    return np.cos(angle), np.sin(angle)


@compile_loop
def _settle(response: tuple[Any, ...], allowed: float, laws_found: FloatArray) -> bool:
    """Fill in the laws' harmonics that come back unchanged; tell whether there are any.

    Parameters
    ----------
    response
        The arguments of :func:`sim.model.law_response.respond` but for the last two.
    allowed
        The change that counts as none.
    laws_found
        Where the sweeps begin.
    """
    answer, flat = np.zeros(laws_found.shape), laws_found.reshape(-1)
    answered = answer.reshape(-1)
    all_arguments: Any = (*response, laws_found, answer)
    answers, changes = np.zeros((_DEPTH + 1, flat.size)), np.zeros((_DEPTH + 1, flat.size))
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
