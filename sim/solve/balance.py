"""The laws' harmonics over a period in balance with what the mounting gives way: compiled.

The same as sweeping :func:`sim.model.forces.law_harmonics` by :func:`sim.solve.relaxation.relax`,
for laws in a table. Loaded when it is first needed, because numba is. Complex harmonics are kept as
real and imaginary parts, ``(orders + 1, 2, columns)``.
"""

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.compiled_laws import law_force, law_value, motion_at
from sim.model.force_law import CREEP_M_S
from sim.model.law_table import LawTable
from sim.model.numbers import corners_only, geometry_only, without_corners
from sim.solve.compiled import compile_loop
from sim.solve.corners import find_corners, gauss, multiples, pieces_between, value_at
from sim.solve.mixing import mix
from sim.solve.period import Period
from sim.solve.relaxation import MOST_SWEEPS, ROUNDING, STALLED, TOLERANCE

_DEPTH = 4
_SIGNALS = 11  # as in sim.model.forces.arguments_of


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
        found = np.stack([laws.real, laws.imag], axis=1)
        answer = np.empty_like(found)
        _respond(*self._given(y, found, answer))
        harmonics: ComplexArray = answer[:, 0] + 1j * answer[:, 1]
        return harmonics

    def balanced(self, y: ComplexArray) -> ComplexArray | None:
        """Return what the laws ask for once nothing changes; ``None`` if they do not settle."""
        found = np.zeros((self.period.s.size, 2, 3))
        settled = _balance(*self._given(y, self.give is not None, found))
        harmonics: ComplexArray = found[:, 0] + 1j * found[:, 1]
        return harmonics if settled else None

    def _given(self, y: ComplexArray, *more: Any) -> tuple[Any, ...]:
        period, table = self.period, self.table
        return (
            table.laws, table.arguments, table.corners, *self._smooth, self._free(y),
            self._by_laws, *_waves(period.orders, period.points), gauss(period.orders),
            period.step_s, self.speed_m_s, *more,
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
    arguments: FloatArray,
    corners: FloatArray,
    smooth: FloatArray,
    smooth_hull: FloatArray,
    parts: FloatArray,
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
    real, imaginary = np.empty((orders, _SIGNALS)), np.empty((orders, _SIGNALS))
    for n in range(orders):
        first, second = complex(at[n, 0, 0], at[n, 1, 0]), complex(at[n, 0, 1], at[n, 1, 1])
        for j in range(8):
            wave = free[n, j] + by_laws[n, j, 0] * first + by_laws[n, j, 1] * second
            real[n, j], imaginary[n, j] = wave.real, wave.imag
    answer[:] = 0.0
    moving = bool(arguments[:, :, 8:].any())
    instants = (cosine, sine, step_s, speed_m_s)
    _at_points(smooth, smooth_hull, real, imaginary, instants, moving, answer)
    row = 0
    while row < corners.shape[0]:
        item, own = int(corners[row, 0]), row
        while row < corners.shape[0] and int(corners[row, 0]) == item:
            row += 1
        force = (laws, parts, item, step_s * cosine.shape[0], speed_m_s)
        waves = (real.T.copy(), imaginary.T.copy())
        levels = corners[own:row, 1:]
        _between_corners(force, arguments[item], levels, waves, cosine, sine, nodes, answer)
    _scale(answer)


@compile_loop
def _scale(harmonics: FloatArray) -> None:
    """Turn means of a signal times each harmonic into harmonics; the mean has no imaginary part."""
    harmonics *= 2.0
    harmonics[0] /= 2.0
    harmonics[0, 1] = 0.0


@compile_loop
def _at_points(
    smooth: FloatArray,
    smooth_hull: FloatArray,
    real: FloatArray,
    imaginary: FloatArray,
    instants: tuple[FloatArray, FloatArray, float, float],
    moving: bool,
    answer: FloatArray,
) -> None:
    """Add the mean over the points of what smooth laws and hull ask for times each harmonic.

    Where corners depend on the motion through the water, fill in its harmonics too.
    """
    cosine, sine, step_s, speed_m_s = instants
    orders, points = real.shape[0], cosine.shape[0]
    value, force, through = np.empty((1, 8)), np.zeros((1, 3)), np.zeros((orders, 2, 3))
    for k in range(points):
        value[:] = 0.0
        for n in range(orders):
            for j in range(8):
                value[0, j] += real[n, j] * cosine[k, n] - imaginary[n, j] * sine[k, n]
        force[:] = 0.0
        force[0, 2] = law_force(
            smooth, smooth_hull, value, 0, k * step_s, step_s, speed_m_s, force, 0
        )
        _add_wave(force, cosine[k], sine[k], 1.0 / points, answer)
        if moving:
            moves = motion_at(smooth_hull, value, 0, speed_m_s)
            force[0, 0], force[0, 1], force[0, 2] = moves.v, moves.r, moves.v_rate
            _add_wave(force, cosine[k], sine[k], 1.0 / points, through)
    _scale(through)
    real[:, 8:], imaginary[:, 8:] = through[:, 0], through[:, 1]


@compile_loop
def _add_wave(
    values: FloatArray,
    cosine: FloatArray,
    sine: FloatArray,
    weight: float,
    answer: FloatArray,
) -> None:
    """Add three values at one instant, times each harmonic there, to means over a period."""
    for n in range(answer.shape[0]):
        for j in range(3):
            answer[n, 0, j] += weight * values[0, j] * cosine[n]
            answer[n, 1, j] -= weight * values[0, j] * sine[n]


@compile_loop
def _between_corners(
    force: tuple[FloatArray, FloatArray, int, float, float],
    arguments: FloatArray,
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
        Laws, the hull without any loads and with those that bend alone, the item's number, the
        period's length in seconds, carriage speed.
    arguments
        What the item depends on, out of all signals: ``(4, 11)``.
    waves
        Real and imaginary parts of the harmonics of all signals, ``(11, orders + 1)``.
    """
    real, imaginary = waves
    own_real, own_imaginary = arguments @ real, arguments @ imaginary
    room = np.empty(cosine.shape[0] * corners.shape[0])
    count = find_corners(own_real, own_imaginary, corners, cosine, sine, room)
    pieces = np.empty((count + 2, 2))
    way, asked = np.empty((real.shape[1], 2)), np.zeros((1, 3))
    for piece in range(pieces_between(room[:count], pieces)):
        for node in range(nodes.shape[1]):
            phase = pieces[piece, 0] + pieces[piece, 1] * nodes[0, node]
            weight = pieces[piece, 1] * nodes[1, node] / (2.0 * math.pi)
            multiples(phase, way)
            _ask(force, phase, (own_real, own_imaginary), waves, way, asked)
            _add_wave(asked, way[:, 0], way[:, 1], weight, answer)


@compile_loop
def _ask(
    force: tuple[FloatArray, FloatArray, int, float, float],
    phase: float,
    own: tuple[FloatArray, FloatArray],
    waves: tuple[FloatArray, FloatArray],
    way: FloatArray,
    asked: FloatArray,
) -> None:
    """Fill in what one item asks for of each strut and along the model, at one phase."""
    laws, parts, item, period_s, speed_m_s = force
    time_s = phase / (2.0 * math.pi) * period_s
    asked[:] = 0.0
    if item < laws.shape[0] and laws[item, 9] <= 0.0:
        x, v = value_at(own[0], own[1], 0, way), value_at(own[0], own[1], 1, way)
        load = value_at(own[0], own[1], 3, way)
        one = law_value(laws, item, (x, v, load), CREEP_M_S, time_s, speed_m_s)
        asked[0, 0], asked[0, 1] = one * laws[item, 5], one * laws[item, 6]
        return
    value = np.empty((1, 8))
    for j in range(8):
        value[0, j] = value_at(waves[0], waves[1], j, way)
    part = parts[1] if item == laws.shape[0] else parts[0]
    one_law = laws[item : item + 1]
    asked[0, 2] = law_force(one_law, part, value, 0, time_s, 0.0, speed_m_s, asked, 0)


@compile_loop
def _balance(
    laws: FloatArray,
    arguments: FloatArray,
    corners: FloatArray,
    smooth: FloatArray,
    smooth_hull: FloatArray,
    parts: FloatArray,
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
    laws_given = (laws, arguments, corners, smooth, smooth_hull, parts)
    given = (*laws_given, free, by_laws, cosine, sine, nodes, step_s, speed_m_s)
    _respond(*given, found, answer)
    found[:] = answer
    if not acts_back:
        return True
    answers, changes = np.zeros((_DEPTH + 1, flat.size)), np.zeros((_DEPTH + 1, flat.size))
    # Relative to the linear force too, by whose rounding all of what is beyond it is off.
    allowed = TOLERANCE * max(np.abs(found).max(), np.abs(free[:, 6:]).max(), 1e-300)
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
