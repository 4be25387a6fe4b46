"""The laws' harmonics over a period in balance with what the mounting gives way: compiled.

The same as sweeping :func:`sim.hull_forces.law_harmonics` by :func:`sim.relaxation.relax`, for laws
in a table. Loaded when it is first needed, because numba is. Complex harmonics are kept as real and
imaginary parts, ``(orders + 1, 2, columns)``.
"""

from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim.compiled import compile_loop
from sim.compiled_laws import law_force
from sim.law_table import LawTable
from sim.linear import ComplexArray
from sim.period import Period
from sim.relaxation import MOST_SWEEPS, ROUNDING, STALLED, TOLERANCE
from sim.signals import FloatArray

_DEPTH = 4
_DEPENDENT = 1e-12  # of a direction's square: what is left of it beside the others


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
        y, laws
            Harmonics of the struts, and of the laws: ``(orders + 1, 2)``.
        """
        found = np.stack([laws.real, laws.imag], axis=1)
        answer = np.empty_like(found)
        _respond(*self._given(y, found, answer))
        harmonics: ComplexArray = answer[:, 0] + 1j * answer[:, 1]
        return harmonics

    def balanced(self, y: ComplexArray) -> ComplexArray | None:
        """Return what the laws ask for once nothing changes; ``None`` if they do not settle."""
        found = np.zeros((self.period.s.size, 2, 2))
        settled = _balance(*self._given(y, self.give is not None, found))
        harmonics: ComplexArray = found[:, 0] + 1j * found[:, 1]
        return harmonics if settled else None

    def _given(self, y: ComplexArray, *more: Any) -> tuple[Any, ...]:
        period = self.period
        return (
            self.table.laws, self.table.cross_flow, self._free(y), self._by_laws,
            *_waves(period.orders, period.points), period.mean_over_step, period.step_s,
            self.speed_m_s, *more,
        )  # fmt: skip

    def _free(self, y: ComplexArray) -> ComplexArray:
        """Return h, h', h'' and linear force without the laws, two columns each."""
        h = y
        if self.give is not None:
            h = y + (self.give @ (self.impedance @ y[:, :, np.newaxis]))[:, :, 0]
        linear = (self.impedance @ h[:, :, np.newaxis])[:, :, 0]
        moving = (self._powers[:, :, None] * h[:, None, :]).reshape(-1, 6)
        return np.concatenate([moving, linear], axis=1)

    @cached_property
    def _powers(self) -> ComplexArray:
        s = self.period.s
        return np.stack([np.ones_like(s), s, s**2], axis=1)

    @cached_property
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
def _respond(
    laws: FloatArray,
    cross_flow: FloatArray,
    free: ComplexArray,
    by_laws: ComplexArray,
    cosine: FloatArray,
    sine: FloatArray,
    mean_over_step: FloatArray,
    step_s: float,
    speed_m_s: float,
    at: FloatArray,
    answer: FloatArray,
) -> None:
    """Fill in the harmonics of the forces of the laws for the motion under harmonics ``at``."""
    orders, points = free.shape[0], cosine.shape[0]
    real, imaginary = np.empty((orders, 8)), np.empty((orders, 8))
    for n in range(orders):
        first, second = complex(at[n, 0, 0], at[n, 1, 0]), complex(at[n, 0, 1], at[n, 1, 1])
        for j in range(8):
            wave = free[n, j] + by_laws[n, j, 0] * first + by_laws[n, j, 1] * second
            real[n, j], imaginary[n, j] = wave.real, wave.imag
    answer[:] = 0.0
    value, force = np.empty((1, 8)), np.zeros((2, 2))
    smooth, jumps = force[:1], force[1:]
    for k in range(points):
        value[:] = 0.0
        for n in range(orders):
            for j in range(8):
                value[0, j] += real[n, j] * cosine[k, n] - imaginary[n, j] * sine[k, n]
        force[:] = 0.0
        law_force(laws, cross_flow, value, 0, k * step_s, step_s, speed_m_s, smooth, jumps, 0)
        for n in range(orders):
            for j in range(2):
                total = force[0, j] + force[1, j] / mean_over_step[n]
                answer[n, 0, j] += total * cosine[k, n]
                answer[n, 1, j] -= total * sine[k, n]
    answer *= 2.0 / points
    answer[0] /= 2.0
    answer[0, 1] = 0.0


