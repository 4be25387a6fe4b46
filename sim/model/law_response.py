"""The harmonics of what force laws ask for where the motion's harmonics are known: compiled.

Smooth laws are evaluated at the points of one period; laws and loads with corners are integrated
from corner to corner. Complex harmonics are kept as real and imaginary parts,
``(orders + 1, 2, columns)``.
"""

import math

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from sim.model.compiled_laws import law_force, law_value, motion_at
from sim.model.force_law import LawInput
from sim.solve.array_loops import clear, product
from sim.solve.compilation import compile_loop
from sim.solve.corners import find_corners, multiples, pieces_between, value_at

_SIGNALS = 11  # as in sim.model.forces.arguments_of


@compile_loop
def respond(
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
    at: FloatArray,
    answer: FloatArray,
) -> None:
    """Fill in the harmonics of the forces of the laws for the motion under harmonics ``at``."""
    orders = free.shape[0]
    real, imaginary = np.empty((_SIGNALS, orders)), np.empty((_SIGNALS, orders))
    for n in range(orders):
        first, second = complex(at[n, 0, 0], at[n, 1, 0]), complex(at[n, 0, 1], at[n, 1, 1])
        for j in range(8):
            wave = free[n, j] + by_laws[n, j, 0] * first + by_laws[n, j, 1] * second
            real[j, n], imaginary[j, n] = wave.real, wave.imag
    clear(answer)
    instants = (cosine, sine, step_s, speed_m_s)
    _at_points(smooth, smooth_hull, real, imaginary, instants, moving, answer)
    row = 0
    while row < corners.shape[0]:
        item, begin = int(corners[row, 0]), row
        while row < corners.shape[0] and int(corners[row, 0]) == item:
            row += 1
        force = (laws, parts, item, step_s * cosine.shape[0], speed_m_s)
        levels, waves = corners[begin:row, 1:], (real, imaginary)
        _between_corners(force, arguments[item], levels, waves, cosine, sine, nodes, answer)
    _scale(answer)


@compile_loop
def _scale(harmonics: FloatArray) -> None:
    """Turn means of a signal times each harmonic into harmonics; the mean has no imaginary part."""
    for j in range(harmonics.shape[2]):
        harmonics[0, 1, j] = 0.0
        for n in range(1, harmonics.shape[0]):
            harmonics[n, 0, j] *= 2.0
            harmonics[n, 1, j] *= 2.0


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
    orders, points = real.shape[1], cosine.shape[0]
    value, force, through = np.empty((1, 8)), np.zeros((1, 3)), np.zeros((orders, 2, 3))
    for k in range(points):
        for j in range(8):
            value[0, j] = 0.0
            for n in range(orders):
                value[0, j] += real[j, n] * cosine[k, n] - imaginary[j, n] * sine[k, n]
        force[0, 0] = force[0, 1] = 0.0
        force[0, 2] = law_force(
            smooth, smooth_hull, value, 0, k * step_s, step_s, speed_m_s, force, 0
        )
        _add_wave(force, cosine[k], sine[k], 1.0 / points, answer)
        if moving:
            moves = motion_at(smooth_hull, value, 0, speed_m_s)
            force[0, 0], force[0, 1], force[0, 2] = moves.v, moves.r, moves.v_rate
            _add_wave(force, cosine[k], sine[k], 1.0 / points, through)
    _scale(through)
    for n in range(orders):
        for j in range(3):
            real[8 + j, n], imaginary[8 + j, n] = through[n, 0, j], through[n, 1, j]


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
    own_real, own_imaginary = product(arguments, real), product(arguments, imaginary)
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
    series: tuple[FloatArray, FloatArray],
    waves: tuple[FloatArray, FloatArray],
    way: FloatArray,
    asked: FloatArray,
) -> None:
    """Fill in what one item asks for of each strut and along the model, at one phase."""
    laws, parts, item, period_s, speed_m_s = force
    time_s = phase / (2.0 * math.pi) * period_s
    asked[0, 0] = asked[0, 1] = 0.0
    if item < laws.shape[0] and laws[item, 9] <= 0.0:
        own = np.empty(4)
        for j in range(4):
            own[j] = value_at(series[0], series[1], j, way)
        at = LawInput(own[0], own[1], own[2], own[3], time_s, 0.0, speed_m_s)
        asked_force = law_value(laws, item, at)
        asked[0, 0], asked[0, 1] = asked_force * laws[item, 5], asked_force * laws[item, 6]
        asked[0, 2] = 0.0
        return
    value = np.empty((1, 8))
    for j in range(8):
        value[0, j] = value_at(waves[0], waves[1], j, way)
    part = parts[1] if item == laws.shape[0] else parts[0]
    one_law = laws[item : item + 1]
    asked[0, 2] = law_force(one_law, part, value, 0, time_s, 0.0, speed_m_s, asked, 0)
