"""The laws' harmonics over a period in balance with what the mounting gives way: compiled.

The same as sweeping :func:`sim.hull_forces.law_harmonics` by :func:`sim.relaxation.relax`, for laws
in a table. Loaded when it is first needed, because numba is. Complex harmonics are kept as real and
imaginary parts, ``(orders + 1, 2, columns)``.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from sim.compiled import compile_loop
from sim.compiled_laws import cross_flow_load, law_force, law_value
from sim.corners import find_corners, gauss, multiples, pieces_between, value_at
from sim.force_law import CREEP_M_S
from sim.law_table import LawTable
from sim.linear import ComplexArray
from sim.mixing import mix
from sim.period import Period
from sim.relaxation import MOST_SWEEPS, ROUNDING, STALLED, TOLERANCE
from sim.signals import FloatArray

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
            *self.table, self._smooth, self._free(y), self._by_laws,
            *_waves(period.orders, period.points), gauss(period.orders), period.step_s,
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
    def _smooth(self) -> FloatArray:
        """The rows of the laws that have no corners."""
        laws, cornered = self.table.laws, self.table.corners[:, 0]
        return laws[~np.isin(np.arange(len(laws)), cornered)]

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
    arguments: FloatArray,
    corners: FloatArray,
    smooth: FloatArray,
    free: ComplexArray,
    by_laws: ComplexArray,
    cosine: FloatArray,
    sine: FloatArray,
    nodes: FloatArray,
    step_s: float,
    speed_m_s: float,
    at: FloatArray,
    answer: FloatArray,
) -> None:
    """Fill in the harmonics of the forces of the laws for the motion under harmonics ``at``."""
    orders = free.shape[0]
    real, imaginary = np.empty((orders, 8)), np.empty((orders, 8))
    for n in range(orders):
        first, second = complex(at[n, 0, 0], at[n, 1, 0]), complex(at[n, 0, 1], at[n, 1, 1])
        for j in range(8):
            wave = free[n, j] + by_laws[n, j, 0] * first + by_laws[n, j, 1] * second
            real[n, j], imaginary[n, j] = wave.real, wave.imag
    answer[:] = 0.0
    if smooth.shape[0]:
        _at_points(smooth, real, imaginary, cosine, sine, step_s, speed_m_s, answer)
    row = 0
    while row < corners.shape[0]:
        item, own = int(corners[row, 0]), row
        while row < corners.shape[0] and int(corners[row, 0]) == item:
            row += 1
        force = (laws, cross_flow, item, step_s * cosine.shape[0], speed_m_s)
        waves = (arguments[item] @ real.T, arguments[item] @ imaginary.T)
        _between_corners(force, corners[own:row, 1:], waves, cosine, sine, nodes, answer)
    answer *= 2.0
    answer[0] /= 2.0
    answer[0, 1] = 0.0


@compile_loop
def _at_points(
    smooth: FloatArray,
    real: FloatArray,
    imaginary: FloatArray,
    cosine: FloatArray,
    sine: FloatArray,
    step_s: float,
    speed_m_s: float,
    answer: FloatArray,
) -> None:
    """Add the mean over the points of what smooth laws ask for times each harmonic."""
    orders, points = real.shape[0], cosine.shape[0]
    value, force, none = np.empty((1, 8)), np.zeros((1, 2)), np.zeros((0, 4))
    for k in range(points):
        value[:] = 0.0
        for n in range(orders):
            for j in range(8):
                value[0, j] += real[n, j] * cosine[k, n] - imaginary[n, j] * sine[k, n]
        force[:] = 0.0
        law_force(smooth, none, value, 0, k * step_s, step_s, speed_m_s, force, 0)
        for n in range(orders):
            for j in range(2):
                answer[n, 0, j] += force[0, j] * cosine[k, n] / points
                answer[n, 1, j] -= force[0, j] * sine[k, n] / points


@compile_loop
def _between_corners(
    force: tuple[FloatArray, FloatArray, int, float, float],
    corners: FloatArray,
    waves: tuple[FloatArray, FloatArray],
    cosine: FloatArray,
    sine: FloatArray,
    nodes: FloatArray,
    answer: FloatArray,
) -> None:
    """Add the mean over the period of what one item asks for times each harmonic, exactly.

    Parameters
    ----------
    force
        Laws, coupled loads, the item's number, the period's length in seconds, carriage speed.
    waves
        Real and imaginary parts of the harmonics of its arguments, ``(4, orders + 1)``.
    """
    real, imaginary = waves
    orders = real.shape[1]
    room = np.empty(cosine.shape[0] * corners.shape[0])
    count = find_corners(real, imaginary, corners, cosine, sine, room)
    pieces = np.empty((count + 2, 2))
    way, asked = np.empty((orders, 2)), np.empty(2)
    for piece in range(pieces_between(room[:count], pieces)):
        for node in range(nodes.shape[1]):
            phase = pieces[piece, 0] + pieces[piece, 1] * nodes[0, node]
            weight = pieces[piece, 1] * nodes[1, node] / (2.0 * math.pi)
            multiples(phase, way)
            _ask(force, phase, (real, imaginary), way, asked)
            for n in range(orders):
                for j in range(2):
                    answer[n, 0, j] += weight * asked[j] * way[n, 0]
                    answer[n, 1, j] -= weight * asked[j] * way[n, 1]


@compile_loop
def _ask(
    force: tuple[FloatArray, FloatArray, int, float, float],
    phase: float,
    waves: tuple[FloatArray, FloatArray],
    way: FloatArray,
    asked: FloatArray,
) -> None:
    """Fill in what one item asks for of each strut at one phase."""
    laws, cross_flow, item, period_s, speed_m_s = force
    real, imaginary = waves
    x, v = value_at(real, imaginary, 0, way), value_at(real, imaginary, 1, way)
    if item < laws.shape[0]:
        a, load = value_at(real, imaginary, 2, way), value_at(real, imaginary, 3, way)
        time_s = phase / (2.0 * math.pi) * period_s
        one = law_value(laws, item, (x, v, a, load), CREEP_M_S, time_s, speed_m_s)
        asked[0], asked[1] = one * laws[item, 5], one * laws[item, 6]
    else:
        load = cross_flow_load(cross_flow, 0, x, v)
        moment = cross_flow_load(cross_flow, 1, x, v)
        for j in range(2):
            asked[j] = cross_flow[4, j] * load + cross_flow[5, j] * moment


@compile_loop
def _balance(
    laws: FloatArray,
    cross_flow: FloatArray,
    arguments: FloatArray,
    corners: FloatArray,
    smooth: FloatArray,
    free: ComplexArray,
    by_laws: ComplexArray,
    cosine: FloatArray,
    sine: FloatArray,
    nodes: FloatArray,
    step_s: float,
    speed_m_s: float,
    acts_back: bool,
    found: FloatArray,
) -> bool:
    """Fill in the harmonics that come back unchanged; tell whether there are any."""
    answer, flat = np.zeros_like(found), found.reshape(-1)
    laws_given = (laws, cross_flow, arguments, corners, smooth)
    given = (*laws_given, free, by_laws, cosine, sine, nodes, step_s, speed_m_s)
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
            mix(answers, changes, count, flat)
        else:
            flat[:] = answers[0]
    return False
