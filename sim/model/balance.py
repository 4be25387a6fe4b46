"""Harmonic balance of the force laws with the mounting's deflection: compiled.

The same as sweeping :func:`sim.model.forces.law_harmonics` by :func:`sim.solve.relaxation.relax`,
for laws in a table. Loaded when it is first needed, because numba is. Complex harmonics are kept as
real and imaginary parts, ``(orders + 1, 2, columns)``.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.law_response import respond
from sim.model.law_table import LawTable
from sim.model.numbers import corners_only, geometry_only, without_corners
from sim.solve.anderson_mixing import mix
from sim.solve.array_loops import copy, largest
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
    give
        What the model gives way per rigid load, ``None`` for not at all: ``(orders + 1, 2, 2)``.
    impedance
        Force per displacement of the model, as large.
    """

    table: LawTable
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
        respond(*self._given(y, harmonics_given, answer))
        harmonics: ComplexArray = answer[:, 0] + 1j * answer[:, 1]
        return harmonics

    def balanced(self, y: ComplexArray) -> ComplexArray | None:
        """Return what the laws ask for once nothing changes; ``None`` if they do not settle."""
        harmonics_found = np.zeros((self.period.s.size, 2, 3))
        settled = _balance(*self._given(y, self.give is not None, harmonics_found))
        harmonics: ComplexArray = harmonics_found[:, 0] + 1j * harmonics_found[:, 1]
        return harmonics if settled else None

    def _given(self, y: ComplexArray, *more: Any) -> tuple[Any, ...]:
        return *self._laws, self._free(y), *self._whatever_moves, *more

    def _free(self, y: ComplexArray) -> ComplexArray:
        """Return h, h', h'' and linear force without the laws, two columns each."""
        h = y
        if self.give is not None:
            h = y + (self.give @ (self.impedance @ y[:, :, np.newaxis]))[:, :, 0]
        linear = (self.impedance @ h[:, :, np.newaxis])[:, :, 0]
        moving = (self._powers[:, :, None] * h[:, None, :]).reshape(-1, 6)
        return np.concatenate([moving, linear], axis=1)

    @cached_property
    def _laws(self) -> tuple[Any, ...]:
        table = self.table
        moving = bool(table.arguments[:, :, 8:].any())
        return table.laws, table.arguments, table.corners, *self._smooth(), moving

    @cached_property
    def _whatever_moves(self) -> tuple[Any, ...]:
        period = self.period
        waves = _waves(period.orders, period.points)
        return self._by_laws(), *waves, gauss(period.orders), period.step_s, self.speed_m_s

    def _smooth(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """The rows of the laws that have no corners, and the hull in parts.

        Without its loads that have corners; and without any loads, and with these alone.
        """
        laws, cornered, hull = self.table.laws, self.table.corners[:, 0], self.table.hull
        rows = laws[~np.isin(np.arange(len(laws)), cornered)]
        return rows, without_corners(hull), np.stack([geometry_only(hull), corners_only(hull)])

    @cached_property
    def _powers(self) -> ComplexArray:
        s = self.period.s
        return np.stack([np.ones_like(s), s, s**2], axis=1)

    def _by_laws(self) -> ComplexArray:
        """What a law's harmonic adds to them, shape ``(orders + 1, 8, 2)``."""
        way = np.zeros_like(self.impedance) if self.give is None else self.give
        by_motion = (self._powers[:, :, None, None] * way[:, None, :, :]).reshape(-1, 6, 2)
        return np.concatenate([by_motion, self.impedance @ way], axis=1)


@lru_cache(maxsize=16)
def _waves(orders: int, points: int) -> tuple[FloatArray, FloatArray]:
    angle = 2.0 * np.pi * np.outer(np.arange(points), np.arange(orders + 1)) / points
    return np.cos(angle), np.sin(angle)


@compile_loop
def _largest_linear(free: ComplexArray) -> float:
    """Return the largest harmonic of the linear force, which columns 6 and 7 hold."""
    found = 0.0
    for n in range(free.shape[0]):
        found = max(found, abs(free[n, 6]), abs(free[n, 7]))
    return found


@compile_loop
def _balance(
    laws: FloatArray,
    arguments: FloatArray,
    corners: FloatArray,
    smooth: FloatArray,
    smooth_hull: FloatArray,
    parts: FloatArray,
    moving: bool,
    free: ComplexArray,
    by_laws: ComplexArray,
    cosine: FloatArray,
    sine: FloatArray,
    nodes: FloatArray,
    step_s: float,
    speed_m_s: float,
    acts_back: bool,
    laws_found: FloatArray,
) -> bool:
    """Fill in the harmonics that come back unchanged; tell whether there are any."""
    answer, flat = np.zeros(laws_found.shape), laws_found.reshape(-1)
    answered = answer.reshape(-1)
    laws_given = (laws, arguments, corners, smooth, smooth_hull, parts, moving)
    given = (*laws_given, free, by_laws, cosine, sine, nodes, step_s, speed_m_s)
    respond(*given, laws_found, answer)
    copy(answered, flat)
    if not acts_back:
        return True
    answers, changes = np.zeros((_DEPTH + 1, flat.size)), np.zeros((_DEPTH + 1, flat.size))
    # Relative to the linear force too, by whose rounding all of what is beyond it is off.
    allowed = TOLERANCE * max(largest(flat), _largest_linear(free), 1e-300)
    best, stalled, count = np.inf, 0, 0
    for _ in range(MOST_SWEEPS):
        respond(*given, laws_found, answer)
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
