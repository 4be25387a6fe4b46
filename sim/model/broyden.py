"""The unknown loads and torques of one sample, solved by Broyden's method.

The estimate of the slope goes on from sample to sample, so that few evaluations are needed. Called
by :mod:`sim.model.march`, which says how it is loaded.

``work`` holds, a row each: the outputs without this sample, but with its struts where no shaft
drives them (0), its outputs (1), its motion of
shaft and levers (2), what the struts (3 to 8) and the loads (9 to 14) add to the outputs, and the
motion of the shaft without this sample (15).
"""

import math

import numpy as np

from hardware.description.arrays import FloatArray
from sim.mechanism.compiled_linkage import strut_motion
from sim.model.compiled_laws import law_force
from sim.solve.compilation import compile_loop

_TOLERANCE = 1e-13
_ROUNDING = 1e-11  # changes below it that shrink no more are rounding
_MOST = 60
_STALLED = 3


@compile_loop
def joint_return(gap: FloatArray, opening: float) -> float:
    """Return the force that a spring in a row with a clearance has less than the spring alone.

    At no opening the spring carries the preload against one side. The damper beside the spring is
    left: it acts across the clearance too, as what lubricates it does.

    Parameters
    ----------
    gap
        Stiffness, half clearance, preload.
    """
    at = opening + math.copysign(gap[1], gap[2]) + gap[2] / gap[0]
    pressed = max(at - gap[1], 0.0) + min(at + gap[1], 0.0)
    return float(gap[0] * (opening - pressed) + gap[2])


@compile_loop
def _model_loads(
    laws: FloatArray,
    hull: FloatArray,
    by_speed: FloatArray,
    gap: FloatArray,
    instants: FloatArray,
    step_s: float,
    base_loads: FloatArray,
    k: int,
    work: FloatArray,
    room: FloatArray,
) -> None:
    """Fill in row 0 of ``room``: the loads that belong to the outputs in row 1 of ``work``."""
    for j in range(base_loads.shape[1]):
        room[0, j] = base_loads[k, j]
    law_force(laws, hull, work, 1, instants[k, 0], step_s, instants[k, 2], room, 0)
    extra = instants[k, 1]
    if extra != 0.0:
        for i in range(2):
            for j in range(2):
                room[0, 2 + i] += extra * by_speed[i, j] * work[1, j]
    if gap[0, 1] > 0.0:
        for i in range(2):
            room[0, 4 + i] += joint_return(gap[i], work[1, 8 + i])


@compile_loop
def _shaft_torque(
    numbers: FloatArray, cogging: FloatArray, work: FloatArray, room: FloatArray
) -> float:
    """Return the torque of struts, guides and cogging at the shaft."""
    angle, speed = work[2, 0], work[2, 1]
    total = 0.0
    for i in range(2):
        lever = work[2, 3 + i]
        force = work[1, 6 + i] + room[0, i] + numbers[3 + i]
        total += force * lever + numbers[1] * lever**2 * speed
        turns = lever * speed
        if turns != 0.0:
            total += math.copysign(numbers[2], turns) * lever
    for row in range(cogging.shape[0]):
        total += cogging[row, 1] * math.sin(cogging[row, 0] * angle + cogging[row, 2])
    return total


@compile_loop
def add_struts(struts: FloatArray, k: int, work: FloatArray, into: int) -> None:
    """Fill in, in a row, the outputs without this sample but with its struts' motion."""
    for j in range(work.shape[1]):
        total = work[0, j]
        for i in range(6):
            total += struts[k + 1, i] * work[3 + i, j]
        work[into, j] = total


@compile_loop
def _turn_shaft(
    motion: FloatArray,
    by_torque: FloatArray,
    links: FloatArray,
    struts: FloatArray,
    k: int,
    unknown: FloatArray,
    first: int,
    work: FloatArray,
) -> None:
    """Fill in the shaft's motion, row 2 of ``work``, the struts', and in row 15 the opening's."""
    for i in range(4):
        work[2, i] = work[15, i]
        for j in range(unknown.size - first):
            work[2, i] += by_torque[j, i] * unknown[first + j]
    work[15, 5] = work[2, 3] + motion[k, 3]
    for i in range(3):
        work[2, i] += motion[k, i]
    strut_motion(links, work, struts, k + 1)
    add_struts(struts, k, work, 1)