@compile_loop
def _pivot(left: FloatArray, gram: FloatArray, free: NDArray[np.bool_]) -> int:
    """Return the free direction of which most is left, or -1 where they all depend on others."""
    best, most = -1, _DEPENDENT
    for i in range(free.size):
        if free[i] and left[i, i] > most * gram[i, i]:
            best, most = i, left[i, i] / gram[i, i]
    return best


@compile_loop
def _weights(gram: FloatArray, right: FloatArray) -> FloatArray:
    """Return the solution of ``gram x = right``, directions that depend on others left out."""
    size = right.size
    left, rest = gram.copy(), right.copy()
    order, found = np.zeros(size, dtype=np.int64), np.zeros(size)
    free = np.ones(size, dtype=np.bool_)
    rank = 0
    for _ in range(size):
        best = _pivot(left, gram, free)
        if best < 0:
            break
        free[best] = False
        order[rank] = best
        rank += 1
        for i in range(size):
            if free[i]:
                factor = left[i, best] / left[best, best]
                left[i] -= factor * left[best]
                rest[i] -= factor * rest[best]
    for place in range(rank - 1, -1, -1):
        i = order[place]
        total = rest[i]
        for later in range(place + 1, rank):
            total -= left[i, order[later]] * found[order[later]]
        found[i] = total / left[i, i]
    return found


@compile_loop
def _mix(answers: FloatArray, changes: FloatArray, count: int, at: FloatArray) -> None:
    """Fill in the mean of the answers whose changes cancel best (Anderson); newest last."""
    size = at.size
    steps = np.empty((count - 1, size))
    for i in range(count - 1):
        steps[i] = changes[i + 1] - changes[i]
    gram, right = np.zeros((count - 1, count - 1)), np.zeros(count - 1)
    for i in range(count - 1):
        right[i] = (steps[i] * changes[count - 1]).sum()
        for j in range(count - 1):
            gram[i, j] = (steps[i] * steps[j]).sum()
    weights = _weights(gram, right)
    at[:] = answers[count - 1]
    for i in range(count - 1):
        at -= weights[i] * (answers[i + 1] - answers[i])


@compile_loop
def _balance(
    laws: FloatArray,
    cross_flow: FloatArray,
    free: ComplexArray,
    by_laws: ComplexArray,
    cosine: FloatArray,
    sine: FloatArray,
    mean_over_step: FloatArray,
    step_s: float,
    speed_m_s: float,
    acts_back: bool,
    found: FloatArray,
) -> bool:
    """Fill in the harmonics that come back unchanged; tell whether there are any."""
    answer, flat = np.zeros_like(found), found.reshape(-1)
    given = (laws, cross_flow, free, by_laws, cosine, sine, mean_over_step, step_s, speed_m_s)
    _respond(*given, found, answer)
    found[:] = answer
    if not acts_back:
        return True
    answers, changes = np.zeros((_DEPTH + 1, flat.size)), np.zeros((_DEPTH + 1, flat.size))
    allowed = TOLERANCE * max(np.abs(found).max(), 1e-300)
    best, stalled, count = np.inf, 0, 0
    for _ in range(MOST_SWEEPS):
        _respond(*given, found, answer)
        if count > _DEPTH:
            count = _DEPTH
            for i in range(_DEPTH):
                answers[i], changes[i] = answers[i + 1], changes[i + 1]
        answers[count] = answer.reshape(-1)
        changes[count] = answers[count] - flat
        largest = np.abs(changes[count]).max() / allowed
        stalled = stalled + 1 if largest >= best else 0
        best = min(best, largest)
        if largest <= 1.0 or (largest <= ROUNDING / TOLERANCE and stalled >= STALLED):
            return True
        count += 1
        if count > 1:
            _mix(answers, changes, count, flat)
        else:
            flat[:] = answers[0]
    return False