@compile_loop
def _respond(
    laws: FloatArray,
    hull: FloatArray,
    by_speed: FloatArray,
    gap: FloatArray,
    instants: FloatArray,
    step_s: float,
    base_loads: FloatArray,
    struts: FloatArray,
    driven: bool,
    motion: FloatArray,
    by_torque: FloatArray,
    numbers: FloatArray,
    cogging: FloatArray,
    shaft_gap: FloatArray,
    links: FloatArray,
    k: int,
    unknown: FloatArray,
    work: FloatArray,
    room: FloatArray,
) -> None:
    """Fill in row 0 of ``room``: what comes back of the loads and torques at sample k."""
    loads = base_loads.shape[1]
    if driven:
        _turn_shaft(motion, by_torque, links, struts, k, unknown, loads, work)
    for j in range(work.shape[1]):
        total = work[1, j] if driven else work[0, j]
        for i in range(loads):
            total += unknown[i] * work[9 + i, j]
        work[1, j] = total
    _model_loads(laws, hull, by_speed, gap, instants, step_s, base_loads, k, work, room)
    if driven:
        rest = numbers[0] * (motion[k, 2] - work[2, 2])
        room[0, loads] = _shaft_torque(numbers, cogging, work, room) + rest
        if shaft_gap[1] > 0.0:
            room[0, loads + 1] = joint_return(shaft_gap, work[15, 5])


@compile_loop
def _update(slope: FloatArray, room: FloatArray) -> None:
    """Correct the inverse slope by the last step and what it has gained: rows 3, 1 and 2."""
    size = slope.shape[0]
    total = 0.0
    for j in range(size):
        room[5, j], room[6, j] = 0.0, room[3, j]
    for i in range(size):
        for j in range(size):
            room[5, j] += room[3, i] * slope[i, j]
            room[6, i] -= slope[i, j] * (room[2, j] - room[1, j])
    for j in range(size):
        total += room[5, j] * (room[2, j] - room[1, j])
    if abs(total) > 1e-300:
        for i in range(size):
            for j in range(size):
                slope[i, j] += room[6, i] * room[5, j] / total


@compile_loop
def _step(slope: FloatArray, scale: FloatArray, unknown: FloatArray, room: FloatArray) -> None:
    """Go to where the slope says that nothing changes any more."""
    for i in range(unknown.size):
        total = 0.0
        for j in range(unknown.size):
            total += slope[i, j] * room[1, j]
        room[3, i] = total
        unknown[i] += total * scale[i]


@compile_loop
def _change(scale: FloatArray, unknown: FloatArray, room: FloatArray) -> float:
    """Return the largest change, and keep all of them in row 1, those before in row 2."""
    largest = 0.0
    for i in range(unknown.size):
        room[2, i] = room[1, i]
        room[1, i] = (room[0, i] - unknown[i]) / scale[i]
        largest = max(largest, abs(room[1, i]))
    return largest


@compile_loop
def settle(
    laws: FloatArray,
    hull: FloatArray,
    by_speed: FloatArray,
    gap: FloatArray,
    instants: FloatArray,
    step_s: float,
    base_loads: FloatArray,
    struts: FloatArray,
    scale: FloatArray,
    driven: bool,
    motion: FloatArray,
    by_torque: FloatArray,
    numbers: FloatArray,
    cogging: FloatArray,
    shaft_gap: FloatArray,
    links: FloatArray,
    k: int,
    unknown: FloatArray,
    slope: FloatArray,
    work: FloatArray,
    room: FloatArray,
) -> bool:
    """Solve for the loads and torques of sample k, ``unknown``; tell whether they settle."""
    best, stalled = np.inf, 0
    for sweep in range(_MOST):
        _respond(
            laws, hull, by_speed, gap, instants, step_s, base_loads, struts, driven, motion,
            by_torque, numbers, cogging, shaft_gap, links, k, unknown, work, room,
        )  # fmt: skip
        largest = _change(scale, unknown, room)
        if largest <= _TOLERANCE or (stalled >= _STALLED and largest <= _ROUNDING):
            return True
        stalled = stalled + 1 if largest >= best else 0
        best = min(best, largest)
        if sweep:
            _update(slope, room)
        _step(slope, scale, unknown, room)
    return False
